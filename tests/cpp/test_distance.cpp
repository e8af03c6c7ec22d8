// Closest points of edges, and of a point and a triangle, against a search.
#include "degenerate_primitives.h"
#include "ringlet/geometry/edge_batch.h"

#include <boost/test/unit_test.hpp>
#include <functional>

using namespace ringlet;

namespace {

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

} // namespace

BOOST_AUTO_TEST_SUITE(distances)

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

BOOST_AUTO_TEST_CASE(edge_batches_have_the_distances_of_single_edges) {
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

BOOST_AUTO_TEST_SUITE_END()
