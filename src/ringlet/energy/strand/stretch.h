// Stretching energy of one edge: E = ½ k (‖e‖ − l̄)², k = EA / l̄ [N/m]. Stencil: two vertices.
#pragma once

#include "ringlet/math/pack.h"

namespace ringlet::RINGLET_SIMD {

// Derivatives by the edge vector, with the unit tangent t:
//   ∂E/∂e = k (l − l̄) t,  H = k t tᵀ + k (1 − l̄/l)(I − t tᵀ)
// The second term is negative in compression and clamped to 0.
template <class T> struct Stretch {
    Vec<T> gradient; // ∂E/∂e [N]
    T along, across; // H = along t tᵀ + across (I − t tᵀ), both ≥ 0 [N/m]
};

template <class T> inline T stretch_energy(T length, T rest_length, T stiffness) {
    const T w = length - rest_length;
    return 0.5 * stiffness * w * w;
}

// The factor of I − t tᵀ, clamped [N/m].
template <class T> inline T stretch_across(T length, T rest_length, T stiffness) {
    return max(stiffness * ((length - rest_length) / length), T{});
}

template <class T> inline Stretch<T> stretch(Vec<T> tangent, T length, T rest_length, T stiffness) {
    const T w = length - rest_length;
    return {(stiffness * w) * tangent, stiffness, stretch_across(length, rest_length, stiffness)};
}

} // namespace ringlet::RINGLET_SIMD
