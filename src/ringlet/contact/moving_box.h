// A box around something at the start of its motion, and one around it at the end; in between all goes straight.
#pragma once

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

// Four boxes side by side: lane k of each array is of box k.
struct MovingQuad {
    std::array<Eigen::Array4f, 3> low, high, end_low, end_high;
    Eigen::Array4f who_counts;

    void set(int k, const MovingBox &box) {
        for (int axis = 0; axis < 3; ++axis) {
            low[axis][k] = box.low[axis];
            high[axis][k] = box.high[axis];
            end_low[axis][k] = box.end_low[axis];
            end_high[axis][k] = box.end_high[axis];
        }
        who_counts[k] = box.low[3];
    }

    MovingBox box(int k) const {
        return {{low[0][k], low[1][k], low[2][k], who_counts[k]},
                {high[0][k], high[1][k], high[2][k], 0.0f},
                {end_low[0][k], end_low[1][k], end_low[2][k], 0.0f},
                {end_high[0][k], end_high[1][k], end_high[2][k], 0.0f}};
    }
};

// With which boxes of b another overlaps on each axis at some time: a bit for each. What is in the rest never comes together
// with what is in that one.
[[gnu::always_inline]] inline unsigned which_may_meet(const MovingBox &a, const MovingQuad &b) {
    Eigen::Array4f apart = b.who_counts + a.low[3]; // above 0: never
    for (int axis = 0; axis < 3; ++axis) {
        const Eigen::Array4f above = (b.low[axis] - a.high[axis]).min(b.end_low[axis] - a.end_high[axis]);
        const Eigen::Array4f below = (a.low[axis] - b.high[axis]).min(a.end_low[axis] - b.end_high[axis]);
        apart = apart.max(above.max(below));
    }
    unsigned which = 0;
    for (int l = 0; l < 4; ++l) which |= unsigned(apart[l] <= 0.0f) << l;
    return which;
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
