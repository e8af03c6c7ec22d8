// Vectors of the unknowns of a group of strands, a strand per lane: every row is a number of each. What a vector is multiplied
// by, and the product of two, is one number a lane.
#pragma once

#include "ringlet/math/simd.h"

namespace ringlet {

// clang-format off
RINGLET_DECLARE(
    void lane_products(const double *a, const double *b, int rows, double *products);                     // Σ a b
    void lane_move(const double *x, const double *step, const double *direction, int rows, double *to);   // to = x + step · direction
    // Of conjugate gradients, with r what is left, P z = r, p where to search: p = z + β p and, with it, P p; says p · P p.
    void lane_search(const double *z, const double *r, const double *beta, int rows, double *p, double *Pp, double *curvatures);
    void lane_advance(const double *alpha, const double *p, const double *Pp, int rows, double *d, double *r); // d += α p, r −= α P p
)
// clang-format on

} // namespace ringlet
