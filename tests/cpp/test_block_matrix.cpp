// Block matrix and incomplete Cholesky, against dense matrices.
#include "plain_system.h"
#include "ringlet/linear/block_matrix.h"
#include "ringlet/linear/incomplete_cholesky.h"

#include <Eigen/Dense>
#include <array>
#include <boost/test/unit_test.hpp>
#include <random>
#include <vector>

using namespace ringlet;

namespace {

// A random positive definite matrix on a ring with chords.
struct BlockSystem {
    explicit BlockSystem(int rows) {
        std::vector<std::array<int, 2>> pairs;
        for (int i = 0; i < rows; ++i) {
            pairs.push_back({i, (i + 1) % rows});
            pairs.push_back({(i + 5) % rows, i});
        }
        matrix = BlockMatrix(rows, pairs);
        dense = Eigen::MatrixXd::Zero(3 * rows, 3 * rows);
        std::mt19937 random(5);
        std::normal_distribution<double> normal;
        for (const auto &[a, b] : pairs) {
            Vec3 u, v;
            for (int k = 0; k < 3; ++k) u[k] = normal(random), v[k] = normal(random);
            add(a, a, u * u.transpose());
            add(a, b, u * v.transpose());
            add(b, a, v * u.transpose());
            add(b, b, v * v.transpose());
        }
        for (int i = 0; i < rows; ++i) add(i, i, 0.1 * Mat3::Identity());
    }
    void add(int row, int column, const Mat3 &block) {
        matrix.block(matrix.slot(row, column)) += block;
        dense.block<3, 3>(3 * row, 3 * column) += block;
    }
    BlockMatrix matrix;
    Eigen::MatrixXd dense;
};

} // namespace

BOOST_AUTO_TEST_SUITE(block_matrix)

BOOST_AUTO_TEST_CASE(the_product_with_a_vector_agrees_with_a_dense_matrix) {
    const BlockSystem system(23);
    const Eigen::VectorXd x = Eigen::VectorXd::LinSpaced(69, -1, 2);
    Eigen::VectorXd y;
    system.matrix.multiply(x, y);
    BOOST_TEST((y - system.dense * x).norm() < 1e-13 * y.norm());
}

BOOST_AUTO_TEST_CASE(pairs_outside_the_pattern_have_no_slot) {
    const BlockSystem system(23);
    BOOST_TEST(system.matrix.slot(0, 2) == -1);
    BOOST_TEST(system.matrix.slot(0, 1) >= 0);
    BOOST_TEST(system.matrix.column(system.matrix.diagonal(7)) == 7);
}

BOOST_AUTO_TEST_CASE(the_scalar_rows_are_those_of_the_dense_matrix) {
    const BlockSystem system(23);
    const ScalarRows rows = system.matrix.scalar_rows();
    Eigen::MatrixXd dense = Eigen::MatrixXd::Zero(69, 69);
    for (int r = 0; r < 69; ++r)
        for (int k = rows.starts[r]; k < rows.starts[r + 1]; ++k) {
            dense(r, rows.columns[k]) = rows.values[k];
            if (k > rows.starts[r]) BOOST_TEST(rows.columns[k] > rows.columns[k - 1]);
        }
    BOOST_TEST((dense - system.dense).norm() == 0);
}

BOOST_AUTO_TEST_CASE(the_incomplete_factor_of_a_chain_is_exact) {
    // A chain has no fill-in, so its incomplete factor is complete.
    std::vector<std::array<int, 2>> pairs;
    for (int i = 0; i + 1 < 20; ++i) pairs.push_back({i, i + 1});
    BlockMatrix chain(20, pairs);
    for (const auto &[a, b] : pairs) {
        const Mat3 spring =
            Vec3(1 + a, 2, -1).normalized() * Vec3(1 + a, 2, -1).normalized().transpose() + 0.1 * Mat3::Identity();
        for (const int i : {a, b}) chain.block(chain.diagonal(i)) += spring + 0.01 * Mat3::Identity();
        chain.block(chain.slot(a, b)) -= spring;
        chain.block(chain.slot(b, a)) -= spring;
    }
    const Eigen::VectorXd expected = Eigen::VectorXd::LinSpaced(60, -1, 2);
    Eigen::VectorXd b, x;
    chain.multiply(expected, b);
    IncompleteCholesky factor;
    factor.factor(chain);
    factor.solve(b, x);
    BOOST_TEST(factor.shift() == 0);
    BOOST_TEST((x - expected).norm() < 1e-10 * expected.norm());
}

BOOST_AUTO_TEST_CASE(an_incomplete_factor_needs_fewer_iterations_than_no_preconditioner) {
    const BlockSystem system(200);
    const Eigen::VectorXd b = Eigen::VectorXd::LinSpaced(600, -1, 2);
    const auto apply = [&](const auto &v, auto &Av) { system.matrix.multiply(v, Av); };
    IncompleteCholesky cholesky;
    cholesky.factor(system.matrix);
    Eigen::VectorXd plainly, x;
    const int plain = solve_plainly(apply, [](const auto &r, auto &z) { z = r; }, b, plainly, 1e-10);
    const int by_cholesky = solve_plainly(apply, [&](const auto &r, auto &z) { cholesky.solve(r, z); }, b, x, 1e-10);
    BOOST_TEST((system.dense * x - b).norm() < 1e-7 * b.norm());
    BOOST_TEST(by_cholesky < plain);
}

BOOST_AUTO_TEST_CASE(an_indefinite_matrix_is_shifted_until_it_has_a_factor) {
    std::vector<std::array<int, 2>> pairs{{0, 1}};
    BlockMatrix matrix(2, pairs);
    for (const int i : {0, 1}) matrix.block(matrix.diagonal(i)) = Mat3::Identity();
    for (const int i : {0, 1}) matrix.block(matrix.slot(i, 1 - i)) = 3 * Mat3::Identity();
    IncompleteCholesky factor;
    factor.factor(matrix);
    BOOST_TEST(factor.shift() >= 2);
    Eigen::VectorXd x;
    factor.solve(Eigen::VectorXd::Ones(6), x);
    BOOST_TEST(x.allFinite());
}

BOOST_AUTO_TEST_SUITE_END()
