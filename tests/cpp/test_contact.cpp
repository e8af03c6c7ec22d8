// Distances, impacts, and which pairs can meet.
#include "ringlet/ccd/time_of_impact.h"
#include "ringlet/geometry/distance.h"
#include "ringlet/geometry/edge_batch.h"

#include <boost/test/unit_test.hpp>
#include <functional>
#include <random>

using namespace ringlet;

namespace {

using Four = std::array<Vec3, 4>;

Vec3 anywhere(std::mt19937 &random, double size = 1.0) {
    std::uniform_real_distribution<double> in(-size, size);
    return Vec3(in(random), in(random), in(random));
}

// The least value of a convex function on [0, 1], by golden section.
double least(const std::function<double(double)> &f) {
    const double golden = 0.5 * (std::sqrt(5.0) - 1.0);
    double low = 0.0, high = 1.0;
    for (int i = 0; i < 100; ++i) {
        const double a = high - golden * (high - low), b = low + golden * (high - low);
        (f(a) < f(b) ? high : low) = f(a) < f(b) ? b : a;
    }
    return std::min({f(low), f(0.5 * (low + high)), f(high)});
}

double searched_edge_edge(const Four &x) {
    return least([&](double s) {
        return least([&](double t) { return ((1 - s) * x[0] + s * x[1] - (1 - t) * x[2] - t * x[3]).norm(); });
    });
}

double searched_point_triangle(const Four &x) {
    return least([&](double u) {
        return least([&](double v) { return (x[0] - (1 - u) * x[1] - u * ((1 - v) * x[2] + v * x[3])).norm(); });
    });
}

// Four points of a kind that is hard: of no length or area, parallel, in one plane, in one line, touching.
Four hard(std::mt19937 &random, int kind) {
    const Vec3 a = anywhere(random), d = anywhere(random), e = anywhere(random);
    std::uniform_real_distribution<double> in(-1.5, 1.5);
    switch (kind) {
    case 0: return {a, a, d, e};                                                        // an edge without length
    case 1: return {a, a, d, d};                                                        // two of them
    case 2: return {a, a + d, e, e + in(random) * d};                                   // parallel
    case 3: return {a, a + d, e, e + in(random) * d + 1e-9 * anywhere(random)};         // nearly
    case 4: return {a, a + d, e, e + in(random) * d + 1e-7 * anywhere(random)};         // less nearly
    case 5: return {a, a + d, a + in(random) * d, a + in(random) * d};                  // in one line
    case 6: return {a, a + d, a + in(random) * d + in(random) * e, a + in(random) * e}; // in one plane
    case 7: return {a + 0.3 * d, e, a, a + d};                                          // touching
    case 8: return {a, d, e, e};                                                        // a triangle without area
    case 9: return {a, d, d, d};                                                        // a triangle that is a point
    case 10: return {a, d, e, 0.5 * (d + e) + 1e-10 * anywhere(random)};                // a needle
    default: return {a, d, e, anywhere(random)};
    }
}
constexpr int kinds = 12;

double reached(const ClosestPoints &nearest, const Four &x) {
    Vec3 between = Vec3::Zero();
    for (int i = 0; i < 4; ++i) between += nearest.weights[i] * x[i];
    return between.norm();
}

// The distance is the one that was searched for, and between the points that the weights give.
void check_distance(const ClosestPoints &nearest, double searched, const Four &x, int kind) {
    const double distance = std::sqrt(nearest.distance2);
    BOOST_TEST(std::abs(distance - searched) < 2e-8, "kind " << kind);
    BOOST_TEST(std::abs(reached(nearest, x) - distance) < 1e-14);
}

double distance(bool edges, const Four &x) {
    return std::sqrt((edges ? closest_edge_edge : closest_point_triangle)(x[0], x[1], x[2], x[3]).distance2);
}

double impact_time(bool edges, const Four &x, const Four &p, double min_distance) {
    return (edges ? edge_edge_toi : point_triangle_toi)(x.data(), p.data(), min_distance);
}

Four at(const Four &x, const Four &p, double t) { return {x[0] + t * p[0], x[1] + t * p[1], x[2] + t * p[2], x[3] + t * p[3]}; }

} // namespace

BOOST_AUTO_TEST_SUITE(contact)

BOOST_AUTO_TEST_CASE(no_point_of_two_segments_is_nearer_than_their_closest_points) {
    std::mt19937 random(1);
    for (int i = 0; i < 40 * kinds; ++i) {
        const Four x = hard(random, i % kinds);
        const ClosestPoints nearest = closest_edge_edge(x[0], x[1], x[2], x[3]);
        check_distance(nearest, searched_edge_edge(x), x, i % kinds);
        for (int k : {0, 1}) BOOST_TEST((nearest.weights[k] >= 0.0 && nearest.weights[k + 2] <= 0.0));
        BOOST_TEST(nearest.weights[0] + nearest.weights[1] == 1.0);
        BOOST_TEST(nearest.weights[2] + nearest.weights[3] == -1.0);
    }
}

BOOST_AUTO_TEST_CASE(many_edges_at_once_are_as_close_as_one_by_one) {
    std::mt19937 random(7);
    std::array<int, kinds> of_kind{}, exact_of_kind{};
    for (int i = 0; i < 40; ++i) {
        EdgeBatch batch = {};
        std::array<Four, EdgeBatch::room> all;
        std::array<int, EdgeBatch::room> kind;
        for (int k = 0; k < EdgeBatch::room; ++k) {
            kind[k] = (EdgeBatch::room * i + k) % kinds;
            all[k] = hard(random, kind[k]);
            for (int end = 0; end < 4; ++end)
                for (int axis = 0; axis < 3; ++axis) batch.ends[end][axis][k] = all[k][end][axis];
        }
        batch.ends[i % 4][i % 3][i % EdgeBatch::room] = std::nan("");
        const unsigned exact = RINGLET_DISPATCH(find_closest, batch);
        BOOST_TEST(!(exact >> i % EdgeBatch::room & 1u));
        for (int k = 0; k < EdgeBatch::room; ++k) {
            if (k == i % EdgeBatch::room) continue;
            ++of_kind[kind[k]];
            if (!(exact >> k & 1u)) continue;
            ++exact_of_kind[kind[k]];
            const ClosestPoints nearest = at_edges(batch.s[k], batch.t[k], batch.distance2[k]);
            check_distance(nearest, distance(true, all[k]), all[k], kind[k]);
            for (const double along : {batch.s[k], batch.t[k]}) BOOST_TEST((along >= 0.0 && along <= 1.0));
        }
    }
    for (const int without_length : {0, 1, 8, 9}) BOOST_TEST(exact_of_kind[without_length] == 0);
    for (const int askew : {7, 10, 11}) BOOST_TEST(exact_of_kind[askew] == of_kind[askew]);
}

BOOST_AUTO_TEST_CASE(no_point_of_a_triangle_is_nearer_than_the_closest) {
    std::mt19937 random(2);
    for (int i = 0; i < 40 * kinds; ++i) {
        const Four x = hard(random, i % kinds);
        const ClosestPoints nearest = closest_point_triangle(x[0], x[1], x[2], x[3]);
        check_distance(nearest, searched_point_triangle(x), x, i % kinds);
        BOOST_TEST(nearest.weights[0] == 1.0);
        for (int k : {1, 2, 3}) BOOST_TEST(nearest.weights[k] <= 0.0);
        BOOST_TEST(std::abs(nearest.weights[1] + nearest.weights[2] + nearest.weights[3] + 1.0) < 1e-15);
    }
}

BOOST_AUTO_TEST_CASE(until_the_impact_the_distance_is_kept) {
    std::mt19937 random(3);
    std::uniform_real_distribution<double> in(0.0, 1.0);
    int impacts = 0;
    for (int i = 0; i < 200 * kinds; ++i)
        for (bool edges : {true, false}) {
            const Four x = hard(random, i % kinds), p = hard(random, (i / kinds) % kinds);
            const double first = distance(edges, x), kept = 0.5 * in(random) * first;
            const double t = impact_time(edges, x, p, kept);
            BOOST_TEST((t == no_impact || (t >= 0.0 && t <= 1.0)));
            impacts += t <= 1.0;
            double nearest = first;
            for (int k = 0; k <= 200; ++k) nearest = std::min(nearest, distance(edges, at(x, p, std::min(t, 1.0) * k / 200.0)));
            BOOST_TEST(nearest >= kept - 1e-14);
            if (t <= 1.0 && first > 1e-6) { // and it ends close to what has to be kept, not long before
                BOOST_TEST(distance(edges, at(x, p, t)) <= kept + 0.0101 * (first - kept));
            }
        }
    BOOST_TEST(impacts > 200);
}

BOOST_AUTO_TEST_CASE(head_on_the_impact_comes_when_the_gap_is_used_up) {
    const Four edges = {Vec3(-1, 0, 1), Vec3(1, 0, 1), Vec3(0, -1, 0), Vec3(0, 1, 0)};
    const Four triangle = {Vec3(0, 0, 1), Vec3(-1, -1, 0), Vec3(1, -1, 0), Vec3(0, 1, 0)};
    const Vec3 down(0, 0, -2), none = Vec3::Zero();
    const double expected = (1.0 - 0.2) / 2.0; // from a distance of 1 to 0.2 at a speed of 2
    for (double t : {impact_time(true, edges, {down, down, none, none}, 0.2),
                     impact_time(false, triangle, {down, none, none, none}, 0.2)}) {
        BOOST_TEST(t <= expected);
        BOOST_TEST(t >= 0.99 * expected);
    }
}

BOOST_AUTO_TEST_CASE(what_slides_past_or_parts_or_stands_still_has_no_impact) {
    const Four x = {Vec3(-1, 0, 1e-6), Vec3(1, 0, 1e-6), Vec3(0, -1, 0), Vec3(0, 1, 0)};
    const Vec3 along(50, 30, 0), up(0, 0, 3), none = Vec3::Zero();
    BOOST_TEST(impact_time(true, x, {along, along, none, none}, 0.9e-6) == no_impact);
    BOOST_TEST(impact_time(true, x, {up, up, none, none}, 0.9e-6) == no_impact);
    BOOST_TEST(impact_time(true, x, {none, none, none, none}, 1.0) == no_impact);
    BOOST_TEST(impact_time(true, x, {up, up, up, up}, 1.0) == no_impact);
}

BOOST_AUTO_TEST_CASE(what_touches_does_not_move_and_nothing_is_not_a_number) {
    const Four cross = {Vec3(-1, 0, 0), Vec3(1, 0, 0), Vec3(0, -1, 0), Vec3(0, 1, 0)};
    const Vec3 down(0, 0, -1), none = Vec3::Zero();
    BOOST_TEST(impact_time(true, cross, {down, down, none, none}, 0.0) == 0.0);
    const double nan = std::nan(""), infinity = std::numeric_limits<double>::infinity();
    for (double bad : {nan, infinity})
        for (bool edges : {true, false}) {
            BOOST_TEST(impact_time(edges, {Vec3(bad, 0, 0), Vec3(1, 0, 1), none, down}, {down, none, none, none}, 0.0) == 0.0);
            BOOST_TEST(impact_time(edges, {Vec3(1, 0, 0), Vec3(1, 0, 1), none, down}, {Vec3(bad, 0, 0), none, none, none},
                                   0.0) == 0.0);
        }
}

// A whole scene that flies at 100 m/s for a film frame: 4 m, ten thousand times the distances between hairs.
BOOST_AUTO_TEST_CASE(a_motion_shared_by_all_changes_no_impact) {
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
            const double kept = 0.1 * distance(edges, x);
            if (kept < 1e-8) continue; // touching: rounding decides
            const double t = impact_time(edges, x, p, kept), moving = impact_time(edges, x, flying, kept);
            BOOST_TEST((t == moving || std::abs(t - moving) < 1e-6));
        }
}

BOOST_AUTO_TEST_SUITE_END()
