#include "ringlet/geometry/frames.h"

#include <cmath>

namespace ringlet {
namespace {

// Mirrors v in the plane orthogonal to `across`; leaves it where there is no such plane.
Vec3 mirror(const Vec3 &v, const Vec3 &across) {
    const double length2 = across.squaredNorm();
    return length2 > 1e-30 ? Vec3(v - (2.0 * across.dot(v) / length2) * across) : v;
}

} // namespace

Vec3 orthogonal(const Vec3 &axis, const Vec3 &tangent) {
    const Vec3 rest = axis - tangent.dot(axis) * tangent;
    const double length = rest.norm();
    if (length > 1e-9) return rest / length;
    int smallest = 0;
    tangent.cwiseAbs().minCoeff(&smallest);
    return tangent.cross(Vec3::Unit(smallest)).normalized();
}

void tangents(View<Vec3> points, std::span<Vec3> result) {
    const size_t n = points.size();
    Vec3 before = Vec3::Zero();
    for (size_t i = 0; i < n; ++i) {
        Vec3 after = Vec3::Zero();
        if (i + 1 < n) after = (points[i + 1] - points[i]).stableNormalized();
        const Vec3 sum = before + after;
        // Where the curve turns straight back, or two points coincide, the last good direction is as right as any.
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
        const Vec3 tangent = mirror(tangents[i], edge), moved = mirror(result[i], edge);
        result[i + 1] = orthogonal(mirror(moved, tangents[i + 1] - tangent), tangents[i + 1]);
    }
}

} // namespace ringlet
