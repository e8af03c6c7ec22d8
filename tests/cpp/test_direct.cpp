// Sparse matrices and direct solvers, against dense ones.
#include "ringlet/linear/direct.h"

#include <Eigen/Dense>
#include <boost/test/data/test_case.hpp>
#include <boost/test/unit_test.hpp>
#include <random>
#include <vector>

using namespace ringlet;

namespace {

// Two chains of block rows that couple neighbours, with a few couplings between the chains: squares u uᵀ over two block rows,
// and a diagonal. Triplets repeat and are in both orders.
struct Chains {
    Chains(int rows_, int block_, double diagonal) : rows(rows_), block(block_) {
        dense = Eigen::MatrixXd::Zero(rows * block, rows * block);
        for (int row = 0; row < rows; ++row) add(row, row, diagonal * Eigen::MatrixXd::Identity(block, block));
        for (int row = 0; row + 1 < rows; ++row)
            if (row + 1 != rows / 2) couple(row, row + 1);
        for (int row = 0; row < rows / 2; row += 3) couple(rows - 1 - row, row);
    }

    void add(int row, int column, const Eigen::MatrixXd &values) {
        i.push_back(row);
        j.push_back(column);
        for (int r = 0; r < block; ++r)
            for (int c = 0; c < block; ++c) triplets.push_back(values(r, c));
        dense.block(row * block, column * block, block, block) += values;
        if (row != column) dense.block(column * block, row * block, block, block) += values.transpose();
    }

    void couple(int a, int b) {
        const Eigen::VectorXd u = random_vector(block), v = random_vector(block);
        add(a, a, u * u.transpose());
        add(a, b, u * v.transpose());
        add(b, b, v * v.transpose());
    }

    Eigen::VectorXd random_vector(int size) {
        return Eigen::VectorXd::NullaryExpr(size, [this] { return normal(random); });
    }

    std::shared_ptr<const SparsePattern> pattern() const {
        return std::make_shared<const SparsePattern>(rows, block, View<int>(i), View<int>(j));
    }

    int rows, block;
    std::vector<int> i, j;
    std::vector<double> triplets;
    Eigen::MatrixXd dense;
    std::mt19937 random{11};
    std::normal_distribution<double> normal;
};

struct Solution {
    Eigen::VectorXd x;
    double residual;
};

Solution solve(const DirectSolver &solver, const Eigen::VectorXd &b) {
    Solution solution{Eigen::VectorXd(b.size()), 0};
    solution.residual = solver.solve({b.data(), size_t(b.size())}, {solution.x.data(), size_t(b.size())});
    return solution;
}

std::vector<DirectMethod> methods() {
    if (pardiso_available()) return {DirectMethod::builtin, DirectMethod::pardiso};
    return {DirectMethod::builtin};
}

} // namespace

BOOST_AUTO_TEST_SUITE(direct)

BOOST_DATA_TEST_CASE(matrix_is_the_sum_of_its_triplets, boost::unit_test::data::make({1, 3, 4}), block) {
    Chains chains(14, block, 0.1);
    SparseMatrix matrix(chains.pattern());
    matrix.assemble(chains.triplets);
    BOOST_TEST((matrix.dense() - chains.dense).norm() < 1e-14 * chains.dense.norm());
    const Eigen::VectorXd x = chains.random_vector(14 * block);
    Eigen::VectorXd y(14 * block);
    matrix.multiply({x.data(), size_t(x.size())}, {y.data(), size_t(y.size())});
    BOOST_TEST((y - chains.dense * x).norm() < 1e-13 * y.norm());
    for (int row = 0; row < 14; ++row) // sorted, within the triangle, with the diagonal
        for (int at = matrix.pattern().starts()[row]; at < matrix.pattern().starts()[row + 1]; ++at) {
            const int column = matrix.pattern().columns()[at];
            BOOST_TEST(column >= row);
            if (at > matrix.pattern().starts()[row]) BOOST_TEST(matrix.pattern().columns()[at - 1] < column);
        }
}

BOOST_AUTO_TEST_CASE(pattern_refuses_triplets_outside_the_matrix) {
    const std::vector<int> i{0, 3}, j{1, 0};
    BOOST_CHECK_THROW(SparsePattern(3, 3, View<int>(i), View<int>(j)), std::invalid_argument);
}

BOOST_DATA_TEST_CASE(solution_agrees_with_a_dense_solver, boost::unit_test::data::make({1, 3, 4}), block) {
    Chains chains(40, block, 0.1);
    const Eigen::VectorXd b = chains.random_vector(40 * block), expected = chains.dense.ldlt().solve(b);
    for (const DirectMethod method : methods()) {
        DirectSolver solver(method);
        solver.analyse(chains.pattern());
        BOOST_TEST(solver.factor(chains.triplets));
        const Solution got = solve(solver, b);
        BOOST_TEST((got.x - expected).norm() < 1e-10 * expected.norm());
        BOOST_TEST(got.residual < 1e-12);
    }
}

BOOST_AUTO_TEST_CASE(a_pattern_serves_several_factorisations) {
    Chains chains(30, 3, 0.1);
    const Eigen::VectorXd b = chains.random_vector(90), once = chains.dense.ldlt().solve(b);
    std::vector<double> doubled = chains.triplets;
    for (double &value : doubled) value *= 2;
    for (const DirectMethod method : methods()) {
        DirectSolver solver(method);
        solver.analyse(chains.pattern());
        BOOST_TEST(solver.factor(chains.triplets));
        BOOST_TEST(solver.factor(doubled));
        BOOST_TEST((2 * solve(solver, b).x - once).norm() < 1e-10 * once.norm());
    }
}

BOOST_AUTO_TEST_CASE(factorisation_refuses_a_matrix_that_is_not_positive_definite) {
    Chains chains(20, 3, 0.1);
    std::vector<double> indefinite = chains.triplets, unknown = chains.triplets;
    indefinite[7 * 9 + 4] = -100; // the middle of the diagonal block of row 7
    unknown[7 * 9 + 4] = std::nan("");
    for (const DirectMethod method : methods()) {
        DirectSolver solver(method);
        solver.analyse(chains.pattern());
        BOOST_TEST(!solver.factor(indefinite));
        BOOST_TEST(!solver.factor(unknown));
        BOOST_TEST(solver.factor(chains.triplets)); // the solver is still usable
    }
}

BOOST_AUTO_TEST_CASE(the_returned_residual_is_that_of_the_solution_also_if_ill_conditioned) {
    // Stiffnesses that differ by a factor of 1e12.
    Chains chains(30, 3, 1e-9);
    for (int k = 0; k < 9; ++k) chains.triplets[k] *= 1e12;
    chains.dense.topLeftCorner(3, 3) += (1e12 - 1) * 1e-9 * Eigen::Matrix3d::Identity();
    const Eigen::VectorXd eigenvalues = chains.dense.selfadjointView<Eigen::Lower>().eigenvalues();
    BOOST_TEST(eigenvalues.maxCoeff() > 1e11 * eigenvalues.minCoeff());
    const Eigen::VectorXd b = chains.random_vector(90);
    for (const DirectMethod method : methods()) {
        DirectSolver solver(method);
        solver.analyse(chains.pattern());
        BOOST_TEST(solver.factor(chains.triplets));
        const Solution got = solve(solver, b);
        const double residual = (b - chains.dense * got.x).norm() / b.norm();
        BOOST_TEST(got.residual > 0);
        BOOST_TEST(std::abs(got.residual - residual) < 0.5 * got.residual + 1e-12);
        BOOST_TEST(got.residual < 1e-3);
    }
}

BOOST_AUTO_TEST_SUITE_END()
