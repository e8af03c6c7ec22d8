// Edges of which it is told many at a time that they never touch.
#include "ringlet/collision/separating_axis.h"

#include "ringlet/geometry/distance.h"

#include <Eigen/Geometry>
#include <boost/test/unit_test.hpp>

#include <array>
#include <cmath>
#include <limits>
#include <random>

using namespace ringlet;

BOOST_AUTO_TEST_SUITE(edges_apart)

// Edges whose ends stay in boxes, long ones above all: none is left out that touches when its ends are at corners or anywhere,
// and most of those that never do.
BOOST_AUTO_TEST_CASE(edges_that_are_apart_wherever_they_are_in_their_corridors_are_left_out) {
    std::mt19937 random(10);
    std::uniform_real_distribution<double> in(-1.0, 1.0), part(0.0, 1.0);
    const auto anywhere = [&] { return Vec3(in(random), in(random), in(random)); };
    int wrong = 0, left_out = 0, never_touch = 0;
    for (int round = 0; round < 500; ++round) {
        const double size = round % 3 == 0 ? 0.0 : 0.1, reach = round % 4 == 0 ? 0.0 : 0.2, far = round % 5 == 0 ? 1000.0 : 0.0;
        BoxedEdgePairs pairs;
        std::array<std::array<Eigen::AlignedBox3d, 4>, BoxedEdgePairs::room> corridors;
        for (int k = 0; k < BoxedEdgePairs::room; ++k) {
            for (int end = 0; end < 4; ++end) {
                const Vec3 middle = anywhere() + Vec3::Constant(far), half = size * anywhere().cwiseAbs();
                Eigen::AlignedBox3d &box = corridors[k][end] = {middle - half, middle + half};
                if (round % 7 == 0 && end % 2 == 1) box = corridors[k][end - 1]; // no length
                for (int axis = 0; axis < 3; ++axis) {
                    pairs.low[end][axis][k] = float(box.min()[axis]);
                    pairs.high[end][axis][k] = float(box.max()[axis]);
                    box.min()[axis] = pairs.low[end][axis][k], box.max()[axis] = pairs.high[end][axis][k];
                }
            }
            pairs.reach[k] = float(reach + 0x1p-19 * (1.0 + far));
        }
        const unsigned apart = RINGLET_DISPATCH(separated_in_boxes, pairs);
        for (int k = 0; k < BoxedEdgePairs::room; ++k) {
            double nearest = 1e9;
            for (int sample = 0; sample < 300; ++sample) {
                Vec3 x[4];
                for (int end = 0; end < 4; ++end) {
                    const Vec3 at = sample < 256 ? Vec3(sample >> (end / 2 * 4 + end % 2) & 1, sample >> (end + 1) & 1,
                                                        sample >> (end + 4) & 1)
                                                 : Vec3(part(random), part(random), part(random));
                    x[end] = corridors[k][end].min() + at.cwiseProduct(corridors[k][end].sizes());
                }
                nearest = std::min(nearest, std::sqrt(closest_edge_edge(x[0], x[1], x[2], x[3]).distance2));
            }
            wrong += (apart >> k & 1u) && nearest < reach;
            left_out += apart >> k & 1u;
            never_touch += nearest > reach + 0.02;
        }
    }
    BOOST_TEST(wrong == 0);
    BOOST_TEST(left_out > 0.8 * never_touch, left_out << " of " << never_touch);
    BoxedEdgePairs odd = {}; // nothing is certain of what is at one place, has no end or is no number
    for (int end = 0; end < 4; ++end)
        for (int k = 0; k < BoxedEdgePairs::room; ++k) {
            const float x = k % 2 == 0 ? 0.0f : k % 4 == 1 ? std::numeric_limits<float>::infinity() : std::nanf("");
            odd.low[end][0][k] = -x, odd.high[end][0][k] = x;
        }
    BOOST_TEST(RINGLET_DISPATCH(separated_in_boxes, odd) == 0u);
}

// Edges whose ends are somewhere on their ways, which are long and nearly one: none is left out that touches, and most of those
// that never do.
BOOST_AUTO_TEST_CASE(edges_that_are_apart_on_their_ways_are_left_out) {
    std::mt19937 random(11);
    std::uniform_real_distribution<double> in(-1.0, 1.0), part(0.0, 1.0);
    const auto anywhere = [&] { return Vec3(in(random), in(random), in(random)); };
    std::array<int, 2> wrong = {}, left_out = {}, never_touch = {}; // anywhere; together
    for (int round = 0; round < 500; ++round) {
        const double reach = round % 4 == 0 ? 0.0 : 0.2, far = round % 5 == 0 ? 1000.0 : 0.0,
                     alone = round % 3 == 0 ? 1.0 : 0.1;
        MovingEdgePairs pairs;
        std::array<std::array<std::array<Vec3, 4>, 3>, MovingEdgePairs::room> places;
        for (int k = 0; k < MovingEdgePairs::room; ++k) {
            const Vec3 way = round % 7 == 0 ? Vec3(Vec3::Zero()) : Vec3(2.0 * anywhere()), via = anywhere();
            for (int end = 0; end < 4; ++end) {
                const Vec3 start = Vec3::Constant(far) + anywhere();
                const std::array<Vec3, 3> of = {start, start + way + alone * anywhere(), start + 0.5 * way + 0.1 * via};
                for (int place = 0; place < 3; ++place)
                    for (int axis = 0; axis < 3; ++axis)
                        places[k][place][end][axis] = pairs.at[place][end][axis][k] = float(of[place][axis]);
            }
            pairs.reach[k] = float(reach + 0x1p-19 * (1.0 + far));
        }
        const std::array<unsigned, 2> apart = {RINGLET_DISPATCH(separated_in_triangles, pairs),
                                               RINGLET_DISPATCH(separated_in_motion, pairs)};
        for (int k = 0; k < MovingEdgePairs::room; ++k) {
            const auto distance = [&](const auto &weights_of) { // of its three places, for each end
                Vec3 x[4];
                for (int end = 0; end < 4; ++end) {
                    const Vec3 w = weights_of(end);
                    x[end] = w[0] * places[k][0][end] + w[1] * places[k][1][end] + w[2] * places[k][2][end];
                }
                return std::sqrt(closest_edge_edge(x[0], x[1], x[2], x[3]).distance2);
            };
            std::array<double, 2> nearest = {1e9, 1e9};
            for (int sample = 0; sample < 400; ++sample) {
                const double t = sample / 399.0, s = part(random) < 0.5 ? 1.0 : part(random);
                nearest[1] = std::min(nearest[1], distance([&](int) { return Vec3(1.0 - t, t, 0.0); }));
                nearest[0] = std::min(nearest[0], distance([&](int end) {
                                          if (sample < 81) return Vec3(Vec3::Unit(sample / int(std::pow(3, end)) % 3));
                                          const double to = part(random) < 0.5 ? 1.0 : part(random);
                                          return Vec3(1.0 - s, s * to, s * (1.0 - to));
                                      }));
            }
            nearest[0] = std::min(nearest[0], nearest[1]);
            for (int kind = 0; kind < 2; ++kind) {
                wrong[kind] += (apart[kind] >> k & 1u) && nearest[kind] < reach;
                left_out[kind] += apart[kind] >> k & 1u;
                never_touch[kind] += nearest[kind] > reach + 0.02;
            }
        }
    }
    BOOST_TEST(wrong[0] == 0);
    BOOST_TEST(wrong[1] == 0);
    BOOST_TEST(left_out[0] > 0.7 * never_touch[0], left_out[0] << " of " << never_touch[0]);
    BOOST_TEST(left_out[1] > 0.7 * never_touch[1], left_out[1] << " of " << never_touch[1]);
    MovingEdgePairs odd = {}; // nothing is certain of what is at one place, has no end or is no number
    for (int place = 0; place < 3; ++place)
        for (int end = 0; end < 4; ++end)
            for (int k = 0; k < MovingEdgePairs::room; ++k)
                odd.at[place][end][end % 3][k] = k % 2 == 0 ? 0.0f
                                                 : k % 4 == 1
                                                     ? (end % 2 == 0 ? -1.0f : 1.0f) * std::numeric_limits<float>::infinity()
                                                     : std::nanf("");
    BOOST_TEST(RINGLET_DISPATCH(separated_in_triangles, odd) == 0u);
    BOOST_TEST(RINGLET_DISPATCH(separated_in_motion, odd) == 0u);
}

BOOST_AUTO_TEST_SUITE_END()
