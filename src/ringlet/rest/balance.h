// What strands with a material frame must hold inside to be still under loads, and the shape of what they then remember.
//
// The energy depends on the edges' vectors and on how directors turn about them; where a strand is still, its derivative by an
// edge is the load of all that is beyond, and its derivative by a director is what turns that. From the tip to the root these
// are as many equations for each edge as there are forces: one that stretches it, two that bend the corner at its beginning,
// one that twists the edge before. Exact, whatever the shape and the stiffness.
#pragma once

#include "ringlet/math/simd.h"

namespace ringlet {

// Lengths, bends and twists of one strand, or the forces and moments that belong to them, a row per vertex: length and twist of
// the edge that begins there, the bend of the corner along the director of the edge behind it and across.
template <class T> struct JointRows {
    T *length, *bend, *twist; // n, 2 n and n
};

// clang-format off
RINGLET_DECLARE(
    // Of a strand of n vertices of which the first `held`, at least three, are held. What happens between those is zero.
    // points, directors, loads: n vectors each; loads [N] pull at the vertices, `twisting` [N m] at the directors of the edges
    void balance(int n, int held, const double *points, const double *directors, const double *loads, const double *twisting, JointRows<double> forces);
    // The points and directors of a strand of such joints, which begins where `points` and `directors` do: along the same edge,
    // with the same director. Rows without a director are zero.
    void shape_of(int n, JointRows<const double> joints, const double *points, const double *directors, double *made_points, double *made_directors);
)
// clang-format on

} // namespace ringlet
