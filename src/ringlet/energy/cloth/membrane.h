// Stretch and shear of one triangle of cloth, with Fᵤ and Fᵥ the images of its warp and weft directions:
//   W = A [ ½ kᵤ (‖Fᵤ‖ − sᵤ)² + ½ kᵥ (‖Fᵥ‖ − sᵥ)² + ½ kₛ (Fᵤ·Fᵥ − s)² ],  A the area at rest [m²], k in N/m.
// At rest sᵤ = sᵥ = 1 and s = 0. Stencil: three vertices. (Baraff and Witkin 1998, in the finite element form of Kim 2020.)
#pragma once

#include "ringlet/math/types.h"

namespace ringlet {

// F = Σ xᵢ wᵢ over the triangle's vertices; the weights of each direction add up to zero [1/m].
struct MembraneRest {
    Vec3 warp, weft; // a weight per vertex
    double area;     // [m²]
};

// Weights of a triangle at rest whose warp runs along the projection of `warp_direction` onto it. A triangle without area gets
// no weights and no area.
MembraneRest measure_membrane(const Vec3 (&rest)[3], const Vec3 &warp_direction);

// What the energy measures: ‖Fᵤ‖, ‖Fᵥ‖ and Fᵤ·Fᵥ.
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

// W / A [J/m²], by Fᵤ and Fᵥ: gradient and Hessian, whose negative eigenvalues are left out.
struct Membrane {
    Vec3 gradient_warp, gradient_weft; // ∂/∂Fᵤ, ∂/∂Fᵥ [N/m]
    Mat3 warp_warp, warp_weft, weft_weft;
};

double membrane_energy(const MembraneShape &shape, const MembraneStrain &rest, const MembraneStiffness &stiffness);
Membrane membrane(const MembraneShape &shape, const MembraneStrain &rest, const MembraneStiffness &stiffness);

} // namespace ringlet
