// Stability of strands in static equilibrium: whether the Hessian of the elastic energy is positive definite, and the least
// stiffening of bend and twist that makes it so.
//
// A term ½ k r² of bend or twist has the Hessian k ∇r ∇rᵀ + k r ∇²r: its material and its geometric stiffness. The internal
// force k r balances the loads and does not depend on the stiffness. So when a strand becomes s times stiffer, and its rest
// shape changes such that the equilibrium stays, only the first term grows. The Hessian is s A + B, with A ≥ 0.
#pragma once

#include "ringlet/math/simd.h"

#include <cstddef>

namespace ringlet {

// Strands in equilibrium, packed like Curves, one row per vertex; values of an edge are in the row of its first vertex.
struct StaticStrands {
    const int *offsets;
    const unsigned char *held;
    const double *positions, *directors;
    const double *rest_length, *rest_angle, *rest_dihedral;
    const double *stretch_stiffness, *bend_stiffness, *twist_stiffness;
};

// clang-format off
RINGLET_DECLARE(
    size_t stability_scratch(int vertices); // doubles of scratch memory for the next function
    double stabilising_stiffness(const StaticStrands &strands, int strand, double left, double most, double *room);
)
// clang-format on

// Least factor on the stiffness, at least 1, with which each of `count` strands is stable with a reserve: in every direction at
// least the fraction left[strand] (0 ≤ left < 1) of its material stiffness remains. Infinite if `most` is not enough.
void stabilising_stiffness(int count, const StaticStrands &strands, const double *left, double most, double *factors);

} // namespace ringlet
