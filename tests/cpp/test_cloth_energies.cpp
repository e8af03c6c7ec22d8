// Membrane and hinge of a single stencil: derivatives against differences, positive semi-definite Hessians, invariance under
// rigid motions, and the forces and energies of simple shapes.
#include "differences.h"
#include "ringlet/energy/cloth/hinge.h"
#include "ringlet/energy/cloth/membrane.h"

#include <Eigen/Dense>
#include <algorithm>
#include <boost/test/unit_test.hpp>
#include <cmath>
#include <numbers>
#include <random>

using namespace ringlet;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

const MembraneStiffness stiffness{3.0, 2.0, 1.5};

MembraneShape shape_of(const VectorXd &F) { return {F.head<3>(), F.tail<3>()}; }

VectorXd gradient_of(const Membrane &m) {
    VectorXd g(6);
    g << m.gradient_warp, m.gradient_weft;
    return g;
}

MatrixXd hessian_of(const Membrane &m) {
    MatrixXd H(6, 6);
    H << m.warp_warp, m.warp_weft, m.warp_weft.transpose(), m.weft_weft;
    return H;
}

struct Points4 {
    Vec3 x[4];
};

Points4 four(const VectorXd &x) { return {{x.segment<3>(0), x.segment<3>(3), x.segment<3>(6), x.segment<3>(9)}}; }

Mat3 turn(std::mt19937 &random) {
    const VectorXd q = random_vector(4, random);
    return Eigen::Quaterniond(q[0], q[1], q[2], q[3]).normalized().toRotationMatrix();
}

} // namespace

BOOST_AUTO_TEST_SUITE(cloth_energies)

BOOST_AUTO_TEST_CASE(membrane_gradient_agrees_with_differences) {
    std::mt19937 random(3);
    for (int trial = 0; trial < 100; ++trial) {
        const VectorXd F = random_vector(6, random);
        const MembraneStrain rest{1.0, 0.9, 0.2};
        const auto energy = [&](const VectorXd &x) { return membrane_energy(shape_of(x), rest, stiffness); };
        const VectorXd expected = differences(energy, F, 1e-6);
        BOOST_TEST((gradient_of(membrane(shape_of(F), rest, stiffness)) - expected).norm() < 1e-7 * (1 + expected.norm()));
    }
}

// Stretch in each direction and shear are projected separately. The sum is exact if none of them has a negative eigenvalue, and
// the sum of their projections otherwise.
BOOST_AUTO_TEST_CASE(membrane_hessian_is_the_sum_of_the_psd_projections_of_its_terms) {
    std::mt19937 random(4);
    for (int trial = 0; trial < 200; ++trial) {
        const VectorXd F = random_vector(6, random);
        const MembraneStrain rest{1.0, 0.9, trial % 2 ? 0.0 : 0.4};
        const MembraneStiffness parts[3] = {{3, 0, 0}, {0, 2, 0}, {0, 0, 1.5}};
        for (const MembraneStiffness &part : parts) {
            MatrixXd exact(6, 6);
            for (int k = 0; k < 6; ++k) {
                VectorXd step = VectorXd::Zero(6);
                step[k] = 1e-5;
                exact.col(k) = (gradient_of(membrane(shape_of(F + step), rest, part)) -
                                gradient_of(membrane(shape_of(F - step), rest, part))) /
                               2e-5;
            }
            const Eigen::SelfAdjointEigenSolver<MatrixXd> eigen(0.5 * (exact + exact.transpose()));
            const MatrixXd positive =
                eigen.eigenvectors() * eigen.eigenvalues().cwiseMax(0.0).asDiagonal() * eigen.eigenvectors().transpose();
            BOOST_TEST((hessian_of(membrane(shape_of(F), rest, part)) - positive).norm() < 1e-5 * (1 + positive.norm()));
        }
    }
}

BOOST_AUTO_TEST_CASE(membrane_stays_finite_and_positive_on_degenerate_input) {
    VectorXd point = VectorXd::Zero(6), line(6), one(6), sheared(6);
    line << 1, 0, 0, 1, 0, 0;
    one << 0, 0, 0, 0, 1, 0;
    sheared << 1, 0, 0, -1, 1e-9, 0;
    for (const VectorXd &F : {point, line, one, sheared})
        for (const double rest_shear : {0.0, 0.5, -0.5}) {
            const Membrane m = membrane(shape_of(F), {1, 1, rest_shear}, stiffness);
            const MatrixXd H = hessian_of(m);
            BOOST_TEST(gradient_of(m).allFinite());
            BOOST_TEST(H.allFinite());
            const Eigen::SelfAdjointEigenSolver<MatrixXd> eigen(H);
            BOOST_TEST(eigen.eigenvalues().minCoeff() > -1e-12 * (1 + eigen.eigenvalues().maxCoeff()));
        }
}

BOOST_AUTO_TEST_CASE(a_rigidly_moved_triangle_has_no_energy) {
    std::mt19937 random(5);
    for (int trial = 0; trial < 50; ++trial) {
        const VectorXd x = random_vector(9, random);
        const Vec3 rest[3] = {x.head<3>(), x.segment<3>(3), x.tail<3>()};
        const MembraneRest measured = measure_membrane(rest, Vec3(1, 2, 3));
        const Mat3 R = turn(random);
        const Vec3 moved[3] = {R * rest[0] + Vec3(1, 2, 3), R * rest[1] + Vec3(1, 2, 3), R * rest[2] + Vec3(1, 2, 3)};
        BOOST_TEST(membrane_energy(membrane_shape(moved, measured), {1, 1, 0}, stiffness) < 1e-22);
        BOOST_TEST(std::abs(measured.area - 0.5 * (rest[1] - rest[0]).cross(rest[2] - rest[0]).norm()) < 1e-12);
    }
}

BOOST_AUTO_TEST_CASE(a_square_stretched_along_its_warp_pulls_with_stiffness_times_strain_times_width) {
    // Two triangles of a square of side a, stretched by 10 % along x: the force across a cut is k ε a.
    const double a = 0.3, strain = 0.1;
    const Vec3 corner[4] = {{0, 0, 0}, {a, 0, 0}, {a, a, 0}, {0, a, 0}};
    Vec3 force[4] = {Vec3::Zero(), Vec3::Zero(), Vec3::Zero(), Vec3::Zero()};
    const int triangles[2][3] = {{0, 1, 2}, {0, 2, 3}};
    for (const auto &t : triangles) {
        const Vec3 rest[3] = {corner[t[0]], corner[t[1]], corner[t[2]]};
        Vec3 now[3];
        for (int k = 0; k < 3; ++k) now[k] = {(1 + strain) * rest[k].x(), rest[k].y(), 0};
        const MembraneRest measured = measure_membrane(rest, Vec3::UnitX());
        const Membrane m = membrane(membrane_shape(now, measured), {1, 1, 0}, stiffness);
        for (int k = 0; k < 3; ++k)
            force[t[k]] -= measured.area * (measured.warp[k] * m.gradient_warp + measured.weft[k] * m.gradient_weft);
    }
    const Vec3 right = force[1] + force[2], left = force[0] + force[3];
    BOOST_TEST((right - Vec3(-stiffness.warp * strain * a, 0, 0)).norm() < 1e-14);
    BOOST_TEST((left + right).norm() < 1e-14);
}

BOOST_AUTO_TEST_CASE(a_triangle_without_area_has_no_weights) {
    const Vec3 rest[3] = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}};
    const MembraneRest measured = measure_membrane(rest, Vec3::UnitX());
    BOOST_TEST(measured.area == 0);
    BOOST_TEST(measured.warp.isZero());
    BOOST_TEST(measured.weft.isZero());
}

BOOST_AUTO_TEST_CASE(hinge_gradient_agrees_with_differences) {
    std::mt19937 random(6);
    for (int trial = 0; trial < 200; ++trial) {
        const VectorXd x = random_vector(12, random);
        const Hinge h = hinge(four(x).x);
        const auto angle = [&](const VectorXd &y) { return hinge_strain(hinge_angle(four(y).x), h.angle); };
        const VectorXd expected = differences(angle, x, 1e-6);
        for (int k = 0; k < 4; ++k)
            BOOST_TEST((h.gradient[k] - expected.segment<3>(3 * k)).norm() < 1e-5 * (1 + expected.squaredNorm()));
    }
}

BOOST_AUTO_TEST_CASE(the_hinge_angle_is_zero_for_a_flat_sheet_and_the_angle_of_a_fold) {
    for (const double fold : {0.0, 0.3, -0.3, 1.5, -3.0}) {
        const Vec3 x[4] = {{0.2, -1, 0}, {0, 0, 0}, {1, 0, 0}, {0.6, std::cos(fold), std::sin(fold)}};
        BOOST_TEST(std::abs(std::abs(hinge_angle(x)) - std::abs(fold)) < 1e-14);
        const Vec3 mirrored[4] = {{0.2, -1, 0}, {0, 0, 0}, {1, 0, 0}, {0.6, std::cos(fold), -std::sin(fold)}};
        BOOST_TEST(std::abs(hinge_angle(x) + hinge_angle(mirrored)) < 1e-14);
    }
}

BOOST_AUTO_TEST_CASE(a_hinge_is_invariant_under_rigid_motions_without_net_force_or_torque) {
    std::mt19937 random(7);
    for (int trial = 0; trial < 50; ++trial) {
        const Points4 p = four(random_vector(12, random));
        const Mat3 R = turn(random);
        Points4 moved;
        for (int k = 0; k < 4; ++k) moved.x[k] = R * p.x[k] + Vec3(3, -1, 2);
        const Hinge before = hinge(p.x), after = hinge(moved.x);
        BOOST_TEST(std::abs(hinge_strain(after.angle, before.angle)) < 1e-12);
        Vec3 force = Vec3::Zero(), torque = Vec3::Zero();
        double most = 0;
        for (int k = 0; k < 4; ++k) {
            force += before.gradient[k];
            torque += p.x[k].cross(before.gradient[k]);
            most = std::max(most, before.gradient[k].norm());
        }
        BOOST_TEST(force.norm() < 1e-12 * most);
        BOOST_TEST(torque.norm() < 1e-11 * (1 + most));
    }
}

BOOST_AUTO_TEST_CASE(a_hinge_of_degenerate_triangles_is_finite) {
    const Points4 shapes[] = {{{{0, 0, 0}, {0, 0, 0}, {0, 0, 0}, {0, 0, 0}}},
                              {{{-1, 0, 0}, {0, 0, 0}, {1, 0, 0}, {2, 0, 0}}},
                              {{{0, -1, 0}, {0, 0, 0}, {0, 0, 0}, {0, 1, 0}}},
                              {{{0, 1, 0}, {0, 0, 0}, {1e-20, 0, 0}, {0, 1, 1e-20}}}};
    for (const Points4 &shape : shapes) {
        const Hinge h = hinge(shape.x);
        BOOST_TEST(std::isfinite(h.angle));
        for (const Vec3 &g : h.gradient) BOOST_TEST(g.norm() < 1e7);
        BOOST_TEST(std::isfinite(hinge_stiffness(shape.x, 1e-5)));
    }
}

BOOST_AUTO_TEST_CASE(a_sheet_on_a_cylinder_has_the_energy_half_stiffness_times_curvature_squared) {
    // Three hinges of one equilateral triangle with its neighbours; an infinite sheet has three hinges per two triangles.
    const double a = 0.01, curvature = 0.5, bend = 2e-5, height = a * std::sqrt(3.0) / 2;
    for (const double direction : {0.0, 0.3, 1.0}) {
        const auto rolled = [&](double x, double y) {
            const double along = x * std::cos(direction) + y * std::sin(direction);
            const double across = -x * std::sin(direction) + y * std::cos(direction);
            return Vec3(std::sin(curvature * along) / curvature, across, (1 - std::cos(curvature * along)) / curvature);
        };
        double energy = 0;
        for (int edge = 0; edge < 3; ++edge) {
            const double angle = edge * std::numbers::pi / 3, c = std::cos(angle), s = std::sin(angle);
            const double flat[4][2] = {{a / 2, -height}, {0, 0}, {a, 0}, {a / 2, height}};
            Points4 rest, now;
            for (int k = 0; k < 4; ++k) {
                const double x = c * flat[k][0] - s * flat[k][1], y = s * flat[k][0] + c * flat[k][1];
                rest.x[k] = {x, y, 0};
                now.x[k] = rolled(x, y);
            }
            const double strain = hinge_strain(hinge_angle(now.x), hinge_angle(rest.x));
            energy += 0.5 * hinge_stiffness(rest.x, bend) * strain * strain;
        }
        const double expected = 0.5 * bend * curvature * curvature * (a * height);
        BOOST_TEST(std::abs(energy / expected - 1) < 1e-4);
    }
}

BOOST_AUTO_TEST_SUITE_END()
