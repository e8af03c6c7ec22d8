// Dihedral angle φ about the middle one of three consecutive edges b₁, b₂, b₃: from the plane of b₁, b₂ to that of b₂, b₃.
// With A = b₁×b₂ and B = b₂×b₃: φ = atan2(‖b₂‖ b₁·B, A·B). The twist of a strand and the hinge of cloth both use it.
#pragma once

#include "ringlet/math/pack.h"

namespace ringlet::RINGLET_SIMD {

// φ in (−π, π] from the unit normals n_a of b₁, b₂ and n_b of b₂, b₃. `height` is the distance of the end of b₃ from the line
// of b₂, in the unit of b₃; any unit will do.
template <class T> inline T dihedral_angle(Vec<T> n_a, Vec<T> n_b, Vec<T> b3, T height) {
    return atan2(dot(n_a, b3), height * dot(n_a, n_b));
}

// ∂φ/∂x at the four vertices.
template <class T> struct DihedralGradient {
    Vec<T> at[4];
};

// g₀ = −n_a/h_a, g₃ = n_b/h_b, g₁ = −(1+p) g₀ + q g₃, g₂ = p g₀ − (1+q) g₃, where h_a and h_b are the distances of the first
// and the last vertex from the line of b₂, p = b₁·b₂/‖b₂‖² and q = b₃·b₂/‖b₂‖².
template <class T> inline DihedralGradient<T> dihedral_gradient(Vec<T> n_a, Vec<T> n_b, T height_a, T height_b, T p, T q) {
    const Vec<T> g0 = (-1.0 / height_a) * n_a;
    const Vec<T> g3 = (1.0 / height_b) * n_b;
    return {{g0, q * g3 - (1.0 + p) * g0, p * g0 - (1.0 + q) * g3, g3}};
}

} // namespace ringlet::RINGLET_SIMD
