// Bend of cloth at one interior edge: E = ½ k wrap(φ − φ̄)², k = D l̄²/A [N m], with D the bending stiffness of the sheet [N m],
// l̄ the edge's length and A the area of its two triangles at rest. (Grinspun, Hirani, Desbrun, Schröder 2003: discrete shells;
// their factor 3 is in D, so that a sheet bent to the curvature κ holds ½ D κ² per area.)
// Stencil: four vertices in a row as for the twist of a strand, apex – edge – edge – apex. φ is 0 where the sheet is flat.
#pragma once

#include "ringlet/math/types.h"

namespace ringlet {

struct Hinge {
    double angle;     // φ in (−π, π]
    Vec3 gradient[4]; // ∂φ/∂x [1/m]; the energy's Hessian is taken as k ∇φ∇φᵀ (Gauss–Newton, positive semi-definite)
};

// Positions: the apex of one triangle, the two ends of the edge, the apex of the other. A triangle whose height over the edge
// is less than a thousandth of the edge counts as that high, and an edge likewise as that long beside its neighbours, so that
// the gradient is bounded.
double hinge_angle(const Vec3 (&positions)[4]);
Hinge hinge(const Vec3 (&positions)[4]);

// φ − φ̄ in (−π, π].
double hinge_strain(double angle, double rest_angle);

// k from the positions at rest; 0 where a triangle has no area.
double hinge_stiffness(const Vec3 (&rest)[4], double bend);

} // namespace ringlet
