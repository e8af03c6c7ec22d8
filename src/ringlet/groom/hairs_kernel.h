// Kernel of hairs.h on plain arrays, compiled for each instruction set.
#pragma once

#include "ringlet/math/simd.h"

namespace ringlet {

// Segment of a lock for t in 0…1: the point c0 + t (c1 + t (c2 + t c3)) and the axes a + t da, b + t db. Rows are padded to
// four numbers, so that each is one register.
struct alignas(64) LockSegment {
    float c0[4], c1[4], c2[4], c3[4], a[4], da[4], b[4], db[4];
};

// Segments of one lock, one for every point; the last is constant at the tip.
struct LockTable {
    const LockSegment *segments;
    int last; // index of the tip
};

struct HairSpan {
    int count, points, knots;
    const float *offset, *tip, *join, *flat, *taper; // 2, 1, 1, 1 and 1 numbers a hair
    const float *frizz, *root;                       // 2 × knots and 3 numbers a hair
    const float *profile, *hold, *pace, *blend;      // one a point
    const int *other;                                // neighbouring lock of each hair, or null
    const float *share;                              // weight of that lock
    const LockTable *locks;                          // all locks, for `other`
    float *scratch;                                  // 6 × points
    float *result;                                   // 3 × points a hair
};

RINGLET_DECLARE(void fill_hairs(const LockTable &lock, const HairSpan &hairs);)

} // namespace ringlet
