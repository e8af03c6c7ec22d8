// A box around something at the start of its motion, and one around it at the end; in between all goes straight.
#pragma once

#include "ringlet/collision/overlap_kernel.h"
#include "ringlet/math/types.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <limits>

namespace ringlet {

// Boxes are compared by what is between them at the start and at the end, so that a motion which they share changes nothing: on
// each axis the distance of two points that move straight is never less than the lesser of the two. The fourth lanes tell who
// counts, and who moves: the lesser is what holds of two together.
struct MovingBox {
    static constexpr float does = -2.0f, does_not = 1.0f; // the sum of two is positive where neither does
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

    void widen(float by) {
        low -= by;
        high += by;
        end_low -= by;
        end_high += by;
    }

    void count(bool counts, bool moves) {
        low[3] = counts ? does : does_not;
        end_low[3] = moves ? does : does_not;
    }
};

// Four rows become columns.
inline void transpose(const Eigen::Array4f (&rows)[4], float (&columns)[4][4]) {
    using Four = float __attribute__((vector_size(16)));
    Four r[4];
    for (int i = 0; i < 4; ++i) std::memcpy(&r[i], rows[i].data(), sizeof(Four));
    const Four a = __builtin_shufflevector(r[0], r[1], 0, 4, 1, 5), b = __builtin_shufflevector(r[2], r[3], 0, 4, 1, 5);
    const Four c = __builtin_shufflevector(r[0], r[1], 2, 6, 3, 7), d = __builtin_shufflevector(r[2], r[3], 2, 6, 3, 7);
    const Four out[4] = {__builtin_shufflevector(a, b, 0, 1, 4, 5), __builtin_shufflevector(a, b, 2, 3, 6, 7),
                         __builtin_shufflevector(c, d, 0, 1, 4, 5), __builtin_shufflevector(c, d, 2, 3, 6, 7)};
    std::memcpy(columns, out, sizeof(out));
}

inline void set_boxes(BoxQuad &quad, EndQuad &end, const MovingBox (&boxes)[4]) {
    float columns[4][4];
    const auto set = [&](Eigen::Array4f MovingBox::*corner, float (&rows)[3][4]) {
        transpose({boxes[0].*corner, boxes[1].*corner, boxes[2].*corner, boxes[3].*corner}, columns);
        std::memcpy(rows, columns, sizeof(rows));
    };
    set(&MovingBox::high, quad.high), set(&MovingBox::end_high, end.high);
    set(&MovingBox::low, quad.low);
    std::memcpy(quad.counts, columns[3], sizeof(columns[3]));
    set(&MovingBox::end_low, end.low);
    std::memcpy(quad.moves, columns[3], sizeof(columns[3]));
}

inline void set_box(BoxQuad &quad, EndQuad &end, int k, const MovingBox &box) {
    for (int axis = 0; axis < 3; ++axis) {
        quad.low[axis][k] = box.low[axis];
        quad.high[axis][k] = box.high[axis];
        end.low[axis][k] = box.end_low[axis];
        end.high[axis][k] = box.end_high[axis];
    }
    quad.counts[k] = box.low[3];
    quad.moves[k] = box.end_low[3];
}

inline MovingBox box_of(const BoxQuad &quad, const EndQuad &end, int k) {
    const auto corner = [&](const float (&rows)[3][4], float last) -> Eigen::Array4f {
        return {rows[0][k], rows[1][k], rows[2][k], last};
    };
    return {corner(quad.low, quad.counts[k]), corner(quad.high, 0.0f), corner(end.low, quad.moves[k]), corner(end.high, 0.0f)};
}

// Around the four.
inline MovingBox box_of(const BoxQuad &quad, const EndQuad &end) {
    using Row = Eigen::Map<const Eigen::Array4f>;
    const auto least = [](const float (&rows)[3][4], float last) -> Eigen::Array4f {
        return {Row(rows[0]).minCoeff(), Row(rows[1]).minCoeff(), Row(rows[2]).minCoeff(), last};
    };
    const auto most = [](const float (&rows)[3][4]) -> Eigen::Array4f {
        return {Row(rows[0]).maxCoeff(), Row(rows[1]).maxCoeff(), Row(rows[2]).maxCoeff(), 0.0f};
    };
    return {least(quad.low, Row(quad.counts).minCoeff()), most(quad.high), least(end.low, Row(quad.moves).minCoeff()),
            most(end.high)};
}

// Whether two boxes may overlap at one time: on no axis are they apart at the start and, on the same side, at the end.
inline bool may_meet(const MovingBox &a, const MovingBox &b) {
    const Eigen::Array4f above = (b.low - a.high).min(b.end_low - a.end_high);
    const Eigen::Array4f below = (a.low - b.high).min(a.end_low - b.end_high);
    return above.max(below).head<3>().maxCoeff() <= 0.0f;
}

// Whether two boxes may overlap if each is anywhere on its way.
inline bool ways_overlap(const MovingBox &a, const MovingBox &b) {
    const Eigen::Array4f above = b.low.min(b.end_low) - a.high.max(a.end_high);
    const Eigen::Array4f below = a.low.min(a.end_low) - b.high.max(b.end_high);
    return above.max(below).head<3>().maxCoeff() <= 0.0f;
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
