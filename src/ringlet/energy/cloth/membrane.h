// Membrane energy of one triangle of cloth, stretch and shear (Baraff and Witkin 1998, in the finite element form of Kim 2020):
//   W = A [ ½ kᵤ (‖Fᵤ‖ − sᵤ)² + ½ kᵥ (‖Fᵥ‖ − sᵥ)² + ½ kₛ (Fᵤ·Fᵥ − s)² ]
// Fᵤ and Fᵥ are the images of the unit vectors along warp and weft, A is the rest area [m²], and k is in N/m. The rest strains
// are sᵤ = sᵥ = 1 and s = 0. Stencil: three vertices.
#pragma once

#include "ringlet/math/types.h"

namespace ringlet {

// Rest shape of a triangle: the weights of F = Σ xᵢ wᵢ over its vertices, whose sum is zero for each direction [1/m].
struct MembraneRest {
    Vec3 warp, weft; // a weight per vertex
    double area;     // [m²]
};

// Weights of a triangle whose warp is the projection of `warp_direction` onto it. They are zero, as is the area, for a
// degenerate triangle.
MembraneRest measure_membrane(const Vec3 (&rest)[3], const Vec3 &warp_direction);

// Strains ‖Fᵤ‖, ‖Fᵥ‖ and Fᵤ·Fᵥ.
struct MembraneStrain {
    double warp, weft, shear;
};

struct MembraneShape {
    Vec3 warp, weft; // Fᵤ, Fᵥ
    MembraneStrain strain() const { return {warp.norm(), weft.norm(), warp.dot(weft)}; }
};

MembraneShape membrane_shape(const Vec3 (&positions)[3], const MembraneRest &rest);

// kᵤ, kᵥ, kₛ [N/m].
struct MembraneStiffness {
    double warp, weft, shear;
};

// Gradient of W / A [J/m²] by Fᵤ and Fᵥ, and its Hessian projected to be positive semi-definite.
struct Membrane {
    Vec3 gradient_warp, gradient_weft; // ∂/∂Fᵤ, ∂/∂Fᵥ [N/m]
    Mat3 warp_warp, warp_weft, weft_weft;
};

double membrane_energy(const MembraneShape &shape, const MembraneStrain &rest, const MembraneStiffness &stiffness);
Membrane membrane(const MembraneShape &shape, const MembraneStrain &rest, const MembraneStiffness &stiffness);

} // namespace ringlet
