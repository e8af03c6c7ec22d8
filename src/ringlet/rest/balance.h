// Internal forces and moments of strands with a material frame in static equilibrium with given loads, and the rest shape that
// follows from them (inverse statics).
//
// The energy depends on the edge vectors and on the rotations of the directors about them. In equilibrium its derivative by an
// edge vector is the sum of all loads from there to the tip. Its derivative by a director is the moment that acts on the
// director. From tip to root these are four linear equations per edge for four unknowns. One is the force that stretches the
// edge, two are moments that bend the corner at its beginning, and one is the moment that twists the edge before it. The
// solution is exact for any shape and does not depend on the stiffness.
#pragma once

#include "ringlet/math/simd.h"

namespace ringlet {

// Lengths, bends and twists of one strand, or their conjugate forces and moments, with one row per vertex. Length and twist are
// those of the edge that begins there. The two bends of the corner are along the director of that edge and across it.
template <class T> struct JointRows {
    T *length, *bend, *twist; // n, 2 n and n
};

// clang-format off
RINGLET_DECLARE(
    // Internal forces of a strand of n vertices, of which the first `held` (at least three) are prescribed; zero between these.
    // points, directors, loads: n vectors each; loads [N] act on vertices, moments `twisting` [N m] on the directors of edges
    void balance(int n, int held, const double *points, const double *directors, const double *loads, const double *twisting, JointRows<double> forces);
    // Points and directors of a strand with these lengths, bends and twists. Its first edge and director are those of `points`
    // and `directors`. Rows without a director are zero.
    void shape_of(int n, JointRows<const double> joints, const double *points, const double *directors, double *made_points, double *made_directors);
)
// clang-format on

} // namespace ringlet
