// Armijo's condition on functions of one variable.
#include "ringlet/dynamics/armijo.h"

#include <boost/test/unit_test.hpp>
#include <limits>

using namespace ringlet::baseline;

namespace {

// From 1 along −1, on ½ x²: energy ½, slope −1.
bool accepts(double step) {
    const double end = 1.0 - step;
    return sufficient_decrease(0.5 * end * end, 0.5, -1.0, step);
}

} // namespace

BOOST_AUTO_TEST_SUITE(armijo)

BOOST_AUTO_TEST_CASE(newtons_step_on_a_parabola_is_accepted) {
    BOOST_TEST(accepts(1.0));
    BOOST_TEST(accepts(1e-6));
}

BOOST_AUTO_TEST_CASE(a_step_across_the_valley_is_refused_before_the_energy_is_the_same) {
    BOOST_TEST(accepts(1.999));
    BOOST_TEST(!accepts(2.0)); // the same energy is no decrease
    BOOST_TEST(!accepts(2.1));
}

BOOST_AUTO_TEST_CASE(an_increase_within_rounding_is_accepted) {
    BOOST_TEST(sufficient_decrease(1.0 + 5e-15, 1.0, 0.0, 1.0));
    BOOST_TEST(sufficient_decrease(-1.0 + 5e-15, -1.0, 0.0, 1.0));
    BOOST_TEST(!sufficient_decrease(1.0 + 5e-14, 1.0, 0.0, 1.0));
    BOOST_TEST(sufficient_decrease(1.0 + 5e-14, 1.0, 0.0, 1.0, {.least_decrease = 1e-4, .rounding = 1e-13}));
}

BOOST_AUTO_TEST_CASE(an_energy_that_is_not_a_number_is_refused) {
    BOOST_TEST(!sufficient_decrease(std::numeric_limits<double>::quiet_NaN(), 1.0, -1.0, 1.0));
}

BOOST_AUTO_TEST_CASE(lanes_are_judged_one_by_one) {
    Pack trial = constant<Pack>(0.4);
    set_lane(trial, 1, 0.6);
    const Mask accepted = sufficient_decrease(trial, constant<Pack>(0.5), constant<Pack>(-1.0), constant<Pack>(1.0));
    BOOST_TEST(accepted[0] != 0);
    BOOST_TEST(accepted[1] == 0);
}

BOOST_AUTO_TEST_SUITE_END()
