// Locks of many points that rods of few vertices carry.
#pragma once

#include "ringlet/geometry/frames.h"

#include <vector>

namespace ringlet {

// The rigid motion that a vertex of a rod has made since it was groomed: x ↦ R x + t.
struct VertexMotion {
    Mat3 rotation;
    Vec3 shift; // [m]
};

// A point between two vertices of a rod follows both motions, x = (1 - w) M_a(x̄) + w M_b(x̄), where w rises smoothly from 0 to 1
// between them. At a vertex it follows that alone, so lock and tangent are continuous. The frames are rotation-minimising from
// the root, whose axis the head turns.
class CarriedLocks {
public:
    // points: of all locks as groomed [m]; vertex, weight: of each point the vertex of a rod before it, and w
    // rods:   as groomed; axes: some direction across the root of each
    CarriedLocks(View<Vec3> points, View<int> vertex, View<double> weight, CurveView rods, View<Vec3> axes);

    // Motions of the vertices of rods that are at `rods` now; `turn`: rotation of the head.
    std::vector<VertexMotion> motions(View<Vec3> rods, const Mat3 &turn) const;

    // All points where the rods are now.
    void carry(View<VertexMotion> motions, std::span<Vec3> result) const;

    size_t size() const { return points_.size(); }

private:
    void frames(View<Vec3> rods, const Mat3 &turn, std::vector<Mat3> &frames) const;

    std::vector<Vec3> points_, rods_, axes_;
    std::vector<int> vertex_, offsets_;
    std::vector<double> weight_;
    std::vector<Mat3> frames_; // as groomed
};

} // namespace ringlet
