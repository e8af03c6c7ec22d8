// A borrowed triangle mesh: normals, and places on it that move with it.
#pragma once

#include "ringlet/math/types.h"

#include <Eigen/Geometry>

#include <vector>

namespace ringlet {

struct TriangleMesh {
    View<Vec3> points;
    View<Triangle> triangles; // counter-clockwise seen from outside

    const Vec3 &corner(int triangle, int k) const { return points[triangles[triangle][k]]; }
    Vec3 at(int triangle, const Vec3 &barycentric) const {
        return barycentric[0] * corner(triangle, 0) + barycentric[1] * corner(triangle, 1) +
               barycentric[2] * corner(triangle, 2);
    }
};

// Whether a triangle is thinner than a billionth of its length, or not finite.
bool is_flat(const TriangleMesh &mesh, int triangle);

// Unit vertex normals weighted by angle (Thürmer and Wüthrich 1998): they do not depend on how a face is cut into triangles.
std::vector<Vec3> vertex_normals(const TriangleMesh &mesh);

// The unit normal interpolated from vertex normals, smooth from triangle to triangle.
Vec3 smooth_normal(const TriangleMesh &mesh, View<Vec3> normals, int triangle, const Vec3 &barycentric);

// Columns: tangent, bitangent, normal. The normal is smooth; the tangent is the triangle's first edge, so that the frame is
// tied to the material: R = now · restᵀ carries whatever grows there.
Mat3 surface_frame(const TriangleMesh &mesh, View<Vec3> normals, int triangle, const Vec3 &barycentric);

} // namespace ringlet
