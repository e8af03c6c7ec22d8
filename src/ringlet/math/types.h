// Fixed-size types used everywhere in the core. SI units: m, kg, s, N, Pa.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>

namespace ringlet {

using Vec3 = Eigen::Vector3d;
using Vec3f = Eigen::Vector3f;
using Mat3 = Eigen::Matrix3d;
using Triangle = Eigen::Vector3i; // three vertex indices, counter-clockwise seen from outside

// A packed array of vectors and a packed array of doubles are the same memory; the bindings rely on it.
static_assert(sizeof(Vec3) == 3 * sizeof(double) && sizeof(Vec3f) == 3 * sizeof(float) && sizeof(Triangle) == 3 * sizeof(int));

template <class T> using View = std::span<const T>; // borrowed, read-only

} // namespace ringlet
