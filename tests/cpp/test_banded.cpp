// Banded factorisation, against a dense solver.
#include "ringlet/linear/banded.h"

#include <Eigen/Dense>
#include <boost/test/unit_test.hpp>
#include <random>
#include <tuple>
#include <vector>

using namespace ringlet::baseline;

namespace {

// Random positive definite matrix that fills the band: a diagonal, and two random squares u uᵀ of `band` entries per block.
template <int block, int band> struct BandedSystem {
    using Matrix = Banded<double, block, band>;

    explicit BandedSystem(int vertices) : memory(Matrix::entries(block * vertices)), matrix(memory.data(), block * vertices) {
        const int size = block * vertices;
        std::mt19937 random(7);
        std::normal_distribution<double> normal;
        matrix.set_zero();
        dense = Eigen::MatrixXd::Zero(size, size);
        for (int i = 0; i < size; ++i) {
            matrix.entry(i)[0] += 0.1;
            dense(i, i) += 0.1;
        }
        for (int first = 0; first + band <= size; first += block) {
            double u[2][band];
            for (auto &one : u) {
                Eigen::VectorXd v = Eigen::VectorXd::Zero(size);
                for (int k = 0; k < band; ++k) v[first + k] = one[k] = normal(random);
                dense += 2.5 * v * v.transpose();
            }
            matrix.add_squares(first, 2.5, u);
        }
    }
    std::vector<double> memory;
    Matrix matrix;
    Eigen::MatrixXd dense;
};

using Systems = std::tuple<BandedSystem<3, 12>, BandedSystem<4, 11>>; // hinges; material frames

} // namespace

BOOST_AUTO_TEST_SUITE(banded)

BOOST_AUTO_TEST_CASE_TEMPLATE(solution_agrees_with_a_dense_solver, System, Systems) {
    System system(17);
    const int size = int(system.dense.rows());
    const Eigen::VectorXd b = Eigen::VectorXd::LinSpaced(size, -1, 2);
    std::vector<double> x(b.data(), b.data() + size);
    x.resize(size + System::Matrix::padding);
    system.matrix.factor();
    system.matrix.solve(x.data());
    const Eigen::VectorXd expected = system.dense.ldlt().solve(b);
    const Eigen::Map<Eigen::VectorXd> got(x.data(), size);
    BOOST_TEST((got - expected).norm() < 1e-11 * expected.norm());
}

BOOST_AUTO_TEST_CASE_TEMPLATE(entries_are_those_of_the_dense_matrix, System, Systems) {
    System system(9);
    const int size = int(system.dense.rows());
    Eigen::MatrixXd lower = Eigen::MatrixXd::Zero(size, size);
    for (int c = 0; c < size; ++c)
        for (int k = 0; k < System::Matrix::rows(c) && c + k < size; ++k) lower(c + k, c) = system.matrix.entry(c)[k];
    const Eigen::MatrixXd expected = system.dense.template triangularView<Eigen::Lower>();
    BOOST_TEST((lower - expected).norm() < 1e-14 * expected.norm());
}

// Longer than the window, with what makes it indefinite anywhere; part of that is added to the test alone.
BOOST_AUTO_TEST_CASE_TEMPLATE(definiteness_is_that_of_the_whole_matrix, System, Systems) {
    using Matrix = typename System::Matrix;
    constexpr int vertices = 31, block = Matrix::layout.block;
    for (int at = -1; at < vertices; ++at) {
        System system(vertices);
        const int column = block * at + 1;
        if (at >= 0) system.matrix.entry(column)[0] -= 0.5 * system.dense(column, column);
        for (const double part : {0.2, 0.8}) {
            DefinitenessTest<Matrix, double> test;
            for (int i = 0; i < vertices; ++i) {
                if (i == at) test.entry(column)[0] -= part * system.dense(column, column);
                test.complete(system.matrix.entry(block * i));
            }
            Eigen::MatrixXd dense = system.dense;
            if (at >= 0) dense(column, column) *= 0.5 - part;
            BOOST_TEST(test.definite() == double(dense.llt().info() == Eigen::Success));
            if (part > 0.5) BOOST_TEST(test.definite() == double(at < 0));
        }
    }
}

BOOST_AUTO_TEST_SUITE_END()
