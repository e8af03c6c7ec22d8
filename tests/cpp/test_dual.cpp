// Dual numbers: derivatives of a formula against central differences.
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

BOOST_AUTO_TEST_CASE(derivatives_agree_with_central_differences) {
    std::mt19937 random(5);
    for (int round = 0; round < 20; ++round) {
        const VectorXd at = ringlet::random_vector(Dual::variables, random);
        Dual x[Dual::variables];
        for (int k = 0; k < Dual::variables; ++k) x[k] = dual_variable(at[k], k);
        const Dual found = formula(x);
        const VectorXd by = ringlet::differences([](const VectorXd &p) { return formula(p.data()); }, at, 1e-6);
        BOOST_TEST(found.value == formula(at.data()));
        for (int k = 0; k < Dual::variables; ++k)
            BOOST_TEST(std::abs(found.by[k] - by[k]) < 1e-6 * (1 + by.cwiseAbs().maxCoeff()));
    }
}

BOOST_AUTO_TEST_CASE(the_derivative_is_zero_where_it_does_not_exist) {
    const Dual zero = dual_variable(0.0, 3);
    BOOST_TEST(ringlet::baseline::sqrt(zero).by[3] == 0.0);
    BOOST_TEST(ringlet::baseline::atan2(zero, zero).by[3] == 0.0);
}

BOOST_AUTO_TEST_SUITE_END()
