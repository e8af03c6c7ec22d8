#include "ringlet/scene/prescribed_motion.h"

#include "ringlet/scene/settings.h"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace ringlet {
namespace {

// The affine motion of a triangle with its unit normal, which is rigid where the triangle moves rigidly.
Vec3 carry_with_triangle(const Vec3 from[3], const Vec3 to[3], const Vec3 &point) {
    const auto frame = [](const Vec3 t[3]) {
        Mat3 axes;
        axes << t[1] - t[0], t[2] - t[0], (t[1] - t[0]).cross(t[2] - t[0]).normalized();
        return axes;
    };
    const Mat3 before = frame(from);
    Vec3 translated = point + to[0] - from[0];
    if (std::abs(before.determinant()) < 1e-30) return translated;
    const Vec3 moved = to[0] + frame(to) * before.inverse() * (point - from[0]);
    return moved.allFinite() ? moved : translated;
}

} // namespace

Vec3 PrescribedMotion::carry(int vertex, const Vec3 &point) const {
    const Triangle &t = vertices.carriers[vertex];
    if (t[0] == t[1]) return point + target[vertex] - led[vertex];
    const Vec3 from[3] = {led[t[0]], led[t[1]], led[t[2]]}, to[3] = {target[t[0]], target[t[1]], target[t[2]]};
    return carry_with_triangle(from, to, point);
}

bool PrescribedMotion::follow(int begin, int end, int leader) const {
    for (int v = begin; v < end; ++v)
        if (!vertices.mesh.moves[v] && !((carry(leader, led[v]) - target[v]).squaredNorm() < scene_settings::same_place2))
            return false;
    return true;
}

std::vector<int> PrescribedMotion::rigid_bodies() const {
    const std::vector<int> &bodies = vertices.bodies;
    std::vector<int> leaders(bodies.size() - 1, -1);
    for (int b = 0; b < int(leaders.size()); ++b)
        if (bodies[b] < bodies[b + 1] && follow(bodies[b], bodies[b + 1], bodies[b])) leaders[b] = bodies[b];
    return leaders;
}

bool PrescribedMotion::moves_affinely(int body) const {
    const int first = vertices.bodies[body], end = vertices.bodies[body + 1];
    Vec3 middle = Vec3::Zero(), moved = Vec3::Zero();
    for (int v = first; v < end; ++v) middle += led[v] / (end - first), moved += target[v] / (end - first);
    Mat3 spread = Mat3::Zero(), moments = Mat3::Zero();
    double extent = 0.0;
    for (int v = first; v < end; ++v) {
        const Vec3 at = led[v] - middle;
        spread += at * at.transpose();
        moments += (target[v] - moved) * at.transpose();
        extent = std::max(extent, at.norm());
    }
    // Least squares; a body without thickness says nothing of the motion across it.
    const Eigen::SelfAdjointEigenSolver<Mat3> principal(spread);
    Mat3 linear = Mat3::Zero();
    for (int k = 0; k < 3; ++k)
        if (const double extent2 = principal.eigenvalues()[k]; extent2 > scene_settings::thin2 * principal.eigenvalues()[2])
            linear += moments * principal.eigenvectors().col(k) * principal.eigenvectors().col(k).transpose() / extent2;
    for (int v = first; v < end; ++v) {
        const Vec3 to = moved + linear * (led[v] - middle);
        if (!((to - target[v]).norm() <= scene_settings::affine * extent)) return false;
    }
    return true;
}

} // namespace ringlet
