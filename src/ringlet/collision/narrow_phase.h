// The narrow phase: which of some pairs are nearer than their activation distance.
#pragma once

#include "ringlet/collision/mesh.h"
#include "ringlet/geometry/edge_batch.h"
#include "ringlet/math/collect.h"

#include <cmath>
#include <vector>

namespace ringlet {

// A pair nearer than its activation distance.
struct ContactPair : PrimitivePair {
    ClosestPoints closest;
};

// Finds the contact pairs among those that are added, in order, and measures edges many at a time. Calls measured(pair, gap
// [m]) for each pair whose distance it computes.
template <class Pair, class Measured> class NarrowPhase {
public:
    NarrowPhase(const CollisionMesh &mesh, View<Vec3> positions, const Measured &measured, std::vector<ContactPair> &found)
        : mesh_(mesh), at_(positions), measured_(measured), found_(found) {}
    ~NarrowPhase() { measure_edges(); }

    void add(Pair &pair) {
        if (!pair.edge_edge) return measure_triangle(pair);
        const auto &a = mesh_.edges[pair.primitive[0]], &b = mesh_.edges[pair.primitive[1]];
        for (int axis = 0; axis < 3; ++axis) {
            edges_.ends[0][axis][count_] = at_[a[0]][axis], edges_.ends[1][axis][count_] = at_[a[1]][axis];
            edges_.ends[2][axis][count_] = at_[b[0]][axis], edges_.ends[3][axis][count_] = at_[b[1]][axis];
        }
        pairs_[count_++] = &pair;
        if (count_ == EdgeBatch::room) measure_edges();
    }

private:
    void measure_triangle(Pair &pair) {
        measure_edges();
        const Vec3 &p = at_[pair.primitive[0]];
        const auto &[a, b, c] = mesh_.triangles[pair.primitive[1]];
        const Vec3 above = at_[a].cwiseMin(at_[b]).cwiseMin(at_[c]) - p, below = p - at_[a].cwiseMax(at_[b]).cwiseMax(at_[c]);
        if (above.cwiseMax(below).maxCoeff() > pair.d_hat) return; // separated along an axis
        take(pair, closest_point_triangle(p, at_[a], at_[b], at_[c]));
    }

    void measure_edges() {
        if (count_ == 0) return;
        const unsigned exact = RINGLET_DISPATCH(find_closest, edges_);
        for (int k = 0; k < count_; ++k) {
            Pair &pair = *pairs_[k];
            take(pair, exact >> k & 1u ? at_edges(edges_.s[k], edges_.t[k], edges_.distance2[k])
                                       : closest_points(at_, mesh_.edges[pair.primitive[0]], mesh_.edges[pair.primitive[1]]));
        }
        count_ = 0;
    }

    void take(Pair &pair, const ClosestPoints &closest) {
        const double gap = std::sqrt(closest.distance2);
        measured_(pair, gap);
        if (gap < pair.d_hat) found_.push_back({pair, closest});
    }

    const CollisionMesh &mesh_;
    View<Vec3> at_;
    const Measured &measured_;
    std::vector<ContactPair> &found_;
    EdgeBatch edges_ = {};
    std::array<Pair *, EdgeBatch::room> pairs_;
    int count_ = 0; // pairs of edges that wait
};

// A pair that may come into contact on a move, for a line search that asks for contacts at many points of it.
struct ReachablePair : PrimitivePair {
    std::array<int, 2> object;
    double slack;                      // lower bound on the gap at the start, less d_hat [m]
    std::array<double, 2> path_length; // upper bound for each primitive [m]
};

using ReachablePairs = std::vector<ReachablePair>;

// The contact pairs with a marked object at `positions`, where each object has made at most the given fraction of its path.
// Objects beyond these are unmarked and at rest.
inline std::vector<ContactPair> contact_pairs(const CollisionMesh &mesh, const ReachablePairs &pairs, View<Vec3> positions,
                                              View<unsigned char> objects, View<double> fractions) {
    const auto path = [&](const ReachablePair &pair, int k) {
        return size_t(pair.object[k]) < fractions.size() ? fractions[pair.object[k]] * pair.path_length[k] : 0.0;
    };
    const auto ignore = [](const ReachablePair &, double) {};
    return collect_ranges<ContactPair>(int(pairs.size()), [&](int begin, int end, std::vector<ContactPair> &found) {
        NarrowPhase<const ReachablePair, decltype(ignore)> narrow_phase(mesh, positions, ignore, found);
        for (int k = begin; k < end; ++k)
            if (any_marked(pairs[k].object, objects) && pairs[k].slack < path(pairs[k], 0) + path(pairs[k], 1))
                narrow_phase.add(pairs[k]);
    });
}

} // namespace ringlet
