// Until when a pair of moving primitives certainly keeps its distance: conservative advancement (Mirtich 1996; Li et al.
// 2021, 4.2) on the relative motion.
//
// For any unit vector n, the distance at time τ is at least the least of n·(x_i − x_j) + τ n·(p_i − p_j) over the vertices i of
// one primitive and j of the other: the gap of their shadows on n. Time advances to where this bound, for the n between the
// closest points, leaves a tenth of what there was to give away, and again from there. The bound holds for whatever n, so that
// nothing depends on how exactly the closest points are known; and only differences of displacements are in it, so that a
// motion which all four vertices share changes nothing.
#pragma once

#include "ringlet/geometry/distance.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace ringlet {

inline constexpr double no_impact = std::numeric_limits<double>::infinity();

namespace impact {

// The first `First` of four vertices are one primitive, the others are the other.
template <int First> ClosestPoints closest(const Vec3 x[4]) {
    return (First == 2 ? closest_edge_edge : closest_point_triangle)(x[0], x[1], x[2], x[3]);
}

// `nearest` says where they are closest at the start.
template <int First> double time(const Vec3 x[4], const Vec3 p[4], double min_distance, ClosestPoints nearest) {
    constexpr double left = 0.1, done = 0.01; // of what may be given away: what a step leaves, and when to stop
    constexpr double touching = 1e-100;       // [m]: no direction leads from one to the other
    constexpr int most_steps = 200;
    std::array<Vec3, 4> start, motion; // relative to the last vertex
    double motion2 = 0.0;
    for (int i = 0; i < 4; ++i) {
        start[i] = x[i] - x[3];
        motion[i] = p[i] - p[3];
        motion2 += motion[i].squaredNorm();
    }
    if (motion2 == 0.0) return no_impact;
    if (!std::isfinite(motion2)) return 0.0;

    const double kept = std::max(min_distance, touching), enough = done * (std::sqrt(nearest.distance2) - kept);
    double t = 0.0;
    std::array<Vec3, 4> now = start;
    for (int step = 0; step < most_steps; ++step) {
        const double distance = std::sqrt(nearest.distance2);
        if (!(distance - kept > enough)) return t;
        Vec3 n = Vec3::Zero();
        for (int i = 0; i < 4; ++i) n += (nearest.weights[i] / distance) * now[i];
        std::array<double, 4> at, speed;
        for (int i = 0; i < 4; ++i) {
            at[i] = n.dot(now[i]);
            speed[i] = n.dot(motion[i]);
        }
        double gap = distance; // less only by rounding
        for (int i = 0; i < First; ++i)
            for (int j = First; j < 4; ++j) gap = std::min(gap, at[i] - at[j]);
        if (!(gap - kept > enough)) return t;

        const double target = kept + left * (gap - kept), rest = 1.0 - t;
        double advance = rest;
        bool safe = true; // to the end
        for (int i = 0; i < First; ++i)
            for (int j = First; j < 4; ++j) {
                const double apart = at[i] - at[j], closing = speed[j] - speed[i];
                safe &= apart - rest * closing >= kept;
                if (advance * closing > apart - target) advance = (apart - target) / closing;
            }
        if (safe) return no_impact;
        t = std::min(t + advance, 1.0);
        for (int i = 0; i < 4; ++i) now[i] = start[i] + t * motion[i];
        nearest = closest<First>(now.data());
    }
    return t;
}

} // namespace impact

// x: the four vertices [m]; p: their displacements [m] while time goes from 0 to 1 along straight lines. Returns a time in [0,
// 1] until which the distance stays above `min_distance`, or `no_impact` if it always does. A pair that moves but has no more
// than `min_distance` at the start may not move at all: 0.
inline double edge_edge_impact(const Vec3 x[4], const Vec3 p[4], double min_distance) {
    return impact::time<2>(x, p, min_distance, impact::closest<2>(x)); // vertices: a0 a1, b0 b1
}

inline double point_triangle_impact(const Vec3 x[4], const Vec3 p[4], double min_distance) {
    return impact::time<1>(x, p, min_distance, impact::closest<1>(x)); // vertices: the point, then the triangle's
}

} // namespace ringlet
