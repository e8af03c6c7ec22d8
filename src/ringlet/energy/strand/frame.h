// Bending and twisting energy of a strand with a material frame (discrete elastic rods: Bergou et al. 2008, 2010). Each edge
// has a director D ⟂ t, and K = θ n is the curvature vector at a corner.
//   bend  ½ k_b [ (K·D − θ̄)² + (K·(t×D))² ]   with D of the edge after the corner. Stencil: three vertices, that director
//   twist ½ k_t wrap(τ − φ̄)²                  with τ the angle from D to the next director. Stencil: three vertices, two
//                                             directors
// The angle τ is measured about the edge, after parallel transport of the next director to it. Hessians are sums of squares of
// the gradients of the residuals (Gauss–Newton).
#pragma once

#include "ringlet/energy/strand/bend.h"
#include "ringlet/math/pack.h"

#include <array>

namespace ringlet::RINGLET_SIMD {

// θ / sin θ; 1 for a straight corner.
template <class T> inline T angle_by_sine(const Corner<T> &c) {
    const auto straight = c.sine < 1e-8;
    return select(straight, constant<T>(1.0), c.angle / select(straight, constant<T>(1.0), c.sine));
}

// K = θ n, smooth where the corner is straight.
template <class T> inline Vec<T> turning(const Corner<T> &c, Vec<T> t0, Vec<T> t1) { return angle_by_sine(c) * cross(t0, t1); }

// Gradient by the two edge vectors.
template <class T> struct EdgeGradient {
    Vec<T> first, second;
};

// Degrees of freedom of a joint, which is two consecutive edges: its three vertices and, behind each of the first two, the
// rotation of the director of the edge that begins there.
constexpr int joint_dofs = 11;

// Gradient by them of what depends on the two edge vectors and both rotations.
template <class T> inline std::array<T, joint_dofs> joint_gradient(const EdgeGradient<T> &by_edges, T turn0, T turn1) {
    const Vec<T> first = by_edges.first, last = by_edges.second, middle = first - last;
    return {-first.x, -first.y, -first.z, turn0, middle.x, middle.y, middle.z, turn1, last.x, last.y, last.z};
}

// ∂(K·W)/∂e for a unit vector W ⟂ t₁ under parallel transport with t₁.
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

// ∂τ/∂e for directors under parallel transport with their edges: half the curvature binormal 2 t×t'/(1 + t·t'), by each length.
template <class T>
inline EdgeGradient<T> frame_twist_gradient(const Corner<T> &c, Vec<T> t, Vec<T> t_next, T length, T length_next) {
    const Vec<T> binormal = (1.0 / max(1.0 + c.cosine, constant<T>(1e-9))) * cross(t, t_next);
    return {(1.0 / length) * binormal, (1.0 / length_next) * binormal};
}

// ∂γ/∂e, the rotation of a director about its edge per motion of the edge, for parallel transport from a fixed reference
// tangent `before` instead of from the current one.
template <class T> inline Vec<T> spin(Vec<T> before, Vec<T> t, T length) {
    const T cosine = max(dot(before, t), constant<T>(-1.0 + 1e-9));
    return (-1.0 / ((1.0 + cosine) * length)) * cross(before, t);
}

} // namespace ringlet::RINGLET_SIMD
