#include "ringlet/geometry/triangle_tree.h"

#include <algorithm>
#include <array>
#include <numeric>

namespace ringlet {
namespace {

// Barycentric coordinates of the point of the edge (i, j) closest to p.
Vec3 on_edge(const std::array<Vec3, 3> &corners, int i, int j, const Vec3 &p) {
    const Vec3 edge = corners[j] - corners[i];
    const double length2 = edge.squaredNorm();
    const double along = length2 > 0.0 ? std::clamp((p - corners[i]).dot(edge) / length2, 0.0, 1.0) : 0.0;
    Vec3 barycentric = Vec3::Zero();
    barycentric[i] = 1.0 - along;
    barycentric[j] = along;
    return barycentric;
}

std::vector<int> all_of(const TriangleMesh &mesh) {
    std::vector<int> triangles(mesh.triangles.size());
    std::iota(triangles.begin(), triangles.end(), 0);
    return triangles;
}

} // namespace

SurfacePoint closest_point(const TriangleMesh &mesh, int triangle, const Vec3 &p) {
    const std::array<Vec3, 3> corners = {mesh.corner(triangle, 0), mesh.corner(triangle, 1), mesh.corner(triangle, 2)};
    SurfacePoint nearest{triangle};
    const auto take_nearer = [&](const Vec3 &barycentric) {
        const Vec3 position = mesh.at(triangle, barycentric);
        const double distance = (p - position).norm();
        if (distance < nearest.distance) nearest = {triangle, barycentric, position, distance};
    };
    const Vec3 a = corners[1] - corners[0], b = corners[2] - corners[0], normal = a.cross(b), q = p - corners[0];
    const double area2 = normal.squaredNorm();
    if (area2 > 0.0) { // the foot of the perpendicular, if it falls inside
        const double v = q.cross(b).dot(normal) / area2, w = a.cross(q).dot(normal) / area2;
        if (v >= 0.0 && w >= 0.0 && v + w <= 1.0) {
            take_nearer({1.0 - v - w, v, w});
            return nearest;
        }
    }
    take_nearer(on_edge(corners, 0, 1, p));
    take_nearer(on_edge(corners, 1, 2, p));
    take_nearer(on_edge(corners, 2, 0, p));
    return nearest;
}

TriangleTree::TriangleTree(const TriangleMesh &mesh, std::vector<int> triangles)
    : mesh_(mesh), triangles_(std::move(triangles)) {
    tree_.fit(static_cast<int>(triangles_.size()), [&](int i) {
        const auto [low, high] = bounds(triangles_[i]);
        return SweptBox::around(low, high);
    });
}

TriangleTree::TriangleTree(const TriangleMesh &mesh) : TriangleTree(mesh, all_of(mesh)) {}

std::array<Vec3, 2> TriangleTree::bounds(int triangle) const {
    const Vec3 &a = mesh_.corner(triangle, 0), &b = mesh_.corner(triangle, 1), &c = mesh_.corner(triangle, 2);
    return {a.cwiseMin(b).cwiseMin(c), a.cwiseMax(b).cwiseMax(c)};
}

SurfacePoint TriangleTree::closest(const Vec3 &p, double within) const {
    SurfacePoint nearest;
    tree_.for_near(p, within, [&](int i) {
        const SurfacePoint found = closest_point(mesh_, triangles_[i], p);
        if (found.distance < nearest.distance || (found.distance == nearest.distance && found.triangle < nearest.triangle))
            nearest = found;
        return std::min(within, nearest.distance);
    });
    return nearest.distance <= within ? nearest : SurfacePoint();
}

void TriangleTree::overlapping(const Vec3 &low, const Vec3 &high, std::vector<int> &found) const {
    tree_.for_overlapping(SweptBox::around(low, high), [&](int i) {
        const auto [from, to] = bounds(triangles_[i]);
        if ((from.array() <= high.array()).all() && (to.array() >= low.array()).all()) found.push_back(triangles_[i]);
    });
}

} // namespace ringlet
