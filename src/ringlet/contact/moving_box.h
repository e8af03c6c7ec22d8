// A box around something at the start of its motion, and one around it at the end; in between all goes straight.
#pragma once

#include "ringlet/contact/overlap_kernel.h"
#include "ringlet/math/types.h"

#include <algorithm>
#include <array>
#include <limits>

namespace ringlet {

// Boxes are compared by what is between them at the start and at the end, so that a motion which they share changes nothing: on
// each axis the distance of two points that move straight is never less than the lesser of the two. The fourth lane tells who
// counts: who moves, say.
struct MovingBox {
    static constexpr float does_not_count = 1.0f; // the sum of two is positive where neither counts
    Eigen::Array4f low, high, end_low, end_high;

    static MovingBox nothing() { // apart from everything
        const Eigen::Array4f infinite = Eigen::Array4f::Constant(std::numeric_limits<float>::infinity());
        return {infinite, -infinite, infinite, -infinite};
    }

    void include(const MovingBox &other) {
        low = low.min(other.low);
        high = high.max(other.high);
        end_low = end_low.min(other.end_low);
        end_high = end_high.max(other.end_high);
    }

    // By `reach`, and by what may be lost in computing with it in single precision.
    void widen(float reach, bool counts) {
        constexpr float rounding = 0x1p-21f;
        const Eigen::Array4f largest = low.abs().max(high.abs()).max(end_low.abs()).max(end_high.abs());
        const Eigen::Array4f by = reach + rounding * largest;
        low -= by;
        high += by;
        end_low -= by;
        end_high += by;
        low[3] = counts ? -2.0f : does_not_count;
    }
};

inline void set_box(BoxQuad &quad, int k, const MovingBox &box) {
    for (int axis = 0; axis < 3; ++axis) {
        quad.low[axis][k] = box.low[axis];
        quad.high[axis][k] = box.high[axis];
        quad.end_low[axis][k] = box.end_low[axis];
        quad.end_high[axis][k] = box.end_high[axis];
    }
    quad.who_counts[k] = box.low[3];
}

inline MovingBox box_of(const BoxQuad &quad, int k) {
    const auto corner = [&](const float (&rows)[3][4], float last) -> Eigen::Array4f {
        return {rows[0][k], rows[1][k], rows[2][k], last};
    };
    return {corner(quad.low, quad.who_counts[k]), corner(quad.high, 0.0f), corner(quad.end_low, 0.0f),
            corner(quad.end_high, 0.0f)};
}

// Whether two boxes overlap on all three axes at one and the same time, after they have been drawn in by `less` in all.
inline bool meet_at_one_time(const MovingBox &a, const MovingBox &b, float less) {
    constexpr float rounding = 1e-6f;
    float from = 0.0f, to = 1.0f;
    const auto needs = [&](float gap, float end_gap) { // (1 − t) gap + t end_gap ≤ 0
        if (gap > 0.0f)
            from = std::max(from, end_gap <= 0.0f ? gap / (gap - end_gap) : 2.0f);
        else if (end_gap > 0.0f)
            to = std::min(to, gap / (gap - end_gap));
    };
    for (int axis = 0; axis < 3; ++axis) {
        needs(b.low[axis] - a.high[axis] + less, b.end_low[axis] - a.end_high[axis] + less);
        needs(a.low[axis] - b.high[axis] + less, a.end_low[axis] - b.end_high[axis] + less);
    }
    return from <= to + rounding;
}

} // namespace ringlet
