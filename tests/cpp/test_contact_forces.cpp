// Moves that pass through nothing.
#include "ringlet/ccd/meeting.h"
#include "ringlet/ccd/step_filter.h"

#include <boost/test/unit_test.hpp>

#include <random>

using namespace ringlet;

namespace {

struct Random {
    std::mt19937 engine{7};
    double operator()(double low, double high) { return std::uniform_real_distribution<>(low, high)(engine); }
    Vec3 vector(double size) { return {(*this)(-size, size), (*this)(-size, size), (*this)(-size, size)}; }
};

// Strands that start anywhere and wish to be anywhere else.
struct Crowd {
    CollisionMesh mesh;
    std::vector<Vec3> start, end;
    std::vector<int> offsets{0};
    std::vector<double> mass;

    Crowd(int strands, double size, double way, unsigned seed, int vertices = 3) {
        Random random{std::mt19937(seed)};
        for (int s = 0; s < strands; ++s) {
            const Vec3 place = random.vector(size), along = random.vector(size), wish = random.vector(way);
            for (int k = 0; k < vertices; ++k) {
                const int v = int(start.size());
                start.push_back(place + k * along);
                end.push_back(start.back() + wish + random.vector(0.3 * way));
                mesh.points.push_back(v);
                mesh.radius.push_back(1e-3);
                mesh.moves.push_back(1);
                mesh.object.push_back(s);
                mesh.anchor.push_back(-1);
                mass.push_back(random(0.5, 2.0));
                if (k > 0) mesh.edges.push_back({v - 1, v});
            }
            offsets.push_back(int(start.size()));
        }
        mesh.rest = start;
    }

    FilterScene scene(bool still) const {
        return {mesh, View<double>(mass), View<int>(offsets), [](int, const Vec3 &point) { return point; }, View<int>(), {},
                still};
    }

    FilterReport filter(bool still, std::vector<Vec3> &filtered) const {
        NearPairs near(mesh);
        if (still) near.note(start, start, 0.005, 0.0);
        filtered = end;
        return filter_step(scene(still), near, start, filtered);
    }

    // The same, of strands that are still; then every third goes less far of its own accord, and the rest is filtered again.
    FilterReport filter_and_shorten(std::vector<Vec3> &filtered) const {
        NearPairs near(mesh);
        near.note(start, end, 0.0005, 0.1);
        filtered = end;
        filter_step(scene(true), near, start, filtered);
        std::vector<unsigned char> changed(start.size(), 0);
        for (size_t v = 0; v < start.size(); ++v)
            if (mesh.object[v] % 3 == 0) {
                changed[v] = 1;
                filtered[v] = start[v] + 0.3 * (filtered[v] - start[v]);
            }
        FilterScene rest = scene(true);
        rest.whole = true;
        rest.changed = changed;
        return filter_step(rest, near, start, filtered);
    }

    // Whether any two come nearer than they may, asked of all.
    bool meets(const std::vector<Vec3> &to) const {
        NearPairs all(mesh);
        all.set_out(start, to);
        return !find_met(scene(true), all, start, to).empty();
    }

    // The least distance of any two strands on the way, by dense sampling.
    double closest(const std::vector<Vec3> &to) const {
        double least = 1.0;
        std::vector<Vec3> now(start.size());
        for (int step = 0; step <= 400; ++step) {
            for (size_t v = 0; v < start.size(); ++v) now[v] = start[v] + (step / 400.0) * (to[v] - start[v]);
            for (size_t a = 0; a < mesh.edges.size(); ++a)
                for (size_t b = 0; b < a; ++b)
                    if (!share_vertex(mesh.edges[a], mesh.edges[b]))
                        least = std::min(least, std::sqrt(closest_points(now, mesh.edges[a], mesh.edges[b]).distance2));
        }
        return least;
    }

    // Of what every pair keeps on the way, the least relative to what it is to keep.
    double least_kept(const std::vector<Vec3> &to) const {
        double least = 1e9;
        std::vector<Vec3> now(start.size());
        for (int step = 0; step <= 100; ++step) {
            for (size_t v = 0; v < start.size(); ++v) now[v] = start[v] + (step / 100.0) * (to[v] - start[v]);
            for (const auto &a : mesh.edges)
                for (const auto &b : mesh.edges) {
                    if (share_vertex(a, b)) continue;
                    const double first = std::sqrt(closest_points(start, a, b).distance2);
                    const double kept = std::min(0.5 * contact_distance(mesh, a, b), 0.2 * first);
                    least = std::min(least, std::sqrt(closest_points(now, a, b).distance2) / kept);
                }
        }
        return least;
    }
};

} // namespace

BOOST_AUTO_TEST_SUITE(limited_moves)

BOOST_AUTO_TEST_CASE(a_filtered_move_keeps_of_every_distance_half_of_contact_or_a_fifth) {
    int violations = 0;
    for (unsigned seed = 0; seed < 20; ++seed)
        for (const bool still : {true, false}) {
            const Crowd crowd(12, 0.02, 0.03, seed);
            if (crowd.closest(crowd.start) < 1e-5) continue;
            std::vector<Vec3> filtered;
            const FilterReport report = crowd.filter(still, filtered);
            violations += report.violations;
            BOOST_TEST(crowd.closest(filtered) > 1e-6);
            BOOST_TEST(crowd.least_kept(filtered) > 1.0 - 1e-9);
        }
    BOOST_TEST(violations > 100);
}

// Some are held back near what they meet, and stop as a whole for others: what met is asked again until it no longer does.
BOOST_AUTO_TEST_CASE(long_strands_that_are_in_one_another_s_way_everywhere_meet_nowhere) {
    int violations = 0;
    for (unsigned seed = 0; seed < 200; ++seed) {
        const Crowd crowd(60, 0.02, 0.01, seed, 30);
        std::vector<Vec3> filtered;
        violations += crowd.filter(true, filtered).violations;
        BOOST_TEST(!crowd.meets(filtered), "crowd " << seed);
    }
    BOOST_TEST(violations > 10000);
}

BOOST_AUTO_TEST_CASE(strands_that_go_less_far_than_they_were_let_meet_nothing_either) {
    int violations = 0;
    for (unsigned seed = 0; seed < 50; ++seed) {
        const Crowd crowd(60, 0.02, 0.01, seed, 30);
        std::vector<Vec3> filtered;
        violations += crowd.filter_and_shorten(filtered).violations;
        BOOST_TEST(!crowd.meets(filtered), "crowd " << seed);
    }
    BOOST_TEST(violations > 100);
}

BOOST_AUTO_TEST_CASE(a_move_that_meets_nothing_is_left_alone) {
    const Crowd crowd(1, 0.02, 0.03, 3);
    std::vector<Vec3> filtered;
    BOOST_TEST(crowd.filter(true, filtered).violations == 0);
    BOOST_TEST((filtered == crowd.end));
}

// Strands in a row, 4 mm apart, that are drawn together towards the first, which stays: every one is in the way of the next.
BOOST_AUTO_TEST_CASE(a_chain_of_strands_stops_in_one_round) {
    constexpr int strands = 20;
    Crowd crowd(strands, 0.02, 0.03, 0);
    for (int v = 0; v < 3 * strands; ++v) {
        const int strand = v / 3;
        crowd.start[v] = crowd.mesh.rest[v] = {4e-3 * strand, 0.01 * (v % 3), 1e-4 * strand};
        crowd.end[v] = crowd.start[v] - Vec3(4.5e-3 * strand, 0.0, 0.0);
    }
    std::vector<Vec3> filtered;
    const FilterReport report = crowd.filter(true, filtered);
    BOOST_TEST(report.violations >= strands - 1);
    BOOST_TEST(report.rounds == 1);
    BOOST_TEST(report.fraction == 1.0);
    BOOST_TEST(crowd.least_kept(filtered) > 1.0 - 1e-9);
    const double part = (filtered[3] - crowd.start[3]).norm() / 4.5e-3;
    BOOST_TEST(part > 0.6);
    for (int v = 3; v < 3 * strands; ++v) // each as a whole, and all the same part of their ways
        BOOST_TEST((filtered[v] - crowd.start[v] - part * (crowd.end[v] - crowd.start[v])).norm() < 1e-12);
}

BOOST_AUTO_TEST_CASE(only_relative_motion_is_filtered) {
    Crowd crowd(12, 0.02, 0.03, 5);
    std::vector<Vec3> filtered, filtered_flying;
    const FilterReport report = crowd.filter(false, filtered);
    const Vec3 flight(100.0 / 24, 0.0, 0.0);
    for (Vec3 &place : crowd.end) place += flight;
    const FilterReport flying = crowd.filter(false, filtered_flying);
    BOOST_TEST(report.violations > 0);
    BOOST_TEST(report.violations == flying.violations);
    for (size_t v = 0; v < filtered.size(); ++v) BOOST_TEST((filtered_flying[v] - flight - filtered[v]).norm() < 1e-8);
}

BOOST_AUTO_TEST_SUITE_END()
