// Bending energy at one vertex: E = ½ k (σθ − θ̄)², k = EI / l_v [N m]. Stencil: three vertices (two edges).
// θ is the turning angle (0 = straight), σ = ±1 its sign (see strand/hinge/continuation.h).
// The eigenvalues of the Hessian in edge space are those of Wu & Kim 2023. Each edge is measured in units of its own length, so
// that they hold for unequal edges too.
#pragma once

#include "ringlet/math/pack.h"

namespace ringlet::RINGLET_SIMD {

// Turning angle and normal at the vertex of two consecutive edges.
template <class T> struct Corner {
    T sine, cosine, angle; // sin θ, cos θ and θ in [0, π]
    Vec<T> normal;         // unit normal of the plane of the two edges; any perpendicular where they are parallel
};

template <class T> inline Corner<T> corner(Vec<T> t0, Vec<T> t1) {
    const Vec<T> product = cross(t0, t1);
    const T sine = norm(product), cosine = dot(t0, t1);
    const auto parallel = sine < 1e-12;
    Vec<T> normal = (1.0 / select(parallel, constant<T>(1.0), sine)) * product;
    if (any(parallel)) normal = select<T>(parallel, perpendicular(t0), normal);
    return {sine, cosine, atan2(sine, cosine), normal};
}

template <class T> inline T bend_energy(T angle, T sigma, T rest_angle, T stiffness) {
    const T w = sigma * angle - rest_angle;
    return 0.5 * stiffness * w * w;
}

// One term c u uᵀ of a Hessian in edge space, u = (first, second).
template <class T> struct EdgeTerm {
    T coefficient; // ≥ 0
    Vec<T> first, second;
};

template <class T> struct Bend {
    Vec<T> gradient0, gradient1; // by the two edge vectors [N]
    EdgeTerm<T> terms[4];        // Hessian, projected to be positive semi-definite, as a sum of four squares
};

// Gradient and projected Hessian, with w = θ − σθ̄ (equal to σθ − θ̄ up to the sign σ) and m = n × t, in units of the lengths
// of the edges. The Hessian has six eigenvalues:
//   in the plane, p = (t₀+t₁)/√2 and d = (m₀−m₁)/√2 couple    k (1 ± √(1+w²))
//   in the plane, q = (t₀−t₁)/√2 and s = (m₀+m₁)/√2 couple    ±k |w|
//   out of the plane, along n₀ + n₁ and along n₀ − n₁         −k w tan(θ/2) and k w cot(θ/2)
// Negative eigenvalues are clamped to 0.
template <class T>
inline Bend<T> bend(const Corner<T> &c, Vec<T> t0, Vec<T> t1, T length0, T length1, T sigma, T rest_angle, T stiffness) {
    const double stiffest = 1e3; // bounds cot(θ/2) of a nearly straight pair whose turning angle has the wrong sign
    const T w = c.angle - sigma * rest_angle;
    const T inverse0 = 1.0 / length0, inverse1 = 1.0 / length1;
    const Vec<T> m0 = cross(c.normal, t0), m1 = cross(c.normal, t1);

    Bend<T> result;
    result.gradient0 = (-stiffness * w * inverse0) * m0;
    result.gradient1 = (stiffness * w * inverse1) * m1;

    const T lambda = 1.0 + sqrt(1.0 + w * w);
    result.terms[0] = {0.5 * stiffness * lambda / (w * w + lambda * lambda), inverse0 * (w * t0 + lambda * m0),
                       inverse1 * (w * t1 - lambda * m1)};
    const T s = sign(w);
    result.terms[1] = {0.25 * stiffness * abs(w), inverse0 * (t0 + s * m0), inverse1 * (s * m1 - t1)};

    const T one_plus_cosine = max(1.0 + c.cosine, constant<T>(1e-12));
    const T with_sign = max(-w * c.sine / one_plus_cosine, T{});
    const T small = constant<T>(1e-9);
    const T cotangent = w * one_plus_cosine / max(c.sine, small);
    const T against = select(c.sine < small, select(rest_angle < small, constant<T>(2.0), T{}), max(cotangent, T{}));
    result.terms[2] = {0.5 * stiffness * with_sign, inverse0 * c.normal, inverse1 * c.normal};
    result.terms[3] = {0.5 * stiffness * min(against, constant<T>(stiffest)), inverse0 * c.normal, -inverse1 * c.normal};
    return result;
}

// Least magnitude of a negative eigenvalue that counts as clamped, as a fraction of the stiffness; smaller ones are rounding.
inline constexpr double clamped_from = 1e-6;

// Number of the six eigenvalues that bend() clamps: one of each pair where the corner is bent and not at its rest angle.
template <class T> inline T clamped_bend(const Corner<T> &c, T sigma, T rest_angle, T stiffness) {
    const T w = c.angle - sigma * rest_angle, one = constant<T>(1.0);
    const T one_plus_cosine = max(1.0 + c.cosine, constant<T>(1e-12));
    const auto counted = [&](T eigenvalue) { return select(eigenvalue < -clamped_from, one, T{}); };
    const T count = counted(one - sqrt(1.0 + w * w)) + counted(-abs(w)) + counted(-w * c.sine / one_plus_cosine) +
                    counted(w * one_plus_cosine / max(c.sine, constant<T>(1e-9)));
    return select(stiffness > 0.0, count, T{});
}

} // namespace ringlet::RINGLET_SIMD
