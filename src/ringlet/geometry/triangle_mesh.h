// Triangle mesh (borrowed arrays) with vertex normals and surface frames.
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

// Angle-weighted unit vertex normals (Thürmer and Wüthrich 1998); they are independent of the triangulation of a face.
std::vector<Vec3> vertex_normals(const TriangleMesh &mesh);
std::vector<Vec3> vertex_normals(const TriangleMesh &mesh, View<unsigned char> wanted); // 0 where that is 0, per vertex

// Unit normal interpolated from vertex normals, continuous from triangle to triangle.
Vec3 smooth_normal(const TriangleMesh &mesh, View<Vec3> normals, int triangle, const Vec3 &barycentric);

// Surface frame with columns tangent, bitangent, normal. The normal is smooth; the tangent is the first edge of the triangle,
// so that the frame moves with the material. R = now · restᵀ rotates what grows there from rest to now.
Mat3 surface_frame(const TriangleMesh &mesh, View<Vec3> normals, int triangle, const Vec3 &barycentric);

} // namespace ringlet
