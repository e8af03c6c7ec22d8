// Moves with kinematic bodies whose impacts are resolved by zones that share one motion.
#include "crowd.h"

#include <boost/test/unit_test.hpp>

using namespace ringlet;

BOOST_AUTO_TEST_SUITE(impact_zones)

BOOST_AUTO_TEST_CASE(a_resolved_move_keeps_every_minimum_separation) {
    int violations = 0;
    for (unsigned seed = 0; seed < 20; ++seed) {
        const Crowd crowd(12, 0.02, 0.03, seed);
        if (crowd.closest(crowd.start) < 1e-5) continue;
        std::vector<Vec3> resolved;
        const CcdReport report = crowd.resolve(resolved);
        violations += report.impacts;
        BOOST_TEST(crowd.closest(resolved) > 1e-6);
        BOOST_TEST(crowd.least_separation(resolved) > 1.0 - 1e-9);
    }
    BOOST_TEST(violations > 50);
}

BOOST_AUTO_TEST_CASE(only_relative_motion_is_resolved) {
    Crowd crowd(12, 0.02, 0.03, 5);
    std::vector<Vec3> resolved, resolved_flying;
    const CcdReport report = crowd.resolve(resolved);
    const Vec3 flight(100.0 / 24, 0.0, 0.0);
    for (Vec3 &place : crowd.end) place += flight;
    const CcdReport flying = crowd.resolve(resolved_flying);
    BOOST_TEST(report.impacts > 0);
    BOOST_TEST(report.impacts == flying.impacts);
    for (size_t v = 0; v < resolved.size(); ++v) BOOST_TEST((resolved_flying[v] - flight - resolved[v]).norm() < 1e-8);
}

BOOST_AUTO_TEST_CASE(a_zone_moves_with_the_body_that_it_touches) {
    Crowd crowd(2, 0.02, 0.0, 0);
    for (int v = 0; v < 6; ++v) { // a moving strand above a kinematic one that rises by 5 mm
        const bool body = v < 3;
        crowd.start[v] = crowd.mesh.rest[v] = Vec3(0.01 * (v % 3), body ? 0.0 : 3e-3, 0.0);
        crowd.end[v] = crowd.start[v] + Vec3(0.0, body ? 5e-3 : 0.0, 0.0);
        crowd.mesh.moves[v] = !body;
    }
    std::vector<Vec3> resolved = crowd.end;
    Crowd::Found found(crowd.mesh, {crowd.start, crowd.start});
    const auto advect = [](int, const Vec3 &point) { return Vec3(point + Vec3(0.0, 5e-3, 0.0)); };
    AdvectedMove move(found.pairs, crowd.start, resolved);
    BOOST_TEST(!move.impacts().empty());
    resolve_impact_zones({View<double>(crowd.mass), advect}, move);
    BOOST_TEST(move.impacts().empty());
    BOOST_TEST(!crowd.has_impacts(resolved));
    for (int v = 3; v < 6; ++v) {
        BOOST_TEST(resolved[v].y() > 5e-3); // it is pushed by no more than the body moves
        BOOST_TEST(resolved[v].y() <= 8e-3 + 1e-12);
    }
}

BOOST_AUTO_TEST_SUITE_END()
