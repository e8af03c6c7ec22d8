// Pairs of edges, or of a point and a triangle, that are hard to measure.
#pragma once

#include "ringlet/geometry/distance.h"

#include <random>

namespace ringlet {

using Four = std::array<Vec3, 4>;

inline Vec3 anywhere(std::mt19937 &random, double size = 1.0) {
    std::uniform_real_distribution<double> in(-size, size);
    return Vec3(in(random), in(random), in(random));
}

// Four points of a degenerate kind: without length or area, parallel, coplanar, collinear, touching; the last kind is general.
inline Four hard(std::mt19937 &random, int kind) {
    const Vec3 a = anywhere(random), d = anywhere(random), e = anywhere(random);
    std::uniform_real_distribution<double> in(-1.5, 1.5);
    switch (kind) {
    case 0: return {a, a, d, e};                                                        // an edge without length
    case 1: return {a, a, d, d};                                                        // two of them
    case 2: return {a, a + d, e, e + in(random) * d};                                   // parallel
    case 3: return {a, a + d, e, e + in(random) * d + 1e-9 * anywhere(random)};         // nearly
    case 4: return {a, a + d, e, e + in(random) * d + 1e-7 * anywhere(random)};         // less nearly
    case 5: return {a, a + d, a + in(random) * d, a + in(random) * d};                  // in one line
    case 6: return {a, a + d, a + in(random) * d + in(random) * e, a + in(random) * e}; // in one plane
    case 7: return {a + 0.3 * d, e, a, a + d};                                          // touching
    case 8: return {a, d, e, e};                                                        // a triangle without area
    case 9: return {a, d, d, d};                                                        // a triangle that is a point
    case 10: return {a, d, e, 0.5 * (d + e) + 1e-10 * anywhere(random)};                // a needle
    default: return {a, d, e, anywhere(random)};
    }
}
inline constexpr int kinds = 12;

inline double distance(bool edges, const Four &x) {
    return std::sqrt((edges ? closest_edge_edge : closest_point_triangle)(x[0], x[1], x[2], x[3]).distance2);
}

} // namespace ringlet
