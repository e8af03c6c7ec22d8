#include "ringlet/contact/moving_tree.h"

#include <algorithm>

namespace ringlet {
namespace {

constexpr int leaf_size = 4;     // at most
constexpr double worn_out = 1.4; // looser than that, relative to when it was built: built again
constexpr int small = 1 << 10;   // less work than that is not shared among threads

struct Centre {
    float at[3];
    int primitive;
};

} // namespace

void MovingTree::fit(std::span<const MovingBox> primitives) {
    if (primitives.empty()) return;
    const bool fresh = order_.size() != primitives.size();
    if (fresh) build(primitives);
    refit(primitives);
    if (!fresh && looseness() > worn_out * built_looseness_) {
        build(primitives);
        refit(primitives);
        built_looseness_ = looseness();
    } else if (fresh)
        built_looseness_ = looseness();
}

// Halves each level's shares at the median of their longest axis.
void MovingTree::build(std::span<const MovingBox> primitives) {
    const int count = static_cast<int>(primitives.size());
    order_.resize(count);
    boxes_.resize(count);
    depth_ = 0;
    while (count > static_cast<int64_t>(leaf_size) << depth_) ++depth_;
    first_leaf_ = (1 << depth_) - 1;
    nodes_.resize(2 * size_t(first_leaf_) + 1);

    std::vector<Centre> centres(count);
    for (int i = 0; i < count; ++i) {
        const Eigen::Array4f middle = primitives[i].low + primitives[i].high;
        centres[i] = {{middle[0], middle[1], middle[2]}, i};
    }
    for (int level = 0; level < depth_; ++level) {
#pragma omp parallel for schedule(dynamic, 1) if (count > small)
        for (int share = 0; share < 1 << level; ++share) {
            const auto first = centres.begin() + begin(share, level), last = centres.begin() + begin(share + 1, level);
            Eigen::Array3f low = Eigen::Array3f::Constant(std::numeric_limits<float>::infinity()), high = -low;
            for (auto c = first; c != last; ++c) {
                low = low.min(Eigen::Map<const Eigen::Array3f>(c->at));
                high = high.max(Eigen::Map<const Eigen::Array3f>(c->at));
            }
            int axis = 0;
            (high - low).maxCoeff(&axis);
            std::nth_element(first, centres.begin() + begin(2 * int64_t(share) + 1, level + 1), last,
                             [&](const Centre &a, const Centre &b) {
                                 return a.at[axis] != b.at[axis] ? a.at[axis] < b.at[axis] : a.primitive < b.primitive;
                             });
        }
    }
    for (int i = 0; i < count; ++i) order_[i] = centres[i].primitive;
    ++built_;
}

void MovingTree::refit(std::span<const MovingBox> primitives) {
    const int count = static_cast<int>(order_.size());
#pragma omp parallel for schedule(static) if (count > small)
    for (int node = first_leaf_; node < 2 * first_leaf_ + 1; ++node) {
        const Leaf places = leaf(node);
        MovingBox &all = nodes_[node] = primitives[order_[places.begin]];
        for (int place = places.begin; place < places.end; ++place) {
            boxes_[place] = primitives[order_[place]];
            all.include(boxes_[place]);
        }
    }
    for (int level = depth_ - 1; level >= 0; --level) {
        const int first = (1 << level) - 1;
#pragma omp parallel for schedule(static) if (1 << level > small)
        for (int node = first; node < 2 * first + 1; ++node) {
            nodes_[node] = nodes_[2 * node + 1];
            nodes_[node].include(nodes_[2 * node + 2]);
        }
    }
}

// The size of all leaves together, at the start: how far apart those have gone that were neighbours.
double MovingTree::looseness() const {
    double sum = 0.0;
    for (int node = first_leaf_; node < 2 * first_leaf_ + 1; ++node)
        sum += (nodes_[node].high - nodes_[node].low).head<3>().sum();
    return sum;
}

} // namespace ringlet
