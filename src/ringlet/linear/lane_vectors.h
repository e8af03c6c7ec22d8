// Vectors of independent systems side by side: row i of lane l stands at [i · lanes + l]. Dot products and step lengths are one
// number a lane; `lanes` is 1 or the width of the kernels.
#pragma once

#include "ringlet/math/simd.h"

namespace ringlet {

inline constexpr int max_lanes = 8; // of any instruction set

// dots[l] = Σ a b over the rows of lane l.
void lane_dots(const double *a, const double *b, int rows, int lanes, double *dots);

// The points x + t · (straight + t · bend) of curved paths, t being one number a lane.
void lane_points(const double *x, const double *t, const double *straight, const double *bend, int rows, int lanes, double *to);

// clang-format off
RINGLET_DECLARE(
    int lane_width();
    void lane_dots(const double *a, const double *b, int rows, double *dots);
    void lane_points(const double *x, const double *t, const double *straight, const double *bend, int rows, double *to);
)
// clang-format on

} // namespace ringlet
