// A hierarchy of moving boxes: built once, then only fitted to where things are and where they go.
#pragma once

#include "ringlet/collision/moving_box.h"

#include <cstdint>
#include <vector>

namespace ringlet {

// A perfect tree of four children a node: of node i they are 4i + 1 … 4i + 4. Primitives stand in an order that keeps
// neighbours together, cut into 2^depth shares of at most four; a leaf holds a share, and an odd depth leaves the root half
// empty.
class MovingTree {
public:
    // Takes box(i) for each of `count` primitives i.
    template <class Box> void fit(int count, const Box &box);

    // Takes box(i) anew of some primitives, and of those that share their leaves.
    template <class Box> void refit(View<int> primitives, const Box &box);

    // Until it is taken anew no primitive counts.
    void discount() {
        for (BoxQuad &boxes : nodes_) std::fill_n(boxes.counts, 4, MovingBox::does_not);
    }

    bool empty() const { return count_ == 0; }
    bool is_leaf(int node) const { return node >= first_leaf_; }
    static int child(int node, int k) { return 4 * node + 1 + k; }
    // Of each node's children or, in a leaf, primitives.
    BoxTree boxes() const { return {nodes_.data(), ends_.data(), first_leaf_, depth_ % 2 ? 2 : 4}; }
    MovingBox box(int slot) const { return box_of(nodes_[slot / 4], ends_[slot / 4], slot % 4); } // lane + 4 · leaf
    int primitive(int slot) const { return primitives_[slot - 4 * first_leaf_]; }                 // likewise; −1: none
    int built() const { return built_; }                                                          // how often

private:
    struct Centre {
        float at[3];
        int primitive;
    };
    static constexpr int small = 1 << 10; // less work than that is not shared among threads

    template <class Box> void build(const Box &box);
    void arrange(std::vector<Centre> &centres);
    template <class Box> void refit_leaf(int leaf, const Box &box);
    template <class Box> void refit_all(const Box &box);
    void refit_above(std::vector<int> &nodes);
    double looseness() const;
    int begin(int64_t share, int depth) const { return static_cast<int>(share * count_ >> depth); }
    int leaves() const { return 1 << depth_; }
    void put(int node, const MovingBox &all) { // into its parent
        if (node > 0) set_box(nodes_[(node - 1) / 4], ends_[(node - 1) / 4], (node - 1) % 4, all);
    }
    MovingBox around(int node) const { return box_of(nodes_[node], ends_[node]); }

    std::vector<int> primitives_;       // four to a leaf, the last of which may be missing
    std::vector<int> leaf_of_;          // each primitive
    std::vector<unsigned char> listed_; // per node, while some are refitted
    std::vector<BoxQuad> nodes_;        // one more than there are, as of ends: what is read behind the last
    std::vector<EndQuad> ends_;
    int count_ = 0, depth_ = 0, first_leaf_ = 0, built_ = 0;
    double built_looseness_ = 0.0;
};

template <class Box> void MovingTree::fit(int count, const Box &box) {
    constexpr double worn_out = 1.4; // looser than that, relative to when it was built: built again
    const bool fresh = count != count_;
    count_ = count;
    if (count == 0) return;
    if (fresh) build(box);
    refit_all(box);
    if (!fresh && looseness() > worn_out * built_looseness_) {
        build(box);
        refit_all(box);
        built_looseness_ = looseness();
    } else if (fresh)
        built_looseness_ = looseness();
}

template <class Box> void MovingTree::build(const Box &box) {
    std::vector<Centre> centres(count_);
    for (int i = 0; i < count_; ++i) {
        const MovingBox at = box(i);
        const Eigen::Array4f middle = at.low + at.high;
        centres[i] = {{middle[0], middle[1], middle[2]}, i};
    }
    arrange(centres);
    ++built_;
}

template <class Box> void MovingTree::refit_leaf(int leaf, const Box &box) {
    MovingBox boxes[4], all = MovingBox::nothing();
    for (int k = 0; k < 4; ++k) {
        const int i = primitive(4 * leaf + k);
        boxes[k] = i >= 0 ? box(i) : MovingBox::nothing();
        all.include(boxes[k]);
    }
    set_boxes(nodes_[leaf], ends_[leaf], boxes);
    put(leaf, all);
}

template <class Box> void MovingTree::refit_all(const Box &box) {
    int first = first_leaf_, count = leaves();
#pragma omp parallel for schedule(static) if (count_ > small)
    for (int leaf = first; leaf < first + count; ++leaf) refit_leaf(leaf, box);
    while (first > 1) { // level by level
        first = (first - 1) / 4;
        count /= 4;
#pragma omp parallel for schedule(static) if (count > small)
        for (int node = first; node < first + count; ++node) put(node, around(node));
    }
}

template <class Box> void MovingTree::refit(View<int> primitives, const Box &box) {
    std::vector<int> leaves;
    for (const int i : primitives)
        if (!listed_[leaf_of_[i]]) listed_[leaf_of_[i]] = 1, leaves.push_back(leaf_of_[i]);
#pragma omp parallel for schedule(static) if (int(leaves.size()) > small)
    for (size_t k = 0; k < leaves.size(); ++k) refit_leaf(leaves[k], box);
    refit_above(leaves);
}

} // namespace ringlet
