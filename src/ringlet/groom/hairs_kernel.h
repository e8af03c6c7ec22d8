// Kernel of hairs.h on plain arrays, compiled for each instruction set.
#pragma once

#include "ringlet/math/simd.h"

namespace ringlet {

// Segment of a lock for t in 0…1: the point c0 + t (c1 + t (c2 + t c3)) and the axes a + t da, b + t db. Rows are padded to
// four numbers, so that each is one register.
struct alignas(64) LockSegment {
    float c0[4], c1[4], c2[4], c3[4], a[4], da[4], b[4], db[4];
};

// Centre line of the coil on the same segment: the frame u + t du, v + t dv; the fourth numbers are the lock's place in it [m].
struct alignas(64) CentreSegment {
    float u[4], v[4], du[4], dv[4];
};

// Segments of one lock, one for every point; the last is constant at the tip.
struct LockTable {
    const LockSegment *segments;
    const CentreSegment *centres; // null without a curl of hairs
    int last;                     // index of the tip
};

// Arrays of HairCurl from the first hair of a lock on.
struct CurlSpan {
    const float *slip, *escape, *relax, *family, *coil, *phase;
    const float *escaping, *relaxing, *tight, *opening;
};

struct HairSpan {
    int count, points, knots;
    const float *offset, *tip, *join, *flat, *taper; // 2, 1, 1, 1 and 1 numbers a hair
    const float *frizz, *root;                       // 2 × knots and 3 numbers a hair
    const float *profile, *hold, *pace, *blend;      // one a point
    const int *other;                                // neighbouring lock of each hair, or null
    const float *share;                              // weight of that lock
    const LockTable *locks;                          // all locks, for `other`
    CurlSpan curl;                                   // null without a curl of hairs
    float *scratch;                                  // scratch_rows × points
    float *result;                                   // 3 × points a hair
};

inline constexpr int scratch_rows = 10;

RINGLET_DECLARE(void fill_hairs(const LockTable &lock, const HairSpan &hairs);)

} // namespace ringlet
