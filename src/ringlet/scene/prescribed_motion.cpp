#include "ringlet/scene/prescribed_motion.h"

#include "ringlet/scene/settings.h"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>

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

// The vertices of each body, and the pins of each cloth.
std::vector<std::vector<int>> prescribed_groups(const SceneVertices &vertices) {
    std::vector<std::vector<int>> groups;
    for (const std::vector<int> &begins : {vertices.bodies, vertices.cloths})
        for (size_t k = 0; k + 1 < begins.size(); ++k) {
            groups.emplace_back();
            for (int v = begins[k]; v < begins[k + 1]; ++v)
                if (!vertices.mesh.moves[v]) groups.back().push_back(v);
        }
    std::erase_if(groups, [](const std::vector<int> &group) { return group.empty(); });
    return groups;
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

// The farthest vertex from the patches of its group begins the next, while they keep vertices enough to determine a rotation.
SpaceMap::SpaceMap(const PrescribedMotion &motion) {
    struct Place {
        int vertex, group, patch;
        double distance2;
    };
    const std::vector<std::vector<int>> groups = prescribed_groups(motion.vertices);
    std::vector<Place> places;
    for (size_t g = 0; g < groups.size(); ++g)
        for (const int v : groups[g]) places.push_back({v, int(g), -1, std::numeric_limits<double>::infinity()});
    std::vector<size_t> begun(groups.size(), 0);
    const auto nearer = [](const Place &a, const Place &b) { return a.distance2 < b.distance2; };
    while (!places.empty() && patches_.size() < size_t(scene_settings::max_patches)) {
        const Place seed = *std::max_element(places.begin(), places.end(), nearer);
        if (seed.distance2 == 0.0) break;
        const size_t size = groups[seed.group].size();
        const bool enough = ++begun[seed.group] * scene_settings::vertices_of_patch >= size;
        for (Place &place : places) {
            if (place.group != seed.group) continue;
            const double away2 = (motion.start[place.vertex] - motion.start[seed.vertex]).squaredNorm();
            if (away2 < place.distance2) place.distance2 = away2, place.patch = int(patches_.size());
            if (enough) place.distance2 = 0.0;
        }
        patches_.emplace_back();
    }
    for (const Place &place : places)
        if (place.patch >= 0) patches_[place.patch].vertices.push_back(place.vertex);
    std::erase_if(patches_, [](const Patch &patch) { return patch.vertices.empty(); });
    for (Patch &patch : patches_) patch.motion = fit_rigid_motion(patch.vertices, motion.start, motion.target);
}

Vec3 SpaceMap::operator()(const Vec3 &point) const {
    Vec3 sum = Vec3::Zero();
    double weights = 0.0;
    for (const Patch &patch : patches_) {
        const double away2 = (point - patch.motion.from).squaredNorm() + 1e-12, weight = 1.0 / (away2 * away2 * away2);
        sum += weight * (patch.motion(point) - point);
        weights += weight;
    }
    return weights > 0.0 ? Vec3(point + sum / weights) : point;
}

} // namespace ringlet
