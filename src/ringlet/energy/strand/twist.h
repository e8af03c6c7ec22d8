// Twist of one edge, as a cloth hinge: E = ½ k (s Δφ)², k = c EI / l̄ [N m]. Stencil: four vertices, whose three edges span two
// virtual triangles hinged at the middle edge; φ is their dihedral angle. (Lifted Curls: Shi, Wu, Parr, Darke, Kim 2023.)
#pragma once

#include "ringlet/energy/strand/bend.h"
#include "ringlet/math/pack.h"

namespace ringlet::RINGLET_SIMD {

// φ in (−π, π] between the corners a and b at the two ends of an edge; t_next is the edge after it.
// With A = b₁×b₂ = l₁l₂ sinθ_a n_a and B = b₂×b₃: φ = atan2(‖b₂‖ b₁·B, A·B) = atan2(n_a·t₃, sinθ_b n_a·n_b).
template <class T> inline T dihedral(const Corner<T> &a, const Corner<T> &b, Vec<T> t_next) {
    return atan2(dot(a.normal, t_next), b.sine * dot(a.normal, b.normal));
}

template <class T> inline T twist_energy(T delta, T stiffness) { return 0.5 * stiffness * delta * delta; }

// ∂φ/∂x at the four vertices: g₀ = −n_a/(l₁ sinθ_a), g₃ = n_b/(l₃ sinθ_b), g₁ = −(1+p) g₀ + q g₃, g₂ = p g₀ − (1+q) g₃,
// p = (l₁/l₂) cosθ_a, q = (l₃/l₂) cosθ_b. The energy's Hessian is taken as k ∇φ∇φᵀ (Gauss–Newton, positive semi-definite).
template <class T> struct DihedralGradient {
    Vec<T> at[4];
};

template <class T>
inline DihedralGradient<T> dihedral_gradient(const Corner<T> &a, const Corner<T> &b, T length1, T length2, T length3) {
    const T least = constant<T>(1e-9); // straighter than this the twist is switched off (its fade is zero)
    const Vec<T> g0 = (-1.0 / (length1 * max(a.sine, least))) * a.normal;
    const Vec<T> g3 = (1.0 / (length3 * max(b.sine, least))) * b.normal;
    const T p = length1 / length2 * a.cosine, q = length3 / length2 * b.cosine;
    return {{g0, q * g3 - (1.0 + p) * g0, p * g0 - (1.0 + q) * g3, g3}};
}

} // namespace ringlet::RINGLET_SIMD
