// A bounding volume hierarchy of swept AABBs: built once, then refitted as vertices move.
#pragma once

#include "ringlet/geometry/swept_box.h"
#include "ringlet/math/parallel.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <vector>

namespace ringlet {

// A perfect tree with four children a node: those of node i are 4i + 1 … 4i + 4. Primitives are ordered by median splits and
// cut into 2^depth groups of at most four, one to a leaf. An odd depth leaves the root half empty.
class Bvh {
public:
    // Fits the tree to box(i) of each of `count` primitives i; rebuilds it where its leaves have grown too much.
    template <class Box> void fit(int count, const Box &box);

    // Fits the tree to new boxes of some primitives, and of those that share their leaves.
    template <class Box> void refit(View<int> primitives, const Box &box);

    // Calls visit(primitive) for those whose boxes, at the start, are within a distance of a place [m], nearer ones first as
    // far as nodes tell. It returns the distance within which the search goes on.
    template <class Visit> void for_near(const Vec3 &place, double within, const Visit &visit) const;

    // Calls visit(primitive) for those whose boxes, at the start, overlap a box.
    template <class Visit> void for_overlapping(const SweptBox &box, const Visit &visit) const;

    // Makes every box inactive until it is refitted.
    void deactivate() {
        for (BoxQuad &boxes : nodes_) std::fill_n(boxes.active, 4, SweptBox::no);
    }

    bool empty() const { return count_ == 0; }
    bool is_leaf(int node) const { return node >= first_leaf_; }
    static int child(int node, int k) { return 4 * node + 1 + k; }
    // The boxes of each node's children or, in a leaf, primitives.
    BvhNodes nodes() const { return {nodes_.data(), ends_.data(), first_leaf_, depth_ % 2 ? 2 : 4}; }
    SweptBox box(int slot) const { return box_of(nodes_[slot / 4], ends_[slot / 4], slot % 4); } // slot: lane + 4 · leaf
    int primitive(int slot) const { return primitives_[slot - 4 * first_leaf_]; }                // likewise; −1: none
    int builds() const { return builds_; }                                                       // so far

private:
    static constexpr int most_levels = 16; // of 2³¹ primitives

    struct Centre {
        float at[3];
        int primitive;
    };

    template <class Box> void build(const Box &box);
    void arrange(std::vector<Centre> &centres);
    template <class Box> void refit_leaf(int leaf, const Box &box);
    template <class Box> void refit_all(const Box &box);
    void refit_above(std::vector<int> &nodes);
    double leaf_extent() const;
    int begin(int64_t group, int depth) const { return static_cast<int>(group * count_ >> depth); }
    int leaves() const { return 1 << depth_; }
    void set(int node, const SweptBox &all) { // in its parent
        if (node > 0) set_box(nodes_[(node - 1) / 4], ends_[(node - 1) / 4], (node - 1) % 4, all);
    }
    SweptBox union_of(int node) const { return box_of(nodes_[node], ends_[node]); }

    std::vector<int> primitives_;       // four to a leaf; −1: none
    std::vector<int> leaf_of_;          // of each primitive
    std::vector<unsigned char> listed_; // per node, during a refit
    std::vector<BoxQuad> nodes_;        // and one more, as of ends: kernels read beyond the last
    std::vector<EndQuad> ends_;
    int count_ = 0, depth_ = 0, first_leaf_ = 0, builds_ = 0;
    double built_extent_ = 0.0;
};

template <class Box> void Bvh::fit(int count, const Box &box) {
    const bool fresh = count != count_;
    count_ = count;
    if (count == 0) return;
    if (fresh) build(box);
    refit_all(box);
    if (!fresh && leaf_extent() > bvh_settings::rebuild_growth * built_extent_) {
        build(box);
        refit_all(box);
        built_extent_ = leaf_extent();
    } else if (fresh)
        built_extent_ = leaf_extent();
}

template <class Box> void Bvh::build(const Box &box) {
    std::vector<Centre> centres(count_);
    for (int i = 0; i < count_; ++i) {
        const SweptBox at = box(i);
        const Eigen::Array4f middle = at.low + at.high;
        centres[i] = {{middle[0], middle[1], middle[2]}, i};
    }
    arrange(centres);
    ++builds_;
}

template <class Box> void Bvh::refit_leaf(int leaf, const Box &box) {
    SweptBox boxes[4], all = SweptBox::empty();
    for (int k = 0; k < 4; ++k) {
        const int i = primitive(4 * leaf + k);
        boxes[k] = i >= 0 ? box(i) : SweptBox::empty();
        all.include(boxes[k]);
    }
    set_boxes(nodes_[leaf], ends_[leaf], boxes);
    set(leaf, all);
}

template <class Box> void Bvh::refit_all(const Box &box) {
    int first = first_leaf_, count = leaves();
    parallel_for(count, bvh_settings::serial_nodes, [&](int k) { refit_leaf(first + k, box); });
    while (first > 1) { // level by level
        first = (first - 1) / 4;
        count /= 4;
        parallel_for(count, bvh_settings::serial_nodes, [&](int k) { set(first + k, union_of(first + k)); });
    }
}

template <class Visit> void Bvh::for_near(const Vec3 &place, double within, const Visit &visit) const {
    struct Near {
        float distance2;
        int node; // or slot of a leaf
        bool operator<(const Near &other) const { return distance2 < other.distance2; }
    };
    const auto rounded_up = [](double distance) { return float(distance * distance * (1.0 + 1e-6)); };
    const Eigen::Array3f at = place.cast<float>();
    float most = rounded_up(within);
    std::array<Near, 4 * most_levels> stack;
    int top = 0;
    if (!empty()) stack[top++] = {0.0f, 0};
    while (top > 0) {
        const auto [distance2, node] = stack[--top];
        if (distance2 > most) continue;
        const Eigen::Array4f distances2 = ringlet::distances2(nodes_[node], at);
        std::array<Near, 4> near;
        int count = 0;
        for (int k = 0; k < 4; ++k)
            if (distances2[k] <= most && distances2[k] < std::numeric_limits<float>::infinity()) // no empty box
                near[count++] = {distances2[k], is_leaf(node) ? 4 * node + k : child(node, k)};
        std::sort(near.begin(), near.begin() + count);
        if (!is_leaf(node)) {
            while (count > 0) stack[top++] = near[--count];
            continue;
        }
        for (int k = 0; k < count && near[k].distance2 <= most; ++k) most = rounded_up(visit(primitive(near[k].node)));
    }
}

template <class Visit> void Bvh::for_overlapping(const SweptBox &box, const Visit &visit) const {
    std::array<int, 4 * most_levels> stack;
    int top = 0;
    if (!empty()) stack[top++] = 0;
    while (top > 0) {
        const int node = stack[--top];
        for (int k = 0; k < 4; ++k) {
            const SweptBox here = box_of(nodes_[node], ends_[node], k);
            if (!((here.low <= box.high).head<3>().all() && (here.high >= box.low).head<3>().all())) continue;
            if (is_leaf(node))
                visit(primitive(4 * node + k));
            else
                stack[top++] = child(node, k);
        }
    }
}

template <class Box> void Bvh::refit(View<int> primitives, const Box &box) {
    std::vector<int> leaves;
    for (const int i : primitives)
        if (!listed_[leaf_of_[i]]) listed_[leaf_of_[i]] = 1, leaves.push_back(leaf_of_[i]);
    parallel_for(int(leaves.size()), bvh_settings::serial_nodes, [&](int k) { refit_leaf(leaves[k], box); });
    refit_above(leaves);
}

} // namespace ringlet
