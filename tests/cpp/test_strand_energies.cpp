// Stretch, bend and twist of a single stencil. Gradients agree with finite differences; Hessians are positive semi-definite
// and, where no eigenvalue is clamped, exact.
#include "differences.h"
#include "ringlet/energy/strand/bend.h"
#include "ringlet/energy/strand/stretch.h"
#include "ringlet/energy/strand/twist.h"
#include "ringlet/strand/hinge/continuation.h"

#include <Eigen/Dense>
#include <boost/test/unit_test.hpp>
#include <cmath>
#include <random>

using namespace ringlet::baseline;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using ringlet::differences;
using ringlet::random_vector;

namespace {

Vec<double> vector_at(const VectorXd &x, int k) { return {x[3 * k], x[3 * k + 1], x[3 * k + 2]}; }

struct Edges {
    Vec<double> t0, t1;
    double l0, l1;
    Corner<double> c;
};

Edges edges_of(const VectorXd &e) {
    const double l0 = norm(vector_at(e, 0)), l1 = norm(vector_at(e, 1));
    const Vec<double> t0 = (1 / l0) * vector_at(e, 0), t1 = (1 / l1) * vector_at(e, 1);
    return {t0, t1, l0, l1, corner(t0, t1)};
}

Bend<double> bend_of(const VectorXd &e, double sigma, double rest_angle, double stiffness) {
    const Edges s = edges_of(e);
    return bend(s.c, s.t0, s.t1, s.l0, s.l1, sigma, rest_angle, stiffness);
}

double bend_energy_of(const VectorXd &e, double sigma, double rest_angle, double stiffness) {
    return bend_energy(edges_of(e).c.angle, sigma, rest_angle, stiffness);
}

VectorXd gradient_of(const Bend<double> &b) {
    VectorXd g(6);
    g << b.gradient0.x, b.gradient0.y, b.gradient0.z, b.gradient1.x, b.gradient1.y, b.gradient1.z;
    return g;
}

MatrixXd hessian_of(const Bend<double> &b) {
    MatrixXd H = MatrixXd::Zero(6, 6);
    for (const EdgeTerm<double> &term : b.terms) {
        VectorXd u(6);
        u << term.first.x, term.first.y, term.first.z, term.second.x, term.second.y, term.second.z;
        H += term.coefficient * u * u.transpose();
    }
    return H;
}

double dihedral_of(const VectorXd &x) {
    VectorXd e(9);
    for (int k = 0; k < 9; ++k) e[k] = x[k + 3] - x[k];
    const Edges first = edges_of(e.head(6)), second = edges_of(e.tail(6));
    return dihedral(first.c, second.c, second.t1);
}

} // namespace

BOOST_AUTO_TEST_SUITE(strand_energies)

BOOST_AUTO_TEST_CASE(stretch_gradient_agrees_with_differences) {
    std::mt19937 random(3);
    for (int trial = 0; trial < 50; ++trial) {
        const VectorXd e = random_vector(3, random);
        const auto energy = [](const VectorXd &x) { return stretch_energy(norm(vector_at(x, 0)), 1.3, 5.0); };
        const double length = norm(vector_at(e, 0));
        const Stretch<double> s = stretch((1 / length) * vector_at(e, 0), length, 1.3, 5.0);
        const VectorXd g = differences(energy, e, 1e-6);
        BOOST_TEST(norm(s.gradient - vector_at(g, 0)) < 1e-8);
        BOOST_TEST(s.along >= 0);
        BOOST_TEST(s.across >= 0);
    }
}

BOOST_AUTO_TEST_CASE(bend_gradient_agrees_with_differences_for_both_signs) {
    std::mt19937 random(4);
    for (int trial = 0; trial < 100; ++trial) {
        const VectorXd e = random_vector(6, random);
        for (const double sigma : {1.0, -1.0}) {
            const auto energy = [&](const VectorXd &x) { return bend_energy_of(x, sigma, 0.8, 2.0); };
            const VectorXd g = gradient_of(bend_of(e, sigma, 0.8, 2.0)), expected = differences(energy, e, 1e-6);
            BOOST_TEST((g - expected).norm() < 1e-7 * (1 + expected.norm()));
        }
    }
}

BOOST_AUTO_TEST_CASE(bend_hessian_is_exact_where_all_its_eigenvalues_are_positive) {
    // At the rest angle w = 0: nothing is clamped and the Hessian is k g gᵀ.
    std::mt19937 random(5);
    for (int trial = 0; trial < 20; ++trial) {
        const VectorXd e = random_vector(6, random);
        const double angle = edges_of(e).c.angle;
        const MatrixXd H = hessian_of(bend_of(e, 1, angle, 2.0));
        MatrixXd expected(6, 6);
        for (int k = 0; k < 6; ++k) {
            VectorXd step = VectorXd::Zero(6);
            step[k] = 1e-5;
            expected.col(k) =
                (gradient_of(bend_of(e + step, 1, angle, 2.0)) - gradient_of(bend_of(e - step, 1, angle, 2.0))) / 2e-5;
        }
        BOOST_TEST((H - expected).norm() < 1e-5 * (1 + expected.norm()));
    }
}

BOOST_AUTO_TEST_CASE(bend_hessian_is_the_positive_part_of_the_exact_one) {
    // With unit edges the scaled edge space is the edge space, and the positive part is the spectral one.
    std::mt19937 random(6);
    for (int trial = 0; trial < 50; ++trial) {
        VectorXd e = random_vector(6, random);
        e.head(3).normalize();
        e.tail(3).normalize();
        for (const double rest_angle : {0.1, 1.0, 2.5}) {
            MatrixXd exact(6, 6);
            for (int k = 0; k < 6; ++k) {
                VectorXd step = VectorXd::Zero(6);
                step[k] = 1e-5;
                exact.col(k) =
                    (gradient_of(bend_of(e + step, 1, rest_angle, 1.0)) - gradient_of(bend_of(e - step, 1, rest_angle, 1.0))) /
                    2e-5;
            }
            const Eigen::SelfAdjointEigenSolver<MatrixXd> eigen(0.5 * (exact + exact.transpose()));
            const MatrixXd positive =
                eigen.eigenvectors() * eigen.eigenvalues().cwiseMax(0.0).asDiagonal() * eigen.eigenvectors().transpose();
            BOOST_TEST((hessian_of(bend_of(e, 1, rest_angle, 1.0)) - positive).norm() < 1e-4 * (1 + positive.norm()));
        }
    }
}

BOOST_AUTO_TEST_CASE(as_many_bend_eigenvalues_count_as_clamped_as_are_negative) {
    // Measuring each edge in its own length is a congruence: the signs are those of the plain Hessian (Sylvester).
    std::mt19937 random(7);
    for (int trial = 0; trial < 50; ++trial) {
        const VectorXd e = random_vector(6, random);
        for (const double sigma : {1.0, -1.0}) {
            const double rest_angle = 1.0;
            MatrixXd exact(6, 6);
            for (int k = 0; k < 6; ++k) {
                VectorXd step = VectorXd::Zero(6);
                step[k] = 1e-5;
                exact.col(k) = (gradient_of(bend_of(e + step, sigma, rest_angle, 1.0)) -
                                gradient_of(bend_of(e - step, sigma, rest_angle, 1.0))) /
                               2e-5;
            }
            const VectorXd values = Eigen::SelfAdjointEigenSolver<MatrixXd>(0.5 * (exact + exact.transpose())).eigenvalues();
            BOOST_TEST(clamped_bend(edges_of(e).c, sigma, rest_angle, 1.0) == (values.array() < -1e-6).count());
        }
        const double angle = edges_of(e).c.angle;
        BOOST_TEST(clamped_bend(edges_of(e).c, 1.0, angle, 1.0) == 0);
    }
}

BOOST_AUTO_TEST_CASE(bend_stays_finite_and_positive_on_degenerate_input) {
    VectorXd straight(6), folded(6);
    straight << 1, 0, 0, 2, 0, 0;
    folded << 1, 0, 0, -1, 0, 0;
    for (const VectorXd &e : {straight, folded})
        for (const double rest_angle : {0.0, 0.5, pi})
            for (const double sigma : {1.0, -1.0}) {
                const Bend<double> b = bend_of(e, sigma, rest_angle, 1.0);
                BOOST_TEST(gradient_of(b).allFinite());
                BOOST_TEST(hessian_of(b).allFinite());
                for (const EdgeTerm<double> &term : b.terms) BOOST_TEST(term.coefficient >= 0);
            }
}

BOOST_AUTO_TEST_CASE(a_straight_rest_shape_resists_bending_in_every_plane) {
    VectorXd straight(6), sideways(6);
    straight << 1, 0, 0, 1, 0, 0;
    const MatrixXd H = hessian_of(bend_of(straight, 1, 0.0, 1.0));
    for (const int axis : {1, 2}) { // a small rotation of the second edge about an axis across
        sideways.setZero();
        sideways[3 + axis] = 1;
        BOOST_TEST(std::abs(sideways.dot(H * sideways) - 1) < 1e-9);
    }
}

BOOST_AUTO_TEST_CASE(dihedral_gradient_agrees_with_differences) {
    std::mt19937 random(8);
    for (int trial = 0; trial < 100; ++trial) {
        const VectorXd x = random_vector(12, random);
        VectorXd e(9);
        for (int k = 0; k < 9; ++k) e[k] = x[k + 3] - x[k];
        const Edges first = edges_of(e.head(6)), second = edges_of(e.tail(6));
        if (first.c.sine < 0.05 || second.c.sine < 0.05) continue; // too straight for differences
        const DihedralGradient<double> g = dihedral_gradient(first.c, second.c, first.l0, first.l1, second.l1);
        const double here = dihedral_of(x);
        const VectorXd expected = differences([&](const VectorXd &at) { return wrap(dihedral_of(at) - here); }, x, 1e-7);
        for (int k = 0; k < 4; ++k) BOOST_TEST(norm(g.at[k] - vector_at(expected, k)) < 1e-5 * (1 + expected.norm()));
    }
}

BOOST_AUTO_TEST_CASE(dihedral_of_a_helix_has_the_sign_of_its_hand) {
    for (const double hand : {1.0, -1.0}) {
        VectorXd x(12);
        for (int k = 0; k < 4; ++k) x.segment<3>(3 * k) << std::cos(0.5 * k), std::sin(0.5 * k), hand * 0.2 * k;
        BOOST_TEST(hand * dihedral_of(x) > 0);
    }
}

BOOST_AUTO_TEST_CASE(rounded_twist_is_smooth_and_level_at_half_a_turn) {
    for (double delta = -3.1; delta < 3.1; delta += 0.01) {
        const double h = 1e-6, slope = (rounded(delta + h).value - rounded(delta - h).value) / (2 * h);
        BOOST_TEST(std::abs(rounded(delta).slope - slope) < 1e-8);
        if (std::abs(delta) < pi / 2) BOOST_TEST(rounded(delta).value == delta);
    }
    BOOST_TEST(std::abs(rounded(pi).slope) < 1e-15);
    BOOST_TEST(std::abs(rounded(pi).value - (pi / 2 + 1)) < 1e-15);
}

BOOST_AUTO_TEST_CASE(straightness_rises_smoothly_from_zero_to_one) {
    BOOST_TEST(straightness(0.001, 0.5).value == 0);
    BOOST_TEST(straightness(0.25, 0.5).value == 1);
    for (double angle = 0.005; angle < pi - 0.005; angle += 0.007) {
        const double h = 1e-7, slope = (straightness(angle + h, 0.5).value - straightness(angle - h, 0.5).value) / (2 * h);
        BOOST_TEST(std::abs(straightness(angle, 0.5).slope - slope) < 1e-5);
    }
}

BOOST_AUTO_TEST_SUITE_END()
