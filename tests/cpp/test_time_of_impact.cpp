// Times of impact against sampled distances.
#include "degenerate_primitives.h"
#include "ringlet/ccd/time_of_impact.h"

#include <boost/test/unit_test.hpp>

using namespace ringlet;

namespace {

double toi(bool edges, const Four &x, const Four &p, double min_separation) {
    return edges ? accd::toi<2>(x.data(), p.data(), min_separation, accd::closest<2>(x.data()))
                 : accd::toi<1>(x.data(), p.data(), min_separation, accd::closest<1>(x.data()));
}

Four at(const Four &x, const Four &p, double t) { return {x[0] + t * p[0], x[1] + t * p[1], x[2] + t * p[2], x[3] + t * p[3]}; }

} // namespace

BOOST_AUTO_TEST_SUITE(time_of_impact)

BOOST_AUTO_TEST_CASE(until_the_time_of_impact_a_pair_keeps_its_minimum_separation) {
    std::mt19937 random(3);
    std::uniform_real_distribution<double> in(0.0, 1.0);
    int impacts = 0;
    for (int i = 0; i < 200 * kinds; ++i)
        for (bool edges : {true, false}) {
            const Four x = hard(random, i % kinds), p = hard(random, (i / kinds) % kinds);
            const double first = distance(edges, x), separation = 0.5 * in(random) * first;
            const double t = toi(edges, x, p, separation);
            BOOST_TEST((t == no_impact || (t >= 0.0 && t <= 1.0)));
            impacts += t <= 1.0;
            double nearest = first;
            for (int k = 0; k <= 200; ++k) nearest = std::min(nearest, distance(edges, at(x, p, std::min(t, 1.0) * k / 200.0)));
            BOOST_TEST(nearest >= separation - 1e-14);
            if (t <= 1.0 && first > 1e-6) { // and it ends close to what has to be separation, not long before
                BOOST_TEST(distance(edges, at(x, p, t)) <= separation + 0.0101 * (first - separation));
            }
        }
    BOOST_TEST(impacts > 200);
}

BOOST_AUTO_TEST_CASE(a_head_on_impact_happens_when_the_gap_is_used_up) {
    const Four edges = {Vec3(-1, 0, 1), Vec3(1, 0, 1), Vec3(0, -1, 0), Vec3(0, 1, 0)};
    const Four triangle = {Vec3(0, 0, 1), Vec3(-1, -1, 0), Vec3(1, -1, 0), Vec3(0, 1, 0)};
    const Vec3 down(0, 0, -2), none = Vec3::Zero();
    const double expected = (1.0 - 0.2) / 2.0; // from a distance of 1 to 0.2 at a speed of 2
    for (double t : {toi(true, edges, {down, down, none, none}, 0.2), toi(false, triangle, {down, none, none, none}, 0.2)}) {
        BOOST_TEST(t <= expected);
        BOOST_TEST(t >= 0.99 * expected);
    }
}

// Far away positions round to 10⁻¹³ m, so that each place has its own last bits.
BOOST_AUTO_TEST_CASE(rounding_changes_the_time_of_impact_by_no_more_than_itself) {
    const Four edges = {Vec3(-1, 0, 1), Vec3(1, 0, 1), Vec3(0, -1, 0), Vec3(0, 1, 0)};
    const Vec3 down(0, 0, -2), none = Vec3::Zero();
    double first = 1.0, last = 0.0;
    for (int k = 0; k < 100; ++k) {
        Four x = edges;
        for (Vec3 &at : x) at += Vec3(10.0 * k, 7.0 * k, 3.3 * k);
        const double t = toi(true, x, {down, down, none, none}, 0.2);
        first = std::min(first, t), last = std::max(last, t);
    }
    BOOST_TEST(last - first < 1e-11);
}

BOOST_AUTO_TEST_CASE(sliding_past_and_separating_and_resting_pairs_have_no_impact) {
    const Four x = {Vec3(-1, 0, 1e-6), Vec3(1, 0, 1e-6), Vec3(0, -1, 0), Vec3(0, 1, 0)};
    const Vec3 along(50, 30, 0), up(0, 0, 3), none = Vec3::Zero();
    BOOST_TEST(toi(true, x, {along, along, none, none}, 0.9e-6) == no_impact);
    BOOST_TEST(toi(true, x, {up, up, none, none}, 0.9e-6) == no_impact);
    BOOST_TEST(toi(true, x, {none, none, none, none}, 1.0) == no_impact);
    BOOST_TEST(toi(true, x, {up, up, up, up}, 1.0) == no_impact);
}

BOOST_AUTO_TEST_CASE(a_pair_without_gap_or_with_invalid_positions_has_time_of_impact_0) {
    const Four cross = {Vec3(-1, 0, 0), Vec3(1, 0, 0), Vec3(0, -1, 0), Vec3(0, 1, 0)};
    const Vec3 down(0, 0, -1), none = Vec3::Zero();
    BOOST_TEST(toi(true, cross, {down, down, none, none}, 0.0) == 0.0);
    const double nan = std::nan(""), infinity = std::numeric_limits<double>::infinity();
    for (double bad : {nan, infinity})
        for (bool edges : {true, false}) {
            BOOST_TEST(toi(edges, {Vec3(bad, 0, 0), Vec3(1, 0, 1), none, down}, {down, none, none, none}, 0.0) == 0.0);
            BOOST_TEST(toi(edges, {Vec3(1, 0, 0), Vec3(1, 0, 1), none, down}, {Vec3(bad, 0, 0), none, none, none}, 0.0) == 0.0);
        }
}

// At 100 m/s for a film frame: 4 m, ten thousand times the distances between hairs.
BOOST_AUTO_TEST_CASE(a_shared_motion_changes_no_time_of_impact) {
    std::mt19937 random(4);
    const Vec3 flight = Vec3(60.0, 0.0, 80.0) / 24.0;
    for (int i = 0; i < 200 * kinds; ++i)
        for (bool edges : {true, false}) {
            Four x = hard(random, i % kinds), p = hard(random, kinds - 1), flying;
            for (int k = 0; k < 4; ++k) {
                x[k] *= 1e-3;
                p[k] *= 1e-3;
                flying[k] = p[k] + flight;
            }
            const double separation = 0.1 * distance(edges, x);
            if (separation < 1e-8) continue; // touching: rounding decides
            const double t = toi(edges, x, p, separation), moving = toi(edges, x, flying, separation);
            BOOST_TEST((t == moving || std::abs(t - moving) < 1e-6));
        }
}

BOOST_AUTO_TEST_SUITE_END()
