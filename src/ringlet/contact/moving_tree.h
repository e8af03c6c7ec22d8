// A hierarchy of moving boxes: built once, then only fitted to where things are and where they go.
#pragma once

#include "ringlet/contact/moving_box.h"

#include <span>
#include <vector>

namespace ringlet {

// A perfect binary tree. The children of node i are 2i + 1 and 2i + 2; leaf l of 2^depth holds the boxes of its share of an
// order that keeps neighbours together.
class MovingTree {
public:
    struct Leaf {
        int begin, end; // into order() and boxes()
    };

    // Takes one box for each primitive, in their own order.
    void fit(std::span<const MovingBox> primitives);

    bool empty() const { return order_.empty(); }
    bool is_leaf(int node) const { return node >= first_leaf_; }
    Leaf leaf(int node) const { return {begin(node - first_leaf_, depth_), begin(node - first_leaf_ + 1, depth_)}; }
    const MovingBox &node(int i) const { return nodes_[i]; }
    const MovingBox &box(int place) const { return boxes_[place]; } // of primitive order()[place]
    std::span<const int> order() const { return order_; }
    int built() const { return built_; } // how often

private:
    int begin(int64_t share, int depth) const { return static_cast<int>(share * static_cast<int64_t>(order_.size()) >> depth); }
    void build(std::span<const MovingBox> primitives);
    void refit(std::span<const MovingBox> primitives);
    double looseness() const;

    std::vector<int> order_;
    std::vector<MovingBox> boxes_, nodes_;
    int depth_ = 0, first_leaf_ = 0, built_ = 0;
    double built_looseness_ = 0.0;
};

} // namespace ringlet
