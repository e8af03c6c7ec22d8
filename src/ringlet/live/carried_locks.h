// Locks of many points that rods of few vertices carry.
#pragma once

#include "ringlet/geometry/frames.h"

#include <vector>

namespace ringlet {

// The motion that a vertex of a rod has made since it was groomed: x ↦ A x + t. Where the rod is longer by a factor λ, A is a
// rotation with λ along the rod, and with that across it with which the wire of the coil is as long as before.
struct VertexMotion {
    Mat3 linear;
    Vec3 shift; // [m]
};

// How much narrower a coil of rise sin α gets that is drawn out by a factor λ: √(1 − λ² sin² α) / cos α. It stays a quarter as
// wide as groomed, and what is nearly straight about as wide.
double narrowing(double longer, double rise);

// A point between two vertices of a rod follows both motions, x = (1 - w) M_a(x̄) + w M_b(x̄), where w rises smoothly from 0 to 1
// between them. At a vertex it follows that alone, so lock and tangent are continuous. The frames are rotation-minimising from
// the root, whose axis the head turns.
class CarriedLocks {
public:
    // points: of all locks as groomed [m]; vertex, weight: of each point the vertex of a rod before it, and w
    // rods:   as groomed; axes: some direction across the root of each; rises: sin α of the coils about them
    CarriedLocks(View<Vec3> points, View<int> vertex, View<double> weight, CurveView rods, View<Vec3> axes, View<double> rises);

    // Motions of the vertices of rods that are at `rods` now; `turn`: rotation of the head.
    std::vector<VertexMotion> motions(View<Vec3> rods, const Mat3 &turn) const;

    // All points where the rods are now.
    void carry(View<VertexMotion> motions, std::span<Vec3> result) const;

    size_t size() const { return points_.size(); }

private:
    void frames(View<Vec3> rods, const Mat3 &turn, std::vector<Mat3> &frames) const;

    std::vector<Vec3> points_, rods_, axes_;
    std::vector<int> vertex_, offsets_;
    std::vector<double> weight_, rises_;
    std::vector<double> lengths_; // of the rod about each vertex as groomed: half of the edges that meet there [m]
    std::vector<Mat3> frames_;    // as groomed
};

} // namespace ringlet
