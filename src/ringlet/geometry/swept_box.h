// A swept AABB: one box at the start of a linear motion and one at its end.
#pragma once

#include "ringlet/geometry/bvh_traversal.h"
#include "ringlet/geometry/settings.h"
#include "ringlet/math/types.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <limits>

namespace ringlet {

// Boxes are compared by their gaps at the start and at the end, so that a shared motion has no effect. Along each axis the gap
// of two points in linear motion is never below the lesser of these. The fourth lanes are flags: whether the box is active and
// whether it moves. A minimum of two flags is that of their union.
struct SweptBox {
    static constexpr float yes = -2.0f, no = 1.0f; // the sum of two flags is positive where both are no
    Eigen::Array4f low, high, end_low, end_high;

    static SweptBox empty() { // overlaps nothing
        const Eigen::Array4f infinite = Eigen::Array4f::Constant(std::numeric_limits<float>::infinity());
        return {infinite, -infinite, infinite, -infinite};
    }

    // A box that does not move, with room for rounding to single precision.
    static SweptBox around(const Vec3 &low, const Vec3 &high) {
        const double room =
            bvh_settings::coordinate_rounding * std::max(low.lpNorm<Eigen::Infinity>(), high.lpNorm<Eigen::Infinity>());
        SweptBox box;
        box.low << (low.array() - room).cast<float>(), 0.0f;
        box.high << (high.array() + room).cast<float>(), 0.0f;
        box.end_low = box.low, box.end_high = box.high;
        box.set_flags(true, true);
        return box;
    }

    void include(const SweptBox &other) {
        low = low.min(other.low);
        high = high.max(other.high);
        end_low = end_low.min(other.end_low);
        end_high = end_high.max(other.end_high);
    }

    void inflate(float by) {
        low -= by;
        high += by;
        end_low -= by;
        end_high += by;
    }

    void set_flags(bool active, bool moves) {
        low[3] = active ? yes : no;
        end_low[3] = moves ? yes : no;
    }
};

// Transposes four rows into columns.
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

inline void set_boxes(BoxQuad &quad, EndQuad &end, const SweptBox (&boxes)[4]) {
    float columns[4][4];
    const auto set = [&](Eigen::Array4f SweptBox::*corner, float (&rows)[3][4]) {
        transpose({boxes[0].*corner, boxes[1].*corner, boxes[2].*corner, boxes[3].*corner}, columns);
        std::memcpy(rows, columns, sizeof(rows));
    };
    set(&SweptBox::high, quad.high), set(&SweptBox::end_high, end.high);
    set(&SweptBox::low, quad.low);
    std::memcpy(quad.active, columns[3], sizeof(columns[3]));
    set(&SweptBox::end_low, end.low);
    std::memcpy(quad.moves, columns[3], sizeof(columns[3]));
}

inline void set_box(BoxQuad &quad, EndQuad &end, int k, const SweptBox &box) {
    for (int axis = 0; axis < 3; ++axis) {
        quad.low[axis][k] = box.low[axis];
        quad.high[axis][k] = box.high[axis];
        end.low[axis][k] = box.end_low[axis];
        end.high[axis][k] = box.end_high[axis];
    }
    quad.active[k] = box.low[3];
    quad.moves[k] = box.end_low[3];
}

inline SweptBox box_of(const BoxQuad &quad, const EndQuad &end, int k) {
    const auto corner = [&](const float (&rows)[3][4], float flag) -> Eigen::Array4f {
        return {rows[0][k], rows[1][k], rows[2][k], flag};
    };
    return {corner(quad.low, quad.active[k]), corner(quad.high, 0.0f), corner(end.low, quad.moves[k]), corner(end.high, 0.0f)};
}

// The union of four boxes.
inline SweptBox box_of(const BoxQuad &quad, const EndQuad &end) {
    using Row = Eigen::Map<const Eigen::Array4f>;
    const auto least = [](const float (&rows)[3][4], float flag) -> Eigen::Array4f {
        return {Row(rows[0]).minCoeff(), Row(rows[1]).minCoeff(), Row(rows[2]).minCoeff(), flag};
    };
    const auto most = [](const float (&rows)[3][4]) -> Eigen::Array4f {
        return {Row(rows[0]).maxCoeff(), Row(rows[1]).maxCoeff(), Row(rows[2]).maxCoeff(), 0.0f};
    };
    return {least(quad.low, Row(quad.active).minCoeff()), most(quad.high), least(end.low, Row(quad.moves).minCoeff()),
            most(end.high)};
}

// The squared distances of a place from four boxes at the start; infinite of empty ones.
inline Eigen::Array4f distances2(const BoxQuad &quad, const Eigen::Array3f &place) {
    using Row = Eigen::Map<const Eigen::Array4f>;
    Eigen::Array4f sum = Eigen::Array4f::Zero();
    for (int axis = 0; axis < 3; ++axis) {
        const Eigen::Array4f outside = (Row(quad.low[axis]) - place[axis]).max(place[axis] - Row(quad.high[axis])).max(0.0f);
        sum += outside * outside;
    }
    return sum;
}

// Whether two boxes may overlap at one time: along no axis is there a gap at the start and, on the same side, at the end.
inline bool may_overlap(const SweptBox &a, const SweptBox &b) {
    const Eigen::Array4f above = (b.low - a.high).min(b.end_low - a.end_high);
    const Eigen::Array4f below = (a.low - b.high).min(a.end_low - b.end_high);
    return above.max(below).head<3>().maxCoeff() <= 0.0f;
}

// Whether two boxes may overlap if each is anywhere on its path.
inline bool paths_overlap(const SweptBox &a, const SweptBox &b) {
    const Eigen::Array4f above = b.low.min(b.end_low) - a.high.max(a.end_high);
    const Eigen::Array4f below = a.low.min(a.end_low) - b.high.max(b.end_high);
    return above.max(below).head<3>().maxCoeff() <= 0.0f;
}

// Whether two boxes, shrunk by `less` in all, overlap along all three axes at one time.
inline bool overlap_at_one_time(const SweptBox &a, const SweptBox &b, float less) {
    float from = 0.0f, to = 1.0f;
    const auto restrict_to = [&](float gap, float end_gap) { // (1 − t) gap + t end_gap ≤ 0
        if (gap > 0.0f)
            from = std::max(from, end_gap <= 0.0f ? gap / (gap - end_gap) : 2.0f);
        else if (end_gap > 0.0f)
            to = std::min(to, gap / (gap - end_gap));
    };
    for (int axis = 0; axis < 3; ++axis) {
        restrict_to(b.low[axis] - a.high[axis] + less, b.end_low[axis] - a.end_high[axis] + less);
        restrict_to(a.low[axis] - b.high[axis] + less, a.end_low[axis] - b.end_high[axis] + less);
    }
    return from <= to + bvh_settings::time_rounding;
}

} // namespace ringlet
