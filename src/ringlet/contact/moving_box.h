// A box that holds the places of something at the start, and an interval that holds its displacements.
#pragma once

#include "ringlet/math/types.h"

#include <algorithm>

namespace ringlet {

// Two boxes are compared by their relative motion, so that a motion which both share changes nothing. The fourth lane does the
// same for who moves: two boxes with nothing in them that moves are apart in it.
struct MovingBox {
    Eigen::Array4f low, high, motion_low, motion_high;

    void include(const MovingBox &other) {
        low = low.min(other.low);
        high = high.max(other.high);
        motion_low = motion_low.min(other.motion_low);
        motion_high = motion_high.max(other.motion_high);
    }

    // By `reach`, and by what may be lost in computing with it in single precision.
    void widen(float reach, bool moves) {
        constexpr float rounding = 0x1p-21f;
        const Eigen::Array4f by = reach + rounding * (low.abs().max(high.abs()) + motion_low.abs().max(motion_high.abs()));
        low -= by;
        high += by;
        low[3] = moves ? -2.0f : 1.0f;
        high[3] = moves ? 2.0f : -1.0f;
        motion_low[3] = motion_high[3] = 0.0f;
    }
};

// Whether, on each axis, the boxes overlap at some time; false means that what they hold never comes together.
inline bool may_meet(const MovingBox &a, const MovingBox &b) {
    const Eigen::Array4f gap_above = b.low - a.high + (b.motion_low - a.motion_high).min(0.0f);
    const Eigen::Array4f gap_below = a.low - b.high + (a.motion_low - b.motion_high).min(0.0f);
    return gap_above.max(gap_below).maxCoeff() <= 0.0f;
}

// Whether they overlap on all three axes at one and the same time, after they have been drawn in by `less` in all.
inline bool meet_at_one_time(const MovingBox &a, const MovingBox &b, float less) {
    constexpr float rounding = 1e-6f;
    float from = 0.0f, to = 1.0f;
    const auto needs = [&](float gap, float closing) { // gap − t closing ≤ 0
        if (gap > 0.0f)
            from = std::max(from, closing > 0.0f ? gap / closing : 2.0f);
        else if (closing < 0.0f)
            to = std::min(to, gap / closing);
    };
    for (int k = 0; k < 3; ++k) {
        needs(b.low[k] - a.high[k] + less, a.motion_high[k] - b.motion_low[k]);
        needs(a.low[k] - b.high[k] + less, b.motion_high[k] - a.motion_low[k]);
    }
    return from <= to + rounding;
}

} // namespace ringlet
