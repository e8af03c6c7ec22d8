// Arithmetic of the kernels, against the standard library and geometric identities.
#include "ringlet/math/pack.h"

#include <boost/test/unit_test.hpp>
#include <cmath>
#include <random>

using namespace ringlet::baseline;

BOOST_AUTO_TEST_SUITE(pack)

BOOST_AUTO_TEST_CASE(atan2_agrees_with_the_standard_library_in_all_quadrants) {
    std::mt19937 random(1);
    std::uniform_real_distribution<double> exponent(-12, 12), sign(-1, 1);
    for (int trial = 0; trial < 100000; ++trial) {
        const double y = std::copysign(std::pow(10, exponent(random)), sign(random));
        const double x = std::copysign(std::pow(10, exponent(random)), sign(random));
        BOOST_REQUIRE_SMALL(ringlet::baseline::atan2(y, x) / std::atan2(y, x) - 1, 1e-15);
    }
    BOOST_TEST(ringlet::baseline::atan2(0.0, 0.0) == 0.0);
    BOOST_TEST(ringlet::baseline::atan2(0.0, -1.0) == pi);
}

BOOST_AUTO_TEST_CASE(a_lane_of_a_pack_computes_what_a_double_does) {
    Pack y{}, x{};
    for (int k = 0; k < lanes; ++k) {
        set_lane(y, k, 0.3 - 0.7 * k);
        set_lane(x, k, 0.2 * k - 0.1);
    }
    const Pack angle = ringlet::baseline::atan2(y, x);
    for (int k = 0; k < lanes; ++k) BOOST_TEST(angle[k] == ringlet::baseline::atan2(lane(y, k), lane(x, k)));
}

BOOST_AUTO_TEST_CASE(wrap_removes_whole_turns) {
    for (const double turns : {-3.0, -1.0, 0.0, 1.0, 2.0})
        for (const double angle : {-3.1, -1.0, 0.0, 0.5, 3.1})
            BOOST_TEST(std::abs(wrap(angle + 2 * pi * turns) - angle) < 1e-14);
}

BOOST_AUTO_TEST_CASE(transport_is_a_rotation_that_takes_one_tangent_to_the_other) {
    std::mt19937 random(2);
    std::normal_distribution<double> normal;
    const auto unit = [&] {
        const Vec<double> v{normal(random), normal(random), normal(random)};
        return (1 / norm(v)) * v;
    };
    for (int trial = 0; trial < 1000; ++trial) {
        const Vec<double> a = unit(), b = unit(), v = unit(), w = unit();
        if (dot(a, b) < -0.99) continue; // the rotation is not unique there
        BOOST_TEST(norm(transport(a, a, b) - b) < 1e-12);
        BOOST_TEST(std::abs(dot(transport(v, a, b), transport(w, a, b)) - dot(v, w)) < 1e-12);
    }
}

BOOST_AUTO_TEST_CASE(perpendicular_is_perpendicular_to_every_axis) {
    for (const Vec<double> t : {Vec<double>{1, 0, 0}, Vec<double>{0, 1, 0}, Vec<double>{0, 0, -1}, Vec<double>{0.6, 0.8, 0}}) {
        BOOST_TEST(std::abs(dot(perpendicular(t), t)) < 1e-15);
        BOOST_TEST(std::abs(norm(perpendicular(t)) - 1) < 1e-15);
    }
}

BOOST_AUTO_TEST_SUITE_END()
