// The banded factor, against a dense solver.
#include "ringlet/linear/banded.h"

#include <Eigen/Dense>
#include <boost/test/unit_test.hpp>
#include <random>
#include <vector>

using namespace ringlet::baseline;

namespace {

using Matrix = Banded<double, 3, 12>;

// Random squares over four consecutive vertices plus a diagonal: positive definite and as dense as the band allows.
struct RandomSystem {
    explicit RandomSystem(int vertices) : memory(Matrix::entries(3 * vertices)), band(memory.data(), 3 * vertices) {
        std::mt19937 random(7);
        std::normal_distribution<double> normal;
        band.set_zero();
        dense = Eigen::MatrixXd::Zero(3 * vertices, 3 * vertices);
        for (int i = 0; i < 3 * vertices; ++i) {
            band.entry(i)[0] += 0.1;
            dense(i, i) += 0.1;
        }
        for (int i = 0; i + 3 < vertices; ++i) {
            double u[12];
            Eigen::VectorXd v = Eigen::VectorXd::Zero(3 * vertices);
            for (int k = 0; k < 12; ++k) v[3 * i + k] = u[k] = normal(random);
            band.add_square(3 * i, 2.5, u);
            dense += 2.5 * v * v.transpose();
        }
    }
    std::vector<double> memory;
    Matrix band;
    Eigen::MatrixXd dense;
};

} // namespace

BOOST_AUTO_TEST_SUITE(banded)

BOOST_AUTO_TEST_CASE(solution_agrees_with_a_dense_solver) {
    const int vertices = 17;
    RandomSystem system(vertices);
    const Eigen::VectorXd b = Eigen::VectorXd::LinSpaced(3 * vertices, -1, 2);
    std::vector<double> x(b.data(), b.data() + b.size());
    x.resize(b.size() + Matrix::padding);
    system.band.factor();
    system.band.solve(x.data());
    const Eigen::VectorXd expected = system.dense.ldlt().solve(b);
    const Eigen::Map<Eigen::VectorXd> got(x.data(), b.size());
    BOOST_TEST((got - expected).norm() < 1e-11 * expected.norm());
}

BOOST_AUTO_TEST_SUITE_END()
