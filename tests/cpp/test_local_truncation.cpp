// Moves that are truncated only where they have impacts.
#include "crowd.h"

#include <boost/test/unit_test.hpp>

using namespace ringlet;

BOOST_AUTO_TEST_SUITE(local_truncation)

BOOST_AUTO_TEST_CASE(a_truncated_move_keeps_every_minimum_separation_and_all_that_has_no_impact) {
    for (unsigned seed = 0; seed < 20; ++seed) {
        const Crowd crowd(12, 0.02, 0.03, seed);
        if (crowd.closest(crowd.start) < 1e-5) continue;
        std::vector<Vec3> end = crowd.end;
        Crowd::Found found(crowd.mesh, {crowd.start, crowd.start});
        AdvectedMove move(found.pairs, crowd.start, end);
        truncate_locally(move);
        BOOST_TEST(move.impacts().empty());
        BOOST_TEST(crowd.least_separation(end) > 1.0 - 1e-9);
        BOOST_TEST(!crowd.has_impacts(end));
    }
}

BOOST_AUTO_TEST_CASE(strands_without_impacts_keep_every_bit_of_their_move) {
    Crowd crowd(16, 0.02, 0.03, 3);
    for (size_t v = 0; v < crowd.start.size(); ++v) // the last eight are far away
        if (crowd.mesh.object[v] >= 8) crowd.start[v].x() += 1.0, crowd.end[v] = crowd.start[v] + Vec3(0.01, 0.02, 0.0);
    std::vector<Vec3> end = crowd.end;
    Crowd::Found found(crowd.mesh, {crowd.start, crowd.start});
    AdvectedMove move(found.pairs, crowd.start, end);
    BOOST_TEST(!move.impacts().empty());
    truncate_locally(move);
    for (size_t v = 0; v < end.size(); ++v)
        if (crowd.mesh.object[v] >= 8) BOOST_TEST(end[v] == crowd.end[v]);
}

BOOST_AUTO_TEST_CASE(a_whole_object_keeps_one_fraction_of_its_move) {
    Crowd crowd(2, 0.02, 0.0, 0);
    for (int v = 0; v < 6; ++v) { // a strand that rests above a kinematic one that rises by 5 mm, and by 6 mm at its end
        const bool body = v < 3;
        crowd.start[v] = crowd.mesh.rest[v] = Vec3(0.01 * (v % 3), body ? 0.0 : 3e-3, body ? 0.0 : 0.02 * (v - 3) - 0.01);
        crowd.end[v] = crowd.start[v] + Vec3(0.0, body ? 5e-3 + 5e-4 * v : 0.0, 0.0);
        crowd.mesh.moves[v] = !body;
    }
    for (const bool whole : {false, true}) {
        std::vector<Vec3> end = crowd.end;
        Crowd::Found found(crowd.mesh, {crowd.start, crowd.start});
        AdvectedMove move(found.pairs, crowd.start, end);
        BOOST_TEST(!move.impacts().empty());
        truncate_locally(move, std::vector<unsigned char>{whole, 0});
        BOOST_TEST(!crowd.has_impacts(end));
        const auto fraction = [&](int v) { return (end[v] - crowd.start[v]).norm() / (crowd.end[v] - crowd.start[v]).norm(); };
        BOOST_TEST(fraction(0) < 1.0);
        if (whole) {
            BOOST_TEST(fraction(1) == fraction(0), boost::test_tools::tolerance(1e-12));
            BOOST_TEST(fraction(2) == fraction(0), boost::test_tools::tolerance(1e-12));
        }
    }
}

BOOST_AUTO_TEST_SUITE_END()
