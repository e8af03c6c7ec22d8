#include "ringlet/geometry/bvh_traversal.h"

#include "ringlet/geometry/settings.h"
#include "ringlet/math/floats.h"

namespace ringlet::RINGLET_SIMD {
namespace {

// The sixteen pairs of two quads' boxes, 4k + l being box k of the first and l of the second, are compared a SIMD width at a
// time.
#if defined(RINGLET_SIMD_avx512)
#define RINGLET_FIRST 0, 0, 0, 0, 5, 5, 5, 5, 10, 10, 10, 10, 15, 15, 15, 15
#elif defined(RINGLET_SIMD_avx2)
#define RINGLET_FIRST 0, 0, 0, 0, 5, 5, 5, 5
#else
#define RINGLET_FIRST 0, 0, 0, 0
#endif

constexpr int chunks = 16 / width;
constexpr unsigned each_once = 0x08ce; // l > k

Floats of_first(const float *row, int chunk) {
    const Floats x = repeat(row + chunk * width / 4);
    return __builtin_shufflevector(x, x, RINGLET_FIRST);
}
Floats of_second(const float *row) { return repeat(row); }

// Calls gaps(gap, end_gap) with the gaps of a chunk's pairs along each axis, from both sides, at the start and at
// the end.
template <class Gaps>
void for_gaps(const BoxQuad &a, const EndQuad &end_a, const BoxQuad &b, const EndQuad &end_b, int chunk, const Gaps &gaps) {
    for (int axis = 0; axis < 3; ++axis) {
        gaps(of_second(b.low[axis]) - of_first(a.high[axis], chunk),
             of_second(end_b.low[axis]) - of_first(end_a.high[axis], chunk));
        gaps(of_first(a.low[axis], chunk) - of_second(b.high[axis]),
             of_first(end_a.low[axis], chunk) - of_second(end_b.high[axis]));
    }
}

// Positive where neither box is active, or neither moves: such pairs are ignored.
Floats ignored(const BoxQuad &a, const BoxQuad &b, int chunk) {
    return greater(of_first(a.active, chunk) + of_second(b.active), of_first(a.moves, chunk) + of_second(b.moves));
}

// Pairs that overlap along each axis at some time, perhaps at different ones.
unsigned may_overlap(const BoxQuad &a, const EndQuad &end_a, const BoxQuad &b, const EndQuad &end_b) {
    unsigned which = 0;
    for (int chunk = 0; chunk < chunks; ++chunk) {
        Floats gap_bound = ignored(a, b, chunk);
        for_gaps(a, end_a, b, end_b, chunk,
                 [&](Floats gap, Floats end_gap) { gap_bound = greater(gap_bound, lesser(gap, end_gap)); });
        which |= lanes_of(gap_bound <= 0.0f) << chunk * width;
    }
    return which;
}

// The same for static boxes.
unsigned overlap(const BoxQuad &a, const BoxQuad &b) {
    unsigned which = 0;
    for (int chunk = 0; chunk < chunks; ++chunk) {
        Floats gap_bound = ignored(a, b, chunk);
        for (int axis = 0; axis < 3; ++axis) {
            gap_bound = greater(gap_bound, of_second(b.low[axis]) - of_first(a.high[axis], chunk));
            gap_bound = greater(gap_bound, of_first(a.low[axis], chunk) - of_second(b.high[axis]));
        }
        which |= lanes_of(gap_bound <= 0.0f) << chunk * width;
    }
    return which;
}

// Pairs that overlap along all three axes at one time.
unsigned overlap_at_one_time(const BoxQuad &a, const EndQuad &end_a, const BoxQuad &b, const EndQuad &end_b) {
    const Floats none = {}, one = none + 1.0f, never = none + 2.0f, rounding = none + bvh_settings::time_rounding;
    unsigned which = 0;
    for (int chunk = 0; chunk < chunks; ++chunk) {
        Floats from = none, to = one;
        for_gaps(a, end_a, b, end_b, chunk, [&](Floats gap, Floats end_gap) { // (1 − t) gap + t end_gap ≤ 0
            const Floats t = gap / (gap - end_gap);
            const Floats opens = end_gap <= none ? t : never, closes = end_gap <= none ? one : t;
            from = gap > none ? greater(from, opens) : from;
            to = gap > none ? to : lesser(to, closes);
        });
        which |= lanes_of(from <= to + rounding) << chunk * width;
    }
    return which;
}

} // namespace

void traverse(Traversal &d, int max_visits) {
    const auto push = [&](int i, int j) { d.nodes[d.left++] = {{i, j}}; };
    for (int visit = 0; visit < max_visits && d.left > 0 && d.found + 16 <= Traversal::room; ++visit) {
        const NodePair node = d.nodes[--d.left];
        const int i = node.of[0], j = node.of[1];
        const BoxQuad &a = d.a.starts[i], &b = d.b.starts[j];
        const bool itself = d.one_tree && i == j, leaf_a = i >= d.a.first_leaf, leaf_b = j >= d.b.first_leaf;
        const EndQuad &end_a = d.a.ends[i], &end_b = d.b.ends[j];
        unsigned which = d.is_static ? overlap(a, b) : may_overlap(a, end_a, b, end_b);
        if (itself) {
            which &= each_once;
            for (int k = 0; !leaf_a && k < (i == 0 ? d.a.children_of_root : 4); ++k) push(4 * i + 1 + k, 4 * i + 1 + k);
        }
        if (leaf_a && leaf_b) {
            if (which != 0 && !d.is_static) which &= overlap_at_one_time(a, end_a, b, end_b);
            for (; which != 0; which &= which - 1) {
                const int lane = __builtin_ctz(which);
                d.boxes[d.found++] = {{4 * i + lane / 4, 4 * j + lane % 4}};
            }
        } else if (leaf_a) {
            for (int l = 0; l < 4; ++l)
                if (which & (0x1111u << l)) push(i, 4 * j + 1 + l);
        } else if (leaf_b) {
            for (int k = 0; k < 4; ++k)
                if (which & (0xfu << 4 * k)) push(4 * i + 1 + k, j);
        } else {
            for (; which != 0; which &= which - 1) {
                const int lane = __builtin_ctz(which);
                push(4 * i + 1 + lane / 4, 4 * j + 1 + lane % 4);
            }
        }
    }
}

} // namespace ringlet::RINGLET_SIMD
