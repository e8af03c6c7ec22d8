// Culling of candidate pairs on a move: edges by separating axes, many at a time, points and triangles by boxes.
#pragma once

#include "ringlet/collision/swept_boxes.h"

#include <vector>

namespace ringlet {

// Where the vertices of a move are allowed to be.
enum class Motion {
    in_triangles, // each anywhere in its triangle of start, end and apex
    straight      // all on their straight paths at one time
};

// Keeps the pairs that may come into contact, or with straight motion have an impact, in order.
template <class Pair> class PairCuller {
public:
    PairCuller(const SweptBoxes &boxes, Motion motion, std::vector<Pair *> &kept)
        : boxes_(boxes), motion_(motion), kept_(kept) {}
    ~PairCuller() { cull_edges(); }

    void add(Pair &pair) {
        if (!pair.edge_edge) {
            cull_edges();
            if (boxes_.with_boxes(pair, motion_ == Motion::straight ? may_overlap : paths_overlap)) kept_.push_back(&pair);
            return;
        }
        pairs_[count_++] = &pair;
        if (count_ == MovingEdgePairs::room) cull_edges();
    }

private:
    void cull_edges() {
        if (count_ == 0) return;
        boxes_.gather(edges_, count_, [&](int k) { return pairs_[k]->primitive; });
        const bool straight = motion_ == Motion::straight;
        const double reach = straight ? collision::impact_reach : 1.0;
        for (int k = 0; k < count_; ++k) edges_.reach[k] = float(reach * pairs_[k]->d_hat) + boxes_.rounding();
        const unsigned separated =
            straight ? RINGLET_DISPATCH(separated_in_motion, edges_) : RINGLET_DISPATCH(separated_in_triangles, edges_);
        for (int k = 0; k < count_; ++k)
            if (!(separated >> k & 1u)) kept_.push_back(pairs_[k]);
        count_ = 0;
    }

    const SweptBoxes &boxes_;
    Motion motion_;
    std::vector<Pair *> &kept_;
    MovingEdgePairs edges_ = {};
    std::array<Pair *, MovingEdgePairs::room> pairs_;
    int count_ = 0; // pairs of edges that wait
};

} // namespace ringlet
