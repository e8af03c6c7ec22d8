// Closest points of two edges, for one pair or for one pair per lane.
#pragma once

#include "ringlet/math/pack.h"

namespace ringlet::RINGLET_SIMD {

template <class T> struct ClosestOfEdges {
    T s, t;          // fractions along the two edges, 0…1
    T distance2;     // squared distance [m²]
    MaskOf<T> askew; // whether the result is exact; for parallel edges one of the four ends may be nearer
};

// Closest points of the two lines, with s clamped, then t, then s again (Ericson 2005, 5.1.9). This is exact except where the
// edges are parallel to rounding. An edge without length is parallel to every edge.
template <class T> ClosestOfEdges<T> closest_of_edges(Vec<T> a0, Vec<T> a1, Vec<T> b0, Vec<T> b1) {
    constexpr double parallel = 1e-12;   // sin² of the angle
    const auto fraction = [](T x, T y) { // 0 where y is 0
        return select(y > 0.0, min(max(x / y, T{}), constant<T>(1.0)), T{});
    };
    const Vec<T> a = a1 - a0, b = b1 - b0, between = a0 - b0, normal = cross(a, b);
    const T aa = dot(a, a), bb = dot(b, b), ab = dot(a, b), sine2 = dot(normal, normal);
    const T a_between = dot(a, between), b_between = dot(b, between);
    // Cross products, since dot products lose all digits to rounding at angles of 1e-8.
    const T first = fraction(dot(normal, cross(b, between)), sine2);
    const T t = fraction(b_between + first * ab, bb), s = fraction(t * ab - a_between, aa);
    const Vec<T> shortest = between + s * a - t * b;
    return {s, t, dot(shortest, shortest), sine2 > parallel * aa * bb};
}

} // namespace ringlet::RINGLET_SIMD
