// Distances of two segments, and of a point and a triangle, with their closest points.
#pragma once

#include "ringlet/geometry/closest_of_edges.h"
#include "ringlet/math/types.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <limits>

namespace ringlet {

// Closest points c_a and c_b of two primitives with four vertices x_i in all: c_a − c_b = Σ weights[i] x_i.
struct ClosestPoints {
    std::array<double, 4> weights{};                            // sum to 1 over the first primitive, to −1 over the second
    double distance2 = std::numeric_limits<double>::infinity(); // squared distance [m²]
};

namespace closest {

// a/b clamped to [0, 1]; 0 where b is 0, so that a segment without length counts as its first end.
inline double fraction(double a, double b) { return b > 0.0 ? std::clamp(a / b, 0.0, 1.0) : 0.0; }

inline void take_nearer(ClosestPoints &nearest, const ClosestPoints &other) {
    if (other.distance2 < nearest.distance2) nearest = other;
}

} // namespace closest

// The points at the fraction s of segment a and t of segment b.
inline ClosestPoints at_edges(double s, double t, double distance2) { return {{1.0 - s, s, t - 1.0, -t}, distance2}; }

// Closest points of two segments. Where they are parallel to rounding, the nearest of the four ends is exact.
inline ClosestPoints closest_edge_edge(const Vec3 &a0, const Vec3 &a1, const Vec3 &b0, const Vec3 &b1) {
    const auto read = [](const Vec3 &x) { return RINGLET_SIMD::Vec<double>{x[0], x[1], x[2]}; };
    const auto closest = RINGLET_SIMD::closest_of_edges(read(a0), read(a1), read(b0), read(b1));
    ClosestPoints nearest = at_edges(closest.s, closest.t, closest.distance2);
    if (closest.askew) return nearest;
    const Vec3 a = a1 - a0, b = b1 - b0, between = a0 - b0;
    const double aa = a.squaredNorm(), bb = b.squaredNorm(), ab = a.dot(b);
    const double a_between = a.dot(between), b_between = b.dot(between);
    const auto at = [&](double s, double t) { return at_edges(s, t, (between + s * a - t * b).squaredNorm()); };
    if (!(nearest.distance2 >= 0.0)) nearest = {}; // not a number
    closest::take_nearer(nearest, at(0.0, closest::fraction(b_between, bb)));
    closest::take_nearer(nearest, at(1.0, closest::fraction(b_between + ab, bb)));
    closest::take_nearer(nearest, at(closest::fraction(-a_between, aa), 0.0));
    closest::take_nearer(nearest, at(closest::fraction(ab - a_between, aa), 1.0));
    return nearest;
}

// Closest points of p and the triangle t: the foot of the perpendicular where it falls inside, else a point of an edge.
inline ClosestPoints closest_point_triangle(const Vec3 &p, const Vec3 &t0, const Vec3 &t1, const Vec3 &t2) {
    const Vec3 a = t1 - t0, b = t2 - t0, q = p - t0;
    const auto at = [&](double v, double w) -> ClosestPoints {
        return {{1.0, v + w - 1.0, -v, -w}, (q - v * a - w * b).squaredNorm()};
    };
    const Vec3 c = b - a;
    ClosestPoints nearest = at(closest::fraction(q.dot(a), a.squaredNorm()), 0.0);
    closest::take_nearer(nearest, at(0.0, closest::fraction(q.dot(b), b.squaredNorm())));
    const double along = closest::fraction((q - a).dot(c), c.squaredNorm());
    closest::take_nearer(nearest, at(1.0 - along, along));
    const Vec3 normal = a.cross(b);
    const double area2 = normal.squaredNorm();
    if (area2 > 0.0) {
        const double v = q.cross(b).dot(normal) / area2, w = a.cross(q).dot(normal) / area2;
        if (v >= 0.0 && w >= 0.0 && v + w <= 1.0) closest::take_nearer(nearest, at(v, w));
    }
    return nearest;
}

} // namespace ringlet
