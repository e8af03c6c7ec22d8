#include "ringlet/collision/overlap_kernel.h"

#include "ringlet/math/floats.h"

namespace ringlet::RINGLET_SIMD {
namespace {

// The sixteen pairs of two quads' boxes, 4k + l being box k of the one and l of the other, are looked at in parts of a width.
#if defined(RINGLET_SIMD_avx512)
#define RINGLET_FIRST 0, 0, 0, 0, 5, 5, 5, 5, 10, 10, 10, 10, 15, 15, 15, 15
#elif defined(RINGLET_SIMD_avx2)
#define RINGLET_FIRST 0, 0, 0, 0, 5, 5, 5, 5
#else
#define RINGLET_FIRST 0, 0, 0, 0
#endif

constexpr int parts = 16 / width;
constexpr unsigned each_once = 0x08ce; // l > k

Floats of_first(const float *row, int part) {
    const Floats x = repeat(row + part * width / 4);
    return __builtin_shufflevector(x, x, RINGLET_FIRST);
}
Floats of_second(const float *row) { return repeat(row); }

// Calls gaps(gap, end_gap) for what is between the boxes of a part's pairs on each axis, from both sides, at the start and at
// the end.
template <class Gaps>
void for_gaps(const BoxQuad &a, const EndQuad &end_a, const BoxQuad &b, const EndQuad &end_b, int part, const Gaps &gaps) {
    for (int axis = 0; axis < 3; ++axis) {
        gaps(of_second(b.low[axis]) - of_first(a.high[axis], part),
             of_second(end_b.low[axis]) - of_first(end_a.high[axis], part));
        gaps(of_first(a.low[axis], part) - of_second(b.high[axis]),
             of_first(end_a.low[axis], part) - of_second(end_b.high[axis]));
    }
}

// Above 0 where neither of a pair counts, or neither moves: then they are never looked at.
Floats neither_counts(const BoxQuad &a, const BoxQuad &b, int part) {
    return greater(of_first(a.counts, part) + of_second(b.counts), of_first(a.moves, part) + of_second(b.moves));
}

// Which boxes overlap on each axis at some time. What is in the rest never comes together.
unsigned may_meet(const BoxQuad &a, const EndQuad &end_a, const BoxQuad &b, const EndQuad &end_b) {
    unsigned which = 0;
    for (int part = 0; part < parts; ++part) {
        Floats apart = neither_counts(a, b, part);
        for_gaps(a, end_a, b, end_b, part, [&](Floats gap, Floats end_gap) { apart = greater(apart, lesser(gap, end_gap)); });
        which |= lanes_of(apart <= 0.0f) << part * width;
    }
    return which;
}

// The same where boxes stay.
unsigned overlap(const BoxQuad &a, const BoxQuad &b) {
    unsigned which = 0;
    for (int part = 0; part < parts; ++part) {
        Floats apart = neither_counts(a, b, part);
        for (int axis = 0; axis < 3; ++axis) {
            apart = greater(apart, of_second(b.low[axis]) - of_first(a.high[axis], part));
            apart = greater(apart, of_first(a.low[axis], part) - of_second(b.high[axis]));
        }
        which |= lanes_of(apart <= 0.0f) << part * width;
    }
    return which;
}

// Which overlap on all three axes at one and the same time.
unsigned meet_at_one_time(const BoxQuad &a, const EndQuad &end_a, const BoxQuad &b, const EndQuad &end_b) {
    const Floats none = {}, one = none + 1.0f, never = none + 2.0f, rounding = none + 1e-6f;
    unsigned which = 0;
    for (int part = 0; part < parts; ++part) {
        Floats from = none, to = one;
        for_gaps(a, end_a, b, end_b, part, [&](Floats gap, Floats end_gap) { // (1 − t) gap + t end_gap ≤ 0
            const Floats t = gap / (gap - end_gap);
            const Floats opens = end_gap <= none ? t : never, closes = end_gap <= none ? one : t;
            from = gap > none ? greater(from, opens) : from;
            to = gap > none ? to : lesser(to, closes);
        });
        which |= lanes_of(from <= to + rounding) << part * width;
    }
    return which;
}

} // namespace

void descend(Descent &d, int most_visits) {
    const auto leave = [&](int i, int j) { d.nodes[d.left++] = {{i, j}}; };
    for (int visit = 0; visit < most_visits && d.left > 0 && d.found + 16 <= Descent::room; ++visit) {
        const BoxPair node = d.nodes[--d.left];
        const int i = node.of[0], j = node.of[1];
        const BoxQuad &a = d.a.nodes[i], &b = d.b.nodes[j];
        const bool itself = d.one_tree && i == j, leaf_a = i >= d.a.first_leaf, leaf_b = j >= d.b.first_leaf;
        const EndQuad &end_a = d.a.ends[i], &end_b = d.b.ends[j];
        unsigned which = d.still ? overlap(a, b) : may_meet(a, end_a, b, end_b);
        if (itself) {
            which &= each_once;
            for (int k = 0; !leaf_a && k < (i == 0 ? d.a.children_of_root : 4); ++k) leave(4 * i + 1 + k, 4 * i + 1 + k);
        }
        if (leaf_a && leaf_b) {
            if (which != 0 && !d.still) which &= meet_at_one_time(a, end_a, b, end_b);
            for (; which != 0; which &= which - 1) {
                const int lane = __builtin_ctz(which);
                d.boxes[d.found++] = {{4 * i + lane / 4, 4 * j + lane % 4}};
            }
        } else if (leaf_a) {
            for (int l = 0; l < 4; ++l)
                if (which & (0x1111u << l)) leave(i, 4 * j + 1 + l);
        } else if (leaf_b) {
            for (int k = 0; k < 4; ++k)
                if (which & (0xfu << 4 * k)) leave(4 * i + 1 + k, j);
        } else {
            for (; which != 0; which &= which - 1) {
                const int lane = __builtin_ctz(which);
                leave(4 * i + 1 + lane / 4, 4 * j + 1 + lane % 4);
            }
        }
    }
}

} // namespace ringlet::RINGLET_SIMD
