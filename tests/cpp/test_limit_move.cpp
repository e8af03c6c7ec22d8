// Moves that are limited so that nothing has an impact.
#include "crowd.h"

#include <boost/test/unit_test.hpp>
#include <omp.h>

using namespace ringlet;

BOOST_AUTO_TEST_SUITE(move_limits)

BOOST_AUTO_TEST_CASE(a_limited_move_keeps_every_minimum_separation) {
    int violations = 0;
    for (unsigned seed = 0; seed < 20; ++seed) {
        const Crowd crowd(12, 0.02, 0.03, seed);
        if (crowd.closest(crowd.start) < 1e-5) continue;
        std::vector<Vec3> limited;
        const CcdReport report = crowd.limit(limited);
        violations += report.impacts;
        BOOST_TEST(crowd.closest(limited) > 1e-6);
        BOOST_TEST(crowd.least_separation(limited) > 1.0 - 1e-9);
    }
    BOOST_TEST(violations > 50);
}

// Some are corrected locally and scaled as a whole for others: their impacts are checked again.
BOOST_AUTO_TEST_CASE(long_strands_that_obstruct_each_other_everywhere_have_no_impact) {
    int violations = 0;
    for (unsigned seed = 0; seed < 200; ++seed) {
        const Crowd crowd(60, 0.02, 0.01, seed, 30);
        std::vector<Vec3> limited;
        violations += crowd.limit(limited).impacts;
        BOOST_TEST(!crowd.has_impacts(limited), "crowd " << seed);
    }
    BOOST_TEST(violations > 10000);
}

BOOST_AUTO_TEST_CASE(strands_that_yield_as_a_whole_keep_their_shape_and_have_no_impact) {
    int violations = 0;
    for (unsigned seed = 0; seed < 200; ++seed) {
        const Crowd crowd(60, 0.02, 0.01, seed, 30);
        std::vector<Vec3> limited;
        violations += crowd.limit(limited, Yield::as_a_whole, 0.1).impacts;
        BOOST_TEST(crowd.change_of_shape(limited) < 1e-12);
        BOOST_TEST(!crowd.has_impacts(limited), "crowd " << seed);
        violations += crowd.limit(limited, Yield::as_a_whole).impacts;
        BOOST_TEST(crowd.change_of_shape(limited) < 1e-12);
        BOOST_TEST(!crowd.has_impacts(limited), "crowd " << seed << ", where vertices escape their bounds");
    }
    BOOST_TEST(violations > 10000);
}

BOOST_AUTO_TEST_CASE(strands_that_are_shortened_further_have_no_impact_either) {
    for (const Yield yield : {Yield::near_impacts, Yield::as_a_whole}) {
        int violations = 0;
        for (unsigned seed = 0; seed < 50; ++seed) {
            const Crowd crowd(60, 0.02, 0.01, seed, 30);
            std::vector<Vec3> limited;
            violations += crowd.limit_and_shorten(limited, yield).impacts;
            BOOST_TEST(!crowd.has_impacts(limited), "crowd " << seed);
        }
        BOOST_TEST(violations > 100);
    }
}

BOOST_AUTO_TEST_CASE(a_limited_move_is_the_same_for_any_number_of_threads) {
    const Crowd crowd(400, 0.02, 0.03, 11);
    const auto limited_by = [&](int threads, Yield yield) {
        omp_set_num_threads(threads);
        std::vector<Vec3> limited;
        crowd.limit(limited, yield);
        return limited;
    };
    const int threads = omp_get_max_threads();
    for (const Yield yield : {Yield::near_impacts, Yield::as_a_whole}) {
        const std::vector<Vec3> expected = limited_by(1, yield);
        BOOST_TEST((expected != crowd.end));
        for (int run = 0; run < 5; ++run) BOOST_TEST((limited_by(4, yield) == expected));
    }
    omp_set_num_threads(threads);
}

BOOST_AUTO_TEST_CASE(a_move_without_impacts_is_left_alone) {
    const Crowd crowd(1, 0.02, 0.03, 3);
    std::vector<Vec3> limited;
    BOOST_TEST(crowd.limit(limited).impacts == 0);
    BOOST_TEST((limited == crowd.end));
}

// Strands in a row, 4 mm apart, are drawn together towards the first, which stays: each obstructs the next.
BOOST_AUTO_TEST_CASE(each_strand_of_a_chain_stops_at_the_one_before) {
    constexpr int strands = 20;
    Crowd crowd(strands, 0.02, 0.03, 0);
    for (int v = 0; v < 3 * strands; ++v) {
        const int strand = v / 3;
        crowd.start[v] = crowd.mesh.rest[v] = {4e-3 * strand, 0.01 * (v % 3), 1e-4 * strand};
        crowd.end[v] = crowd.start[v] - Vec3(4.5e-3 * strand, 0.0, 0.0);
    }
    std::vector<Vec3> limited;
    const CcdReport report = crowd.limit(limited);
    BOOST_TEST(report.impacts >= strands - 1);
    BOOST_TEST(report.fraction == 1.0);
    BOOST_TEST(crowd.least_separation(limited) > 1.0 - 1e-9);
    double last = 0.0;
    for (int strand = 1; strand < strands; ++strand) { // each as a whole, up to the one before
        const int first = 3 * strand;
        const double fraction = (limited[first] - crowd.start[first]).norm() / (4.5e-3 * strand);
        BOOST_TEST(fraction > 0.6);
        BOOST_TEST(fraction > last - 1e-12);
        for (int v = first; v < first + 3; ++v)
            BOOST_TEST((limited[v] - crowd.start[v] - fraction * (crowd.end[v] - crowd.start[v])).norm() < 1e-12);
        last = fraction;
    }
}

// A strand that can hardly move stops those behind it only just before they reach it.
BOOST_AUTO_TEST_CASE(a_strand_goes_up_to_one_that_has_stopped) {
    constexpr int strands = 3;
    constexpr double spacing = 6e-3;
    Crowd crowd(strands, 0.02, 0.03, 0);
    for (int v = 0; v < 3 * strands; ++v) {
        const int strand = v / 3;
        crowd.start[v] = crowd.mesh.rest[v] = {(strand == 0 ? spacing - 2.05e-3 : spacing * strand), 0.01 * (v % 3), 0.0};
        crowd.end[v] = crowd.start[v] - Vec3(std::array{0.0, 5e-3, 9e-3}[strand], 0.0, 0.0);
    }
    std::vector<Vec3> limited;
    crowd.limit(limited);
    const auto moved = [&](int strand) { return (limited[3 * strand] - crowd.start[3 * strand]).norm(); };
    BOOST_TEST(moved(1) < 2.05e-3); // stopped by the first
    BOOST_TEST(moved(2) > 0.75 * (spacing + moved(1)));
    BOOST_TEST(moved(2) < spacing + moved(1));
    BOOST_TEST(crowd.least_separation(limited) > 1.0 - 1e-9);
}

BOOST_AUTO_TEST_SUITE_END()
