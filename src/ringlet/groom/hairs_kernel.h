// The inner loop of hairs.h on plain arrays, built for each instruction set.
#pragma once

#include "ringlet/math/simd.h"

namespace ringlet {

// A lock between two of its points, for t from 0 to 1: the point is c0 + t (c1 + t (c2 + t c3)) and its frame a + t da,
// b + t db. Rows of four numbers, of which three are used, so that a row is one register.
struct alignas(64) LockSegment {
    float c0[4], c1[4], c2[4], c3[4], a[4], da[4], b[4], db[4];
};

// One lock: a segment for every point; the last one stands still at the tip.
struct LockTable {
    const LockSegment *segments;
    int last; // index of the tip
};

struct HairSpan {
    int count, points, knots;
    const float *offset, *tip, *taper, *frizz, *root; // 2, 1, 1, 2 × knots and 3 numbers a hair
    const float *profile, *hold, *blend;              // one a point
    const int *other;                                 // a neighbouring lock for each hair, or null
    const float *share;                               // how much of it the hair takes
    const LockTable *locks;                           // where those are
    float *scratch;                                   // 6 × points
    float *result;                                    // 3 × points a hair
};

RINGLET_DECLARE(void fill_hairs(const LockTable &lock, const HairSpan &hairs);)

} // namespace ringlet
