// Sparse Cholesky factors of block matrices, against dense ones.
#include "ringlet/linear/block_cholesky.h"

#include <Eigen/Dense>
#include <boost/test/unit_test.hpp>
#include <random>
#include <set>

using namespace ringlet;

namespace {

using Cholesky = BlockCholesky<3>;

struct SparseSystem {
    std::vector<Cholesky::Block> diagonal;
    std::vector<Cholesky::Entry> below;
    Eigen::MatrixXd dense;
};

SparseSystem random_matrix(int rows, int entries, double dominance, unsigned seed) {
    std::mt19937 engine(seed);
    std::uniform_real_distribution<> value(-1.0, 1.0);
    std::uniform_int_distribution<> index(0, rows - 1);
    SparseSystem random{{}, {}, Eigen::MatrixXd::Zero(3 * rows, 3 * rows)};
    std::set<std::array<int, 2>> taken;
    while (int(taken.size()) < entries) {
        const int a = index(engine), b = index(engine);
        if (a <= b || !taken.insert({a, b}).second) continue;
        Cholesky::Block block;
        for (int i = 0; i < 9; ++i) block(i) = value(engine);
        random.below.push_back({{a, b}, block});
        random.dense.block<3, 3>(3 * a, 3 * b) = block;
        random.dense.block<3, 3>(3 * b, 3 * a) = block.transpose();
    }
    for (int k = 0; k < rows; ++k) {
        random.diagonal.push_back(dominance * Cholesky::Block::Identity());
        random.dense.block<3, 3>(3 * k, 3 * k) = random.diagonal.back();
    }
    return random;
}

} // namespace

BOOST_AUTO_TEST_SUITE(block_cholesky)

BOOST_AUTO_TEST_CASE(solves_as_a_dense_factor_does) {
    for (const int rows : {1, 2, 7, 60}) {
        const SparseSystem random = random_matrix(rows, rows > 2 ? 2 * rows : rows - 1, 40.0, unsigned(rows));
        Cholesky factor;
        BOOST_REQUIRE(factor.factor(random.diagonal, random.below));
        Eigen::VectorXd b = Eigen::VectorXd::LinSpaced(3 * rows, -1.0, 2.0);
        std::vector<Cholesky::Segment> x(rows);
        for (int k = 0; k < rows; ++k) x[k] = b.segment<3>(3 * k);
        factor.solve(x.data());
        const Eigen::VectorXd expected = random.dense.ldlt().solve(b);
        for (int k = 0; k < rows; ++k) BOOST_TEST((x[k] - expected.segment<3>(3 * k)).norm() < 1e-13);
    }
}

BOOST_AUTO_TEST_CASE(refuses_a_matrix_that_is_not_positive_definite) {
    const SparseSystem random = random_matrix(20, 40, 0.1, 3);
    BOOST_TEST(Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(random.dense).eigenvalues()[0] < 0.0);
    Cholesky factor;
    BOOST_TEST(!factor.factor(random.diagonal, random.below));
}

BOOST_AUTO_TEST_CASE(a_chain_has_no_fill_in) {
    std::vector<Cholesky::Entry> below;
    for (int k = 1; k < 30; ++k) below.push_back({{k, k - 1}, Cholesky::Block::Identity()});
    Cholesky factor;
    BOOST_TEST(factor.factor(std::vector<Cholesky::Block>(30, 3.0 * Cholesky::Block::Identity()), below));
    BOOST_TEST(factor.entries() == 29);
}

BOOST_AUTO_TEST_SUITE_END()
