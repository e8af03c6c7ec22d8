// Vectors of the unknowns of a group of strands, a strand per lane: every row is a number of each. What a vector is multiplied
// by, and the product of two, is one number a lane.
#pragma once

#include "ringlet/math/simd.h"

namespace ringlet {

// clang-format off
RINGLET_DECLARE(
    void lane_products(const double *a, const double *b, int rows, double *products);                     // Σ a b
    void lane_move(const double *x, const double *step, const double *straight, const double *bend, int rows, double *to); // to = x + step · (straight + step · bend)
)
// clang-format on

} // namespace ringlet
