// Twisting energy of one edge as a hinge (Lifted Curls: Shi, Wu, Parr, Darke, Kim 2023): E = ½ k (s Δφ)², k = c EI / l̄ [N m].
// φ is the dihedral angle of the two virtual triangles that three consecutive edges span. Stencil: four vertices.
#pragma once

#include "ringlet/energy/common/dihedral.h"
#include "ringlet/energy/strand/bend.h"
#include "ringlet/math/pack.h"

namespace ringlet::RINGLET_SIMD {

// φ in (−π, π] from the corners a and b at the two ends of an edge; t_next is the tangent of the edge after it.
template <class T> inline T dihedral(const Corner<T> &a, const Corner<T> &b, Vec<T> t_next) {
    return dihedral_angle(a.normal, b.normal, t_next, b.sine);
}

template <class T> inline T twist_energy(T delta, T stiffness) { return 0.5 * stiffness * delta * delta; }

// ∂φ/∂x at the four vertices. The energy's Hessian is taken as k ∇φ∇φᵀ (Gauss–Newton, positive semi-definite).
template <class T>
inline DihedralGradient<T> dihedral_gradient(const Corner<T> &a, const Corner<T> &b, T length1, T length2, T length3) {
    const T least = constant<T>(1e-9); // s is 0 for straighter corners
    return dihedral_gradient(a.normal, b.normal, length1 * max(a.sine, least), length3 * max(b.sine, least),
                             length1 / length2 * a.cosine, length3 / length2 * b.cosine);
}

} // namespace ringlet::RINGLET_SIMD
