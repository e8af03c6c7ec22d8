#include "ringlet/energy/cloth/hinge.h"

#include "ringlet/energy/common/dihedral.h"

#include <Eigen/Geometry>
#include <algorithm>

namespace ringlet {
namespace {

using Vector = baseline::Vec<double>;

Vector plain(const Vec3 &v) { return {v.x(), v.y(), v.z()}; }
Vec3 eigen(const Vector &v) { return {v.x, v.y, v.z}; }

// Geometry of two triangles about their common edge. The normal of the second is reversed, so that both point to the same side
// of a flat sheet.
struct Fold {
    Vec3 edge, b1, b3;
    double length, height_a, height_b;
    Vector normal_a, normal_b;

    explicit Fold(const Vec3 (&x)[4]) : edge(x[2] - x[1]), b1(x[1] - x[0]), b3(x[3] - x[2]), length(edge.norm()) {
        const double least = 1e-30;
        const Vec3 a = b1.cross(edge), b = b3.cross(edge);
        const double twice_a = a.norm(), twice_b = b.norm();
        normal_a = plain(a / std::max(twice_a, least));
        normal_b = plain(b / std::max(twice_b, least));
        length = std::max({length, 1e-3 * b1.norm(), 1e-3 * b3.norm(), least});
        height_a = std::max(twice_a / length, 1e-3 * length);
        height_b = std::max(twice_b / length, 1e-3 * length);
    }

    double angle() const { return baseline::dihedral_angle(normal_a, normal_b, -plain(b3), height_b); }
};

} // namespace

double hinge_angle(const Vec3 (&positions)[4]) { return Fold(positions).angle(); }

Hinge hinge(const Vec3 (&positions)[4]) {
    const Fold fold(positions);
    const double p = fold.b1.dot(fold.edge) / (fold.length * fold.length);
    const double q = fold.b3.dot(fold.edge) / (fold.length * fold.length);
    const auto gradient = baseline::dihedral_gradient(fold.normal_a, -fold.normal_b, fold.height_a, fold.height_b, p, q);
    Hinge result{fold.angle(), {}};
    for (int k = 0; k < 4; ++k) result.gradient[k] = eigen(gradient.at[k]);
    return result;
}

double hinge_strain(double angle, double rest_angle) { return baseline::wrap(angle - rest_angle); }

double hinge_stiffness(const Vec3 (&rest)[4], double bend) {
    const Vec3 edge = rest[2] - rest[1];
    const double area = 0.5 * ((rest[1] - rest[0]).cross(edge).norm() + (rest[3] - rest[2]).cross(edge).norm());
    return area > 0 ? bend * edge.squaredNorm() / area : 0.0;
}

} // namespace ringlet
