// Where two edges are closest, for one pair or one to a lane.
#pragma once

#include "ringlet/math/pack.h"

namespace ringlet::RINGLET_SIMD {

template <class T> struct ClosestOfEdges {
    T s, t;          // how far along each, from 0 to 1
    T distance2;     // [m²]
    MaskOf<T> askew; // whether this is exact; if not, one of the four ends may be nearer to the other edge
};

// The nearest point of the two lines, s clamped, then t, then s again, is the nearest point of the segments (Ericson 2005,
// 5.1.9), except where they are parallel to rounding. An edge without length is parallel to all.
template <class T> ClosestOfEdges<T> closest_of_edges(Vec<T> a0, Vec<T> a1, Vec<T> b0, Vec<T> b1) {
    constexpr double parallel = 1e-12;   // sin² of the angle
    const auto fraction = [](T x, T y) { // 0 where y is 0
        return select(y > 0.0, min(max(x / y, T{}), constant<T>(1.0)), T{});
    };
    const Vec<T> a = a1 - a0, b = b1 - b0, between = a0 - b0, normal = cross(a, b);
    const T aa = dot(a, a), bb = dot(b, b), ab = dot(a, b), sine2 = dot(normal, normal);
    const T a_between = dot(a, between), b_between = dot(b, between);
    // By cross products: from dot products it would be lost in rounding at angles of 1e-8.
    const T first = fraction(dot(normal, cross(b, between)), sine2);
    const T t = fraction(b_between + first * ab, bb), s = fraction(t * ab - a_between, aa);
    const Vec<T> apart = between + s * a - t * b;
    return {s, t, dot(apart, apart), sine2 > parallel * aa * bb};
}

} // namespace ringlet::RINGLET_SIMD
