#include "ringlet/geometry/triangle_mesh.h"

#include "ringlet/geometry/frames.h"

#include <algorithm>
#include <cmath>

namespace ringlet {

bool is_flat(const TriangleMesh &mesh, int triangle) {
    constexpr double least = 1e-9; // of its length
    const Vec3 a = mesh.corner(triangle, 1) - mesh.corner(triangle, 0), b = mesh.corner(triangle, 2) - mesh.corner(triangle, 0);
    return !(a.cross(b).norm() > least * std::max(a.squaredNorm(), b.squaredNorm()));
}

std::vector<Vec3> vertex_normals(const TriangleMesh &mesh) {
    return vertex_normals(mesh, std::vector<unsigned char>(mesh.points.size(), 1));
}

std::vector<Vec3> vertex_normals(const TriangleMesh &mesh, View<unsigned char> wanted) {
    std::vector<Vec3> normals(mesh.points.size(), Vec3::Zero());
    for (const Triangle &t : mesh.triangles) {
        if (!(wanted[t[0]] | wanted[t[1]] | wanted[t[2]])) continue;
        const Vec3 face = (mesh.points[t[1]] - mesh.points[t[0]]).cross(mesh.points[t[2]] - mesh.points[t[0]]);
        const double twice_area = face.norm();
        if (twice_area == 0.0) continue;
        for (int k = 0; k < 3; ++k) {
            if (!wanted[t[k]]) continue;
            const Vec3 a = mesh.points[t[(k + 1) % 3]] - mesh.points[t[k]], b = mesh.points[t[(k + 2) % 3]] - mesh.points[t[k]];
            normals[t[k]] += (std::atan2(twice_area, a.dot(b)) / twice_area) * face;
        }
    }
    for (size_t v = 0; v < normals.size(); ++v)
        if (wanted[v]) normals[v].stableNormalize();
    return normals;
}

Vec3 smooth_normal(const TriangleMesh &mesh, View<Vec3> normals, int triangle, const Vec3 &barycentric) {
    const Triangle &t = mesh.triangles[triangle];
    const Vec3 normal = barycentric[0] * normals[t[0]] + barycentric[1] * normals[t[1]] + barycentric[2] * normals[t[2]];
    const Vec3 face =
        (mesh.corner(triangle, 1) - mesh.corner(triangle, 0)).cross(mesh.corner(triangle, 2) - mesh.corner(triangle, 0));
    // On a fold of half a turn the interpolated normal vanishes, and the face normal takes its place.
    return normal.squaredNorm() > 1e-6 ? normal.normalized() : face.stableNormalized();
}

Mat3 surface_frame(const TriangleMesh &mesh, View<Vec3> normals, int triangle, const Vec3 &barycentric) {
    Mat3 frame;
    frame.col(2) = smooth_normal(mesh, normals, triangle, barycentric);
    frame.col(0) = orthogonal((mesh.corner(triangle, 1) - mesh.corner(triangle, 0)).stableNormalized(), frame.col(2));
    frame.col(1) = frame.col(2).cross(frame.col(0));
    return frame;
}

} // namespace ringlet
