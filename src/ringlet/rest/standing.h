// Whether strands that are still stand: whether all of the second derivative of their energy is positive, and if not, how much
// stiffer against bend and twist they would have to be.
//
// Of ½ k r², a term of bend or of twist, that derivative is k ∇r ∇rᵀ + k r ∇²r. What a strand must hold where it is still, k r,
// follows from its loads and its shape, however stiff it is. So as a strand is made s times stiffer, and remembers what it must
// to be still where it was, only the first part grows: the whole is s A + B, with A ≥ 0.
#pragma once

#include "ringlet/math/simd.h"

#include <cstddef>

namespace ringlet {

// Packed like Curves, one row per vertex; an edge's values stand in the row of the vertex where it begins.
struct StillStrands {
    const int *offsets;
    const unsigned char *held;
    const double *positions, *directors;
    const double *rest_length, *rest_angle, *rest_dihedral;
    const double *stretch_stiffness, *bend_stiffness, *twist_stiffness;
};

// clang-format off
RINGLET_DECLARE(
    size_t standing_room(int vertices); // doubles that the next one works in
    double stiffness_to_stand(const StillStrands &strands, int strand, double left, double most, double *room);
)
// clang-format on

// Of each of `count` strands, how many times stiffer it must be, at least 1, to stand and to resist in every direction what
// bends and twists it with the part left[strand] (from 0 below 1) of what it does without load. Infinite where `most` times are
// not enough.
void stiffness_to_stand(int count, const StillStrands &strands, const double *left, double most, double *factors);

} // namespace ringlet
