#include "ringlet/geometry/frames.h"

#include <cmath>
#include <numbers>

namespace ringlet {
namespace {

// The unit vector along v, or zero. The fast branch serves lengths that neither overflow nor underflow.
Vec3 unit(const Vec3 &v) {
    const double length2 = v.squaredNorm();
    return length2 > 1e-200 && length2 < 1e200 ? Vec3(v / std::sqrt(length2)) : Vec3(v.stableNormalized());
}

// Factor 2 / ‖normal‖² of the reflection v − 2 (n·v / ‖n‖²) n; 0 for a normal without length.
double reflection_factor(const Vec3 &normal) {
    const double length2 = normal.squaredNorm();
    return length2 > 1e-30 ? 2.0 / length2 : 0.0;
}

} // namespace

// The unit quaternion at half of the angle between the directions.
Vec3 transport(const Vec3 &v, const Vec3 &a, const Vec3 &b) {
    constexpr double opposite = 1e-12;
    const Vec3 from = a.normalized(), to = b.normalized();
    const double cosine = to.dot(from);
    if (cosine < opposite - 1.0) return Eigen::Quaterniond(Eigen::AngleAxisd(std::numbers::pi, from.unitOrthogonal())) * v;
    const double scale = std::sqrt((1.0 + cosine) * 2.0);
    Eigen::Quaterniond rotation;
    rotation.vec() = from.cross(to) * (1.0 / scale);
    rotation.w() = scale * 0.5;
    return rotation * v;
}

Vec3 any_orthogonal(const Vec3 &tangent) {
    int smallest = 0;
    tangent.cwiseAbs().minCoeff(&smallest);
    return tangent.cross(Vec3::Unit(smallest)).normalized();
}

void tangents(View<Vec3> points, std::span<Vec3> result) {
    const size_t n = points.size();
    Vec3 before = Vec3::Zero();
    for (size_t i = 0; i < n; ++i) {
        Vec3 after = Vec3::Zero();
        if (i + 1 < n) after = unit(points[i + 1] - points[i]);
        const Vec3 sum = before + after;
        // Where the curve reverses or two points coincide, the last valid tangent is kept.
        if (sum.squaredNorm() > 1e-20)
            result[i] = sum.normalized();
        else
            result[i] = i > 0 ? result[i - 1] : Vec3::UnitY();
        if (after.squaredNorm() > 0.5) before = after;
    }
}

void transport(View<Vec3> points, View<Vec3> tangents, const Vec3 &axis, std::span<Vec3> result) {
    if (points.empty()) return;
    result[0] = orthogonal(axis, tangents[0]);
    for (size_t i = 0; i + 1 < points.size(); ++i) {
        const Vec3 edge = points[i + 1] - points[i];
        const double by = reflection_factor(edge);
        const Vec3 tangent = tangents[i] - by * edge.dot(tangents[i]) * edge,
                   moved = result[i] - by * edge.dot(result[i]) * edge;
        const Vec3 turn = tangents[i + 1] - tangent;
        result[i + 1] = orthogonal(moved - reflection_factor(turn) * turn.dot(moved) * turn, tangents[i + 1]);
    }
}

} // namespace ringlet
