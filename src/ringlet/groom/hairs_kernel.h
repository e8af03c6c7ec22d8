// The inner loop of hairs.h on plain arrays, built for each instruction set.
#pragma once

#include "ringlet/math/simd.h"

namespace ringlet {

// One lock: coordinates and frame axes apart, with one point more before the root and two after the tip, for the spline.
struct LockTable {
    const float *point[3], *a[3], *b[3]; // at the root
    int last;                            // index of the tip
};

struct HairSpan {
    int count, points, knots;
    const float *offset, *tip, *frizz, *root; // 2, 1, 2 × knots and 3 numbers a hair
    const float *profile, *hold;              // one a point
    float *scratch;                           // 5 × points
    float *result;                            // 3 × points a hair
};

RINGLET_DECLARE(void fill_hairs(const LockTable &lock, const HairSpan &hairs);)

} // namespace ringlet
