#include "ringlet/energy/cloth/membrane.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace ringlet {
namespace {

double square(double x) { return x * x; }

// v / ‖v‖; some unit vector if v is zero.
Vec3 direction(const Vec3 &v, double length) { return length > 1e-12 ? Vec3(v / length) : Vec3::UnitX(); }

// a d dᵀ + b (I − d dᵀ) for a unit d.
Mat3 along_and_across(const Vec3 &d, double a, double b) { return (a - b) * d * d.transpose() + b * Mat3::Identity(); }

// Adds the derivatives of ½ k (‖F‖ − s)². The eigenvalues are k along F and k (1 − s/‖F‖) across it; the latter is negative in
// compression and clamped to 0.
void add_stretch(const Vec3 &F, double rest, double stiffness, Vec3 &gradient, Mat3 &hessian) {
    const double length = F.norm(), w = length - rest;
    const Vec3 along = direction(F, length);
    gradient += stiffness * w * along;
    hessian += along_and_across(along, stiffness, w > 0 ? stiffness * w / length : 0.0);
}

// PSD projection of [a c; c b] with a + b ≥ 0: (Σ max(λ, 0) (M − λ' I)) / (λ − λ') over its eigenvalues λ, λ'.
struct Symmetric2 {
    double a, b, c;
};
Symmetric2 positive_part(const Symmetric2 &m) {
    const double mean = 0.5 * (m.a + m.b), spread = std::hypot(0.5 * (m.a - m.b), m.c);
    const double high = mean + spread, low = mean - spread;
    if (low >= 0) return m;
    const double scale = high / (high - low);
    return {scale * (m.a - low), scale * (m.b - low), scale * m.c};
}

// Adds the derivatives of ½ k w², w = Fᵤ·Fᵥ − s. The Hessian is k (g gᵀ + w H) with g = (Fᵥ, Fᵤ), where H exchanges the two
// vectors. H is 1 on (a, a)/√2 and −1 on (a, −a)/√2. The vector g lies in the plane of (a, a) with a along Fᵤ + Fᵥ and (a, −a)
// with a along Fᵤ − Fᵥ. So two eigenvalues belong to that plane; the other four are w twice and −w twice.
void add_shear(const MembraneShape &shape, double rest, double stiffness, Membrane &result) {
    const double w = shape.warp.dot(shape.weft) - rest;
    result.gradient_warp += stiffness * w * shape.weft;
    result.gradient_weft += stiffness * w * shape.warp;

    const Vec3 sum = shape.warp + shape.weft, difference = shape.warp - shape.weft;
    const double p = sum.norm(), m = difference.norm();
    const Vec3 with = direction(sum, p), against = direction(difference, m);
    const Symmetric2 plane = positive_part({0.5 * p * p + w, 0.5 * m * m - w, -0.5 * p * m});
    const Mat3 even = along_and_across(with, plane.a, std::max(w, 0.0));
    const Mat3 odd = along_and_across(against, plane.b, std::max(-w, 0.0));
    const Mat3 mixed = plane.c * with * against.transpose();
    result.warp_warp += 0.5 * stiffness * (even + odd + mixed + mixed.transpose());
    result.weft_weft += 0.5 * stiffness * (even + odd - mixed - mixed.transpose());
    result.warp_weft += 0.5 * stiffness * (even - odd - mixed + mixed.transpose());
}

} // namespace

MembraneRest measure_membrane(const Vec3 (&rest)[3], const Vec3 &warp_direction) {
    const Vec3 e1 = rest[1] - rest[0], e2 = rest[2] - rest[0];
    const Vec3 twice = e1.cross(e2);
    const double twice_area = twice.norm();
    if (!(twice_area > 1e-12 * std::max(e1.squaredNorm(), e2.squaredNorm()))) return {Vec3::Zero(), Vec3::Zero(), 0.0};
    const Vec3 normal = twice / twice_area;
    const Vec3 in_plane = warp_direction - warp_direction.dot(normal) * normal;
    const Vec3 u = in_plane.norm() > 1e-6 * warp_direction.norm() ? in_plane.normalized() : e1.normalized();
    const Vec3 v = normal.cross(u);
    // Gradients of the barycentric coordinates, along warp and weft.
    const Vec3 to1 = e2.cross(normal) / twice_area, to2 = normal.cross(e1) / twice_area;
    const double u1 = u.dot(to1), u2 = u.dot(to2), v1 = v.dot(to1), v2 = v.dot(to2);
    return {{-u1 - u2, u1, u2}, {-v1 - v2, v1, v2}, 0.5 * twice_area};
}

MembraneShape membrane_shape(const Vec3 (&positions)[3], const MembraneRest &rest) {
    const Vec3 e1 = positions[1] - positions[0], e2 = positions[2] - positions[0];
    return {rest.warp[1] * e1 + rest.warp[2] * e2, rest.weft[1] * e1 + rest.weft[2] * e2};
}

double membrane_energy(const MembraneShape &shape, const MembraneStrain &rest, const MembraneStiffness &stiffness) {
    const MembraneStrain now = shape.strain();
    return 0.5 * (stiffness.warp * square(now.warp - rest.warp) + stiffness.weft * square(now.weft - rest.weft) +
                  stiffness.shear * square(now.shear - rest.shear));
}

Membrane membrane(const MembraneShape &shape, const MembraneStrain &rest, const MembraneStiffness &stiffness) {
    Membrane result{Vec3::Zero(), Vec3::Zero(), Mat3::Zero(), Mat3::Zero(), Mat3::Zero()};
    add_stretch(shape.warp, rest.warp, stiffness.warp, result.gradient_warp, result.warp_warp);
    add_stretch(shape.weft, rest.weft, stiffness.weft, result.gradient_weft, result.weft_weft);
    add_shear(shape, rest.shear, stiffness.shear, result);
    return result;
}

} // namespace ringlet
