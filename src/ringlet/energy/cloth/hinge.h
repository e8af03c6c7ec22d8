// Bending energy of cloth at one interior edge (discrete shells: Grinspun, Hirani, Desbrun, Schröder 2003):
//   E = ½ k wrap(φ − φ̄)²,  k = D l̄²/A [N m]
// D is the bending stiffness of the sheet [N m], l̄ the rest length of the edge and A the rest area of its two triangles. The
// factor 3 of the paper is in D, so that a sheet of curvature κ has the energy ½ D κ² per area. φ is 0 for a flat sheet.
// Stencil: four vertices, ordered apex, edge, edge, apex as for the twist of a strand.
#pragma once

#include "ringlet/math/types.h"

namespace ringlet {

struct Hinge {
    double angle;     // φ in (−π, π]
    Vec3 gradient[4]; // ∂φ/∂x [1/m]; the energy's Hessian is taken as k ∇φ∇φᵀ (Gauss–Newton, positive semi-definite)
};

// Positions: the apex of one triangle, the two ends of the edge, the apex of the other. Heights over the edge are at least a
// thousandth of its length, and its length at least a thousandth of its neighbours', so that the gradient is bounded.
double hinge_angle(const Vec3 (&positions)[4]);
Hinge hinge(const Vec3 (&positions)[4]);

// φ − φ̄ in (−π, π].
double hinge_strain(double angle, double rest_angle);

// k from the rest positions; 0 if the triangles have no area.
double hinge_stiffness(const Vec3 (&rest)[4], double bend);

} // namespace ringlet
