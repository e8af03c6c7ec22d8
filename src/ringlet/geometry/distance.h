// The closest points of two segments, and of a point and a triangle.
#pragma once

#include "ringlet/math/types.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <limits>

namespace ringlet {

// Where two primitives of four vertices x_i are closest: their closest points are c_a and c_b, and c_a − c_b = Σ weights[i]
// x_i.
struct ClosestPoints {
    std::array<double, 4> weights{};                            // those of the first primitive sum to 1, of the second to −1
    double distance2 = std::numeric_limits<double>::infinity(); // [m²]
};

namespace closest {

// a/b clamped to [0, 1]; 0 where b is 0, so that a segment without length counts as its first end.
inline double fraction(double a, double b) { return b > 0.0 ? std::clamp(a / b, 0.0, 1.0) : 0.0; }

inline void take_nearer(ClosestPoints &nearest, const ClosestPoints &other) {
    if (other.distance2 < nearest.distance2) nearest = other;
}

} // namespace closest

// Segments a and b. The nearest point of the two lines, s clamped, then t, then s again, is the nearest point of the segments
// (Ericson 2005, 5.1.9). Where they are parallel to rounding the lines have none, and one of the four ends is as near as
// anything.
inline ClosestPoints closest_edge_edge(const Vec3 &a0, const Vec3 &a1, const Vec3 &b0, const Vec3 &b1) {
    const Vec3 a = a1 - a0, b = b1 - b0, between = a0 - b0, normal = a.cross(b);
    const double aa = a.squaredNorm(), bb = b.squaredNorm(), ab = a.dot(b), sine2 = normal.squaredNorm();
    const double a_between = a.dot(between), b_between = b.dot(between);
    const auto at = [&](double s, double t) -> ClosestPoints {
        return {{1.0 - s, s, t - 1.0, -t}, (between + s * a - t * b).squaredNorm()};
    };
    ClosestPoints nearest;
    if (sine2 > 0.0) { // by cross products: from dot products it would be lost in rounding at angles of 1e-8
        const double s = std::clamp(normal.dot(b.cross(between)) / sine2, 0.0, 1.0);
        const double t = closest::fraction(b_between + s * ab, bb);
        nearest = at(closest::fraction(t * ab - a_between, aa), t);
    }
    constexpr double parallel = 1e-12; // sin² of the angle
    if (sine2 > parallel * aa * bb) return nearest;
    closest::take_nearer(nearest, at(0.0, closest::fraction(b_between, bb)));
    closest::take_nearer(nearest, at(1.0, closest::fraction(b_between + ab, bb)));
    closest::take_nearer(nearest, at(closest::fraction(-a_between, aa), 0.0));
    closest::take_nearer(nearest, at(closest::fraction(ab - a_between, aa), 1.0));
    return nearest;
}

// Point p and triangle t: the foot of the perpendicular where it falls inside, else the nearest of the three edges.
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
