// Which of some pairs touch where things are.
#pragma once

#include "ringlet/collision/collision_mesh.h"
#include "ringlet/geometry/edge_batch.h"

#include <cmath>
#include <vector>

namespace ringlet {

// Two that touch.
struct Touch {
    std::array<int, 2> of;
    bool of_edges;
    double distance; // r [m]
    ClosestPoints nearest;
};

// Finds those of some pairs that touch, in order, edges many at a time. Tells measured(pair, how far they are apart [m]) of
// those that had to be measured.
template <class Pair, class Measured> class Touching {
public:
    Touching(const CollisionMesh &mesh, View<Vec3> at, const Measured &measured, std::vector<Touch> &found)
        : mesh_(mesh), at_(at), measured_(measured), found_(found) {}
    ~Touching() { measure_edges(); }

    void look_at(const Pair &pair) {
        if (!pair.of_edges) return look_at_triangle(pair);
        const auto &a = mesh_.edges[pair.of[0]], &b = mesh_.edges[pair.of[1]];
        for (int axis = 0; axis < 3; ++axis) {
            edges_.ends[0][axis][count_] = at_[a[0]][axis], edges_.ends[1][axis][count_] = at_[a[1]][axis];
            edges_.ends[2][axis][count_] = at_[b[0]][axis], edges_.ends[3][axis][count_] = at_[b[1]][axis];
        }
        pairs_[count_++] = &pair;
        if (count_ == EdgeBatch::room) measure_edges();
    }

private:
    void look_at_triangle(const Pair &pair) {
        measure_edges();
        const Vec3 &p = at_[pair.of[0]];
        const auto &[a, b, c] = mesh_.triangles[pair.of[1]];
        const Vec3 above = at_[a].cwiseMin(at_[b]).cwiseMin(at_[c]) - p, below = p - at_[a].cwiseMax(at_[b]).cwiseMax(at_[c]);
        if (above.cwiseMax(below).maxCoeff() > pair.distance) return; // apart on one axis
        measured(pair, closest_point_triangle(p, at_[a], at_[b], at_[c]));
    }

    void measure_edges() {
        if (count_ == 0) return;
        const unsigned exact = RINGLET_DISPATCH(find_closest, edges_);
        for (int k = 0; k < count_; ++k) {
            const Pair &pair = *pairs_[k];
            measured(pair, exact >> k & 1u ? at_edges(edges_.s[k], edges_.t[k], edges_.distance2[k])
                                           : closest_points(at_, mesh_.edges[pair.of[0]], mesh_.edges[pair.of[1]]));
        }
        count_ = 0;
    }

    void measured(const Pair &pair, const ClosestPoints &nearest) {
        const double apart = std::sqrt(nearest.distance2);
        measured_(pair, apart);
        if (apart < pair.distance) found_.push_back({pair.of, pair.of_edges, pair.distance, nearest});
    }

    const CollisionMesh &mesh_;
    View<Vec3> at_;
    const Measured &measured_;
    std::vector<Touch> &found_;
    EdgeBatch edges_ = {};
    std::array<const Pair *, EdgeBatch::room> pairs_;
    int count_ = 0; // of edges, not measured yet
};

} // namespace ringlet
