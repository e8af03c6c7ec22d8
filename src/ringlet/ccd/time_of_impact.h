// The time of impact of two moving primitives by additive conservative advancement (Mirtich 1996; Li et al. 2021, section 4.2).
//
// For any unit vector n and time t, the distance is at least the minimum over (i, j) of n·(x_i − x_j) + t n·(p_i − p_j).
// Vertices i are of one primitive and j of the other, so this is the gap of their projections onto n. Each advancement takes n
// between the closest points and moves t to where this bound leaves a small part of the distance that may close. The bound
// holds for every n, so rounding in the closest points is harmless. Only differences of displacements occur, so a shared motion
// has no effect.
#pragma once

#include "ringlet/ccd/settings.h"
#include "ringlet/geometry/distance.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace ringlet {

inline constexpr double no_impact = std::numeric_limits<double>::infinity();

namespace accd {

// The first `First` of four vertices are one primitive, the others are the other.
template <int First> ClosestPoints closest(const Vec3 x[4]) {
    return (First == 2 ? closest_edge_edge : closest_point_triangle)(x[0], x[1], x[2], x[3]);
}

// x: the four vertices [m]; p: their displacements [m] along straight paths, for times from 0 to 1. Returns a time in [0, 1]
// until which the distance stays above `min_separation`, or `no_impact` if it always does. A pair in relative motion that
// begins no farther apart than `min_separation` has time of impact 0. `nearest` are the closest points at the start.
template <int First> double toi(const Vec3 x[4], const Vec3 p[4], double min_separation, ClosestPoints nearest) {
    std::array<Vec3, 4> start, motion; // relative to the last vertex
    double motion2 = 0.0;
    for (int i = 0; i < 4; ++i) {
        start[i] = x[i] - x[3];
        motion[i] = p[i] - p[3];
        motion2 += motion[i].squaredNorm();
    }
    if (motion2 == 0.0) return no_impact;
    if (!std::isfinite(motion2)) return 0.0;

    const double separation = std::max(min_separation, ccd::zero_distance);
    const double tolerance = ccd::convergence * (std::sqrt(nearest.distance2) - separation);
    double t = 0.0;
    std::array<Vec3, 4> now = start;
    for (int step = 0; step < ccd::max_advancements; ++step) {
        const double distance = std::sqrt(nearest.distance2);
        if (!(distance - separation > tolerance)) return t;
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
        if (!(gap - separation > tolerance)) return t;

        const double target = separation + ccd::advancement_rest * (gap - separation), remaining = 1.0 - t;
        double advance = remaining;
        bool separated = true; // to the end of the move
        for (int i = 0; i < First; ++i)
            for (int j = First; j < 4; ++j) {
                const double gap_ij = at[i] - at[j], closing = speed[j] - speed[i];
                separated &= gap_ij - remaining * closing >= separation;
                if (advance * closing > gap_ij - target) advance = (gap_ij - target) / closing;
            }
        if (separated) return no_impact;
        t = std::min(t + advance, 1.0);
        for (int i = 0; i < 4; ++i) now[i] = start[i] + t * motion[i];
        nearest = closest<First>(now.data());
    }
    return t;
}

} // namespace accd

} // namespace ringlet
