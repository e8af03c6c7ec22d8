// One-sided plane: E = ½ k min(s, 0)² with s = n · x − d, the signed distance of a vertex from it. Stencil: one vertex.
#pragma once

#include "ringlet/math/pack.h"

namespace ringlet::RINGLET_SIMD {

template <class T> struct Plane {
    Vec<T> normal; // n, towards the free side
    T offset;      // d [m]
    T stiffness;   // k [N/m]; 0 for none
};

// s where the vertex is behind the plane, else 0 [m].
template <class T> inline T depth_behind(const Plane<T> &plane, Vec<T> x) {
    return min(dot(plane.normal, x) - plane.offset, T{});
}

template <class T> inline T plane_energy(const Plane<T> &plane, Vec<T> x) {
    const T s = depth_behind(plane, x);
    return 0.5 * plane.stiffness * s * s;
}

template <class T> inline Vec<T> plane_gradient(const Plane<T> &plane, Vec<T> x) {
    return (plane.stiffness * depth_behind(plane, x)) * plane.normal;
}

// The factor of n nᵀ in the Hessian [N/m].
template <class T> inline T plane_hessian(const Plane<T> &plane, Vec<T> x) {
    return select(depth_behind(plane, x) < 0.0, plane.stiffness, T{});
}

} // namespace ringlet::RINGLET_SIMD
