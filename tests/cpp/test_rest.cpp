// Rest shapes and their correction for resolution.
#include "ringlet/geometry/frames.h"
#include "ringlet/rest/resolution.h"
#include "ringlet/rest/rest_shape.h"

#include <boost/test/unit_test.hpp>
#include <cmath>
#include <numbers>
#include <vector>

using namespace ringlet;

namespace {

std::vector<Vec3> helix(int points, int per_turn, double radius, double pitch) {
    std::vector<Vec3> x;
    for (int i = 0; i < points; ++i) {
        const double turn = 2 * std::numbers::pi * i / per_turn;
        x.emplace_back(radius * std::cos(turn), radius * std::sin(turn), pitch * turn / (2 * std::numbers::pi));
    }
    return x;
}

ResolutionFactors factors_of_helix(int per_turn) {
    const std::vector<Vec3> x = helix(8, per_turn, 5e-3, 4e-3);
    const std::vector<int> offsets{0, 8};
    const RestShape rest = measure_rest_shape(offsets, x);
    return resolution_factors(rest.angle[3], rest.dihedral[3]);
}

} // namespace

BOOST_AUTO_TEST_SUITE(rest)

BOOST_AUTO_TEST_CASE(a_helix_has_the_same_strains_everywhere) {
    const std::vector<Vec3> x = helix(20, 12, 5e-3, 4e-3);
    const std::vector<int> offsets{0, 20};
    const RestShape rest = measure_rest_shape(offsets, x);
    for (int i = 2; i < 17; ++i) {
        BOOST_TEST(std::abs(rest.length[i] - rest.length[1]) < 1e-15);
        BOOST_TEST(std::abs(rest.angle[i] - rest.angle[1]) < 1e-12);
        BOOST_TEST(std::abs(rest.dihedral[i] - rest.dihedral[1]) < 1e-12);
    }
}

BOOST_AUTO_TEST_CASE(transport_is_the_least_rotation) {
    const Vec3 a(1.0, 2.0, -0.5), v(0.3, -0.2, 0.7);
    for (const Vec3 &b : {Vec3(0.5, -1.0, 2.0), Vec3(2.0 * a), Vec3(-3.0 * a), Vec3(-a + Vec3(0.1, 0.0, 0.0))}) {
        BOOST_TEST((transport(a.normalized(), a, b) - b.normalized()).norm() < 1e-9);
        BOOST_TEST(std::abs(transport(v, a, b).norm() - v.norm()) < 1e-12);
        const Vec3 axis = a.cross(b);
        BOOST_TEST((transport(axis, a, b) - axis).norm() < 1e-9 * (1.0 + axis.norm()));
    }
}

BOOST_AUTO_TEST_CASE(unused_rows_are_zero) {
    const std::vector<Vec3> x = helix(10, 12, 5e-3, 4e-3);
    const std::vector<int> offsets{0, 5, 10};
    const RestShape rest = measure_rest_shape(offsets, x);
    for (const int end : {4, 9}) BOOST_TEST(rest.length[end] == 0);
    for (const int end : {0, 4, 5, 9}) BOOST_TEST(rest.angle[end] == 0);
    for (const int end : {0, 3, 4, 5, 8, 9}) BOOST_TEST(rest.dihedral[end] == 0);
}

BOOST_AUTO_TEST_CASE(correction_vanishes_as_a_coil_is_refined) {
    double before = 1;
    for (const int per_turn : {12, 24, 48, 96}) {
        const ResolutionFactors f = factors_of_helix(per_turn);
        const double away = std::abs(f.bend - 1) + std::abs(f.twist - 1) + std::abs(f.mass - 1);
        BOOST_TEST(away < before / 3); // second order: a quarter at each doubling
        before = away;
    }
}

BOOST_AUTO_TEST_CASE(mass_factor_is_arc_over_chord) {
    const int per_turn = 12;
    const double arc = std::hypot(2 * std::numbers::pi * 5e-3, 4e-3) / per_turn;
    const std::vector<Vec3> x = helix(2, per_turn, 5e-3, 4e-3);
    BOOST_TEST(std::abs(factors_of_helix(per_turn).mass - arc / (x[1] - x[0]).norm()) < 1e-9);
}

BOOST_AUTO_TEST_CASE(a_straight_edge_is_not_corrected) {
    const ResolutionFactors f = resolution_factors(1e-5, 0.3);
    BOOST_TEST(f.bend == 1);
    BOOST_TEST(f.twist == 1);
    BOOST_TEST(f.mass == 1);
}

BOOST_AUTO_TEST_SUITE_END()
