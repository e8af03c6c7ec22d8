// Bend and twist of a strand with a material frame, a director D ⟂ t on every edge. With K = θ n the turning at a corner,
//   bend  ½ k_b [ (K·D − θ̄)² + (K·(t×D))² ]   D of the edge behind the corner; stencil: three vertices and that director
//   twist ½ k_t wrap(τ − φ̄)²                  τ: angle about an edge from its D to the next, carried back; stencil: three
//                                             vertices and two directors
// Hessians are sums of squares of the residuals' gradients (Gauss–Newton). After Bergou et al. 2008, 2010.
#pragma once

#include "ringlet/energy/strand/bend.h"
#include "ringlet/math/pack.h"

namespace ringlet::RINGLET_SIMD {

// θ / sinθ, 1 where straight.
template <class T> inline T angle_by_sine(const Corner<T> &c) {
    const auto straight = c.sine < 1e-8;
    return select(straight, constant<T>(1.0), c.angle / select(straight, constant<T>(1.0), c.sine));
}

// K = θ n, smooth through straight.
template <class T> inline Vec<T> turning(const Corner<T> &c, Vec<T> t0, Vec<T> t1) { return angle_by_sine(c) * cross(t0, t1); }

// By the two edge vectors.
template <class T> struct EdgeGradient {
    Vec<T> first, second;
};

// ∂(K·W)/∂e for a unit W ⟂ t₁ that is carried along with t₁.
template <class T>
inline EdgeGradient<T> turning_gradient(const Corner<T> &c, Vec<T> t0, Vec<T> t1, T length0, T length1, Vec<T> W) {
    const T r = angle_by_sine(c);
    const T W_m = dot(W, cross(c.normal, t1));
    const Vec<T> first = cross(t0, transport(W, t1, t0)) + ((r - 1.0) * W_m) * c.normal;
    const Vec<T> second = ((1.0 - r * c.cosine) * W_m) * c.normal - cross(t1, W);
    return {(1.0 / length0) * first, (1.0 / length1) * second};
}

// τ in (−π, π] from the director of the edge t to that of the edge t_next.
template <class T> inline T frame_twist(Vec<T> director, Vec<T> t, Vec<T> next_director, Vec<T> t_next) {
    const Vec<T> next = transport(next_director, t_next, t);
    return atan2(dot(cross(t, director), next), dot(director, next));
}

// ∂τ/∂e for directors carried along with their edges: half the curvature binormal 2 t×t'/(1 + t·t'), by each length.
template <class T>
inline EdgeGradient<T> frame_twist_gradient(const Corner<T> &c, Vec<T> t, Vec<T> t_next, T length, T length_next) {
    const Vec<T> binormal = (1.0 / max(1.0 + c.cosine, constant<T>(1e-9))) * cross(t, t_next);
    return {(1.0 / length) * binormal, (1.0 / length_next) * binormal};
}

// How a director turns about its edge when the edge moves, if it is always carried straight from where the edge was before:
// ∂γ/∂e.
template <class T> inline Vec<T> spin(Vec<T> before, Vec<T> t, T length) {
    const T cosine = max(dot(before, t), constant<T>(-1.0 + 1e-9));
    return (-1.0 / ((1.0 + cosine) * length)) * cross(before, t);
}

} // namespace ringlet::RINGLET_SIMD
