// Rotation-minimising frames along polylines.
#pragma once

#include "ringlet/math/types.h"

#include <Eigen/Geometry>

namespace ringlet {

// Packed polylines: curve i owns points[offsets[i]] up to points[offsets[i + 1]], root first.
struct CurveView {
    View<Vec3> points;
    View<int> offsets;

    int count() const { return static_cast<int>(offsets.size()) - 1; }
    View<Vec3> operator[](int i) const { return points.subspan(offsets[i], offsets[i + 1] - offsets[i]); }
};

// Unit tangents of one polyline: the bisector of the two edges inside, the edge at the ends.
void tangents(View<Vec3> points, std::span<Vec3> result);

// Rotation-minimising axis along one polyline by double reflection (Wang, Jüttler, Zheng and Liu, "Computation of rotation
// minimizing frames", ACM TOG 27(1), 2008). The first is `axis` made orthogonal to the first tangent. All are unit vectors
// orthogonal to their tangents.
void transport(View<Vec3> points, View<Vec3> tangents, const Vec3 &axis, std::span<Vec3> result);

// v parallel-transported from the direction of a to that of b: by the least rotation, which is about any orthogonal axis where
// they are opposite.
Vec3 transport(const Vec3 &v, const Vec3 &a, const Vec3 &b);

// Some unit vector orthogonal to a unit vector.
Vec3 any_orthogonal(const Vec3 &tangent);

// `axis` projected orthogonal to the unit vector `tangent` and normalised; any orthogonal vector if the projection is zero.
inline Vec3 orthogonal(const Vec3 &axis, const Vec3 &tangent) {
    const Vec3 rest = axis - tangent.dot(axis) * tangent;
    const double length = rest.norm();
    return length > 1e-9 ? Vec3(rest / length) : any_orthogonal(tangent);
}

} // namespace ringlet
