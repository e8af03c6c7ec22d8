// Conjugate gradients against dense solvers.
#include "plain_system.h"

#include <Eigen/Dense>
#include <boost/test/unit_test.hpp>
#include <random>

using namespace ringlet;

namespace {

constexpr int size = 30;
const auto unchanged = [](const Eigen::VectorXd &r, Eigen::VectorXd &z) { z = r; };

Eigen::MatrixXd random_matrix(unsigned seed) { // positive definite
    std::mt19937 random(seed);
    std::normal_distribution<double> normal;
    const Eigen::MatrixXd A = Eigen::MatrixXd::NullaryExpr(size, size, [&] { return normal(random); });
    return A * A.transpose() + Eigen::MatrixXd::Identity(size, size);
}

const Eigen::VectorXd right_hand_side = Eigen::VectorXd::LinSpaced(size, -1, 2);

} // namespace

BOOST_AUTO_TEST_SUITE(conjugate_gradients)

BOOST_AUTO_TEST_CASE(they_agree_with_a_dense_solver) {
    const Eigen::MatrixXd A = random_matrix(1);
    const Eigen::VectorXd expected = A.ldlt().solve(right_hand_side);
    Eigen::VectorXd x;
    const int iterations = solve_plainly([&](const auto &p, auto &Ap) { Ap = A * p; }, unchanged, right_hand_side, x, 1e-13);
    BOOST_TEST(iterations <= 3 * size);
    BOOST_TEST((x - expected).norm() < 1e-9 * expected.norm());
}

BOOST_AUTO_TEST_CASE(an_exact_preconditioner_needs_one_iteration) {
    const Eigen::MatrixXd A = random_matrix(2);
    const Eigen::LDLT<Eigen::MatrixXd> factor(A);
    Eigen::VectorXd x;
    const int iterations = solve_plainly([&](const auto &p, auto &Ap) { Ap = A * p; },
                                         [&](const auto &r, auto &z) { z = factor.solve(r); }, right_hand_side, x, 1e-8);
    BOOST_TEST(iterations == 1);
    BOOST_TEST((A * x - right_hand_side).norm() < 1e-9 * right_hand_side.norm());
}

BOOST_AUTO_TEST_CASE(the_energy_falls_by_the_decreases) {
    const Eigen::MatrixXd A = random_matrix(3);
    const auto energy = [&](const Eigen::VectorXd &x) { return x.dot(A * x) - 2 * right_hand_side.dot(x); };
    const auto apply = [&](const Eigen::VectorXd &p, Eigen::VectorXd &Ap) { Ap = A * p; };
    PlainSystem system(apply, unchanged, {size});
    Eigen::VectorXd r = right_hand_side, x = Eigen::VectorXd::Zero(size);
    double last = 0.0;
    conjugate_gradient(system, r, x, [&](int iterations, const auto &, const std::vector<double> &decrease) {
        const double now = energy(x);
        if (iterations > 0) BOOST_TEST(std::abs(last - now - decrease[0]) < 1e-9 * std::abs(now));
        last = now;
        return std::vector<unsigned char>{iterations < 10};
    });
    BOOST_TEST((r - (right_hand_side - A * x)).norm() < 1e-10 * right_hand_side.norm());
}

// Each has step lengths of its own, and rests when it has converged.
BOOST_AUTO_TEST_CASE(clusters_are_solved_to_the_same_bits_as_alone) {
    const Eigen::MatrixXd A = random_matrix(4), B = 1e6 * random_matrix(5);
    Eigen::VectorXd b(2 * size), one, other, both;
    b << right_hand_side, right_hand_side.reverse();
    const auto apply = [&](const Eigen::VectorXd &p, Eigen::VectorXd &Ap) {
        Ap.resize(2 * size);
        Ap << A * p.head(size), B * p.tail(size);
    };
    solve_plainly([&](const auto &p, auto &Ap) { Ap = A * p; }, unchanged, b.head(size), one, 1e-3);
    solve_plainly([&](const auto &p, auto &Ap) { Ap = B * p; }, unchanged, b.tail(size), other, 1e-3);
    solve_plainly(apply, unchanged, b, both, 1e-3, 5000, {size, 2 * size});
    BOOST_TEST((both.head(size) == one));
    BOOST_TEST((both.tail(size) == other));
}

BOOST_AUTO_TEST_CASE(the_limit_of_iterations_leaves_a_residual) {
    const Eigen::MatrixXd A = random_matrix(6);
    Eigen::VectorXd x;
    const int iterations = solve_plainly([&](const auto &p, auto &Ap) { Ap = A * p; }, unchanged, right_hand_side, x, 1e-12, 3);
    BOOST_TEST(iterations == 3);
    BOOST_TEST((A * x - right_hand_side).norm() > 1e-6 * right_hand_side.norm());
}

BOOST_AUTO_TEST_CASE(they_stop_where_the_curvature_is_negative) {
    const Eigen::MatrixXd A = -random_matrix(7);
    Eigen::VectorXd x;
    const int iterations = solve_plainly([&](const auto &p, auto &Ap) { Ap = A * p; }, unchanged, right_hand_side, x, 1e-6);
    BOOST_TEST(iterations == 1);
    BOOST_TEST(x.norm() == 0.0);
}

BOOST_AUTO_TEST_SUITE_END()
