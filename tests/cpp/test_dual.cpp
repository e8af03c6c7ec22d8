// Dual numbers: the derivatives of a formula, against differences.
#include "differences.h"
#include "ringlet/math/dual.h"

#include <boost/test/unit_test.hpp>

using Eigen::VectorXd;

namespace ringlet::baseline {

template <class T> T formula(const T *x) {
    const Vec<T> a{x[0], x[1], x[2]}, b{x[3], x[4], x[5]};
    const T angle = atan2(norm(cross(a, b)), dot(a, b)), least = max(x[6], 0.5 - x[7] * x[7]);
    return sqrt(2.0 + dot(a, a)) / (1.5 - angle) + abs(-x[7]) * least - (3.0 / (4.0 + x[6] * x[6]) - 0.1 * x[2]);
}

} // namespace ringlet::baseline

using namespace ringlet::baseline;

BOOST_AUTO_TEST_SUITE(dual)

BOOST_AUTO_TEST_CASE(derivatives_are_those_of_differences) {
    std::mt19937 random(5);
    for (int round = 0; round < 20; ++round) {
        const VectorXd at = ringlet::random_vector(Dual::unknowns, random);
        Dual x[Dual::unknowns];
        for (int k = 0; k < Dual::unknowns; ++k) x[k] = unknown(at[k], k);
        const Dual found = formula(x);
        const VectorXd by = ringlet::differences([](const VectorXd &p) { return formula(p.data()); }, at, 1e-6);
        BOOST_TEST(found.value == formula(at.data()));
        for (int k = 0; k < Dual::unknowns; ++k)
            BOOST_TEST(std::abs(found.by[k] - by[k]) < 1e-6 * (1 + by.cwiseAbs().maxCoeff()));
    }
}

BOOST_AUTO_TEST_CASE(where_there_is_no_derivative_it_is_zero) {
    const Dual zero = unknown(0.0, 3);
    BOOST_TEST(ringlet::baseline::sqrt(zero).by[3] == 0.0);
    BOOST_TEST(ringlet::baseline::atan2(zero, zero).by[3] == 0.0);
}

BOOST_AUTO_TEST_SUITE_END()
