#include "ringlet/geometry/bvh.h"

#include <algorithm>

namespace ringlet {

// Splits the groups of each depth at the median of their longest axis.
void Bvh::arrange(std::vector<Centre> &centres) {
    depth_ = 0;
    while (count_ > int64_t(4) << depth_) ++depth_;
    for (int depth = 0; depth < depth_; ++depth) {
        parallel_chunks(1 << depth, 1, [&](int group) {
            const auto first = centres.begin() + begin(group, depth), last = centres.begin() + begin(group + 1, depth);
            Eigen::Array3f low = Eigen::Array3f::Constant(std::numeric_limits<float>::infinity()), high = -low;
            for (auto c = first; c != last; ++c) {
                low = low.min(Eigen::Map<const Eigen::Array3f>(c->at));
                high = high.max(Eigen::Map<const Eigen::Array3f>(c->at));
            }
            int axis = 0;
            (high - low).maxCoeff(&axis);
            const auto middle = centres.begin() + begin(2 * int64_t(group) + 1, depth + 1);
            std::nth_element(first, middle, last, [&](const Centre &a, const Centre &b) {
                return a.at[axis] != b.at[axis] ? a.at[axis] < b.at[axis] : a.primitive < b.primitive;
            });
        });
    }

    first_leaf_ = 0;
    for (int level = 0; level < (depth_ + 1) / 2; ++level) first_leaf_ = child(first_leaf_, 0);
    const size_t nodes = size_t(first_leaf_) + leaves();
    BoxQuad empty;
    EndQuad empty_end;
    for (int k = 0; k < 4; ++k) set_box(empty, empty_end, k, SweptBox::empty());
    nodes_.assign(nodes + 1, empty);
    ends_.assign(nodes + 1, empty_end);
    listed_.assign(nodes, 0);
    leaf_of_.resize(count_);
    primitives_.assign(size_t(4) * leaves(), -1);
    for (int leaf = 0; leaf < leaves(); ++leaf)
        for (int place = begin(leaf, depth_); place < begin(leaf + 1, depth_); ++place) {
            primitives_[4 * leaf + place - begin(leaf, depth_)] = centres[place].primitive;
            leaf_of_[centres[place].primitive] = first_leaf_ + leaf;
        }
}

// Refits the ancestors of listed nodes of one level, and unlists them.
void Bvh::refit_above(std::vector<int> &nodes) {
    std::vector<int> parents;
    for (; !nodes.empty(); std::swap(nodes, parents)) {
        parents.clear();
        for (const int node : nodes) {
            listed_[node] = 0;
            const int parent = (node - 1) / 4;
            if (node > 0 && !listed_[parent]) listed_[parent] = 1, parents.push_back(parent);
        }
        for (const int node : parents) set(node, union_of(node));
    }
}

// The sum of the sizes of all leaves at the start, which grows as neighbours separate [m].
double Bvh::leaf_extent() const {
    double sum = 0.0;
    for (int leaf = first_leaf_; leaf < first_leaf_ + leaves() && leaf > 0; ++leaf) {
        const BoxQuad &parent = nodes_[(leaf - 1) / 4];
        const int k = (leaf - 1) % 4;
        for (int axis = 0; axis < 3; ++axis) sum += parent.high[axis][k] - parent.low[axis][k];
    }
    return sum;
}

} // namespace ringlet
