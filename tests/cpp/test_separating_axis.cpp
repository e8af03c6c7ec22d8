// Separating-axis culling of edges against sampled distances.
#include "ringlet/collision/separating_axis.h"
#include "ringlet/geometry/distance.h"

#include <Eigen/Geometry>
#include <boost/test/unit_test.hpp>

#include <array>
#include <cmath>
#include <limits>
#include <random>

using namespace ringlet;

BOOST_AUTO_TEST_SUITE(separating_axis)

// Above all long edges, with ends at corners of their boxes or anywhere.
BOOST_AUTO_TEST_CASE(culling_in_boxes_is_conservative_and_mostly_sharp) {
    std::mt19937 random(10);
    std::uniform_real_distribution<double> in(-1.0, 1.0), part(0.0, 1.0);
    const auto anywhere = [&] { return Vec3(in(random), in(random), in(random)); };
    int wrong = 0, culled = 0, beyond = 0;
    for (int round = 0; round < 500; ++round) {
        const double size = round % 3 == 0 ? 0.0 : 0.1, reach = round % 4 == 0 ? 0.0 : 0.2, far = round % 5 == 0 ? 1000.0 : 0.0;
        BoxedEdgePairs pairs;
        std::array<std::array<Eigen::AlignedBox3d, 4>, BoxedEdgePairs::room> boxes_of;
        for (int k = 0; k < BoxedEdgePairs::room; ++k) {
            for (int end = 0; end < 4; ++end) {
                const Vec3 middle = anywhere() + Vec3::Constant(far), half = size * anywhere().cwiseAbs();
                Eigen::AlignedBox3d &box = boxes_of[k][end] = {middle - half, middle + half};
                if (round % 7 == 0 && end % 2 == 1) box = boxes_of[k][end - 1]; // without length
                for (int axis = 0; axis < 3; ++axis) {
                    pairs.low[end][axis][k] = float(box.min()[axis]);
                    pairs.high[end][axis][k] = float(box.max()[axis]);
                    box.min()[axis] = pairs.low[end][axis][k], box.max()[axis] = pairs.high[end][axis][k];
                }
            }
            pairs.reach[k] = float(reach + 0x1p-19 * (1.0 + far));
        }
        const unsigned separated = RINGLET_DISPATCH(separated_in_boxes, pairs);
        for (int k = 0; k < BoxedEdgePairs::room; ++k) {
            double nearest = 1e9;
            for (int sample = 0; sample < 300; ++sample) {
                Vec3 x[4];
                for (int end = 0; end < 4; ++end) {
                    const Vec3 at = sample < 256 ? Vec3(sample >> (end / 2 * 4 + end % 2) & 1, sample >> (end + 1) & 1,
                                                        sample >> (end + 4) & 1)
                                                 : Vec3(part(random), part(random), part(random));
                    x[end] = boxes_of[k][end].min() + at.cwiseProduct(boxes_of[k][end].sizes());
                }
                nearest = std::min(nearest, std::sqrt(closest_edge_edge(x[0], x[1], x[2], x[3]).distance2));
            }
            wrong += (separated >> k & 1u) && nearest < reach;
            culled += separated >> k & 1u;
            beyond += nearest > reach + 0.02;
        }
    }
    BOOST_TEST(wrong == 0);
    BOOST_TEST(culled > 0.8 * beyond, culled << " of " << beyond);
    BoxedEdgePairs odd = {}; // coincident, infinite or NaN coordinates cull nothing
    for (int end = 0; end < 4; ++end)
        for (int k = 0; k < BoxedEdgePairs::room; ++k) {
            const float x = k % 2 == 0 ? 0.0f : k % 4 == 1 ? std::numeric_limits<float>::infinity() : std::nanf("");
            odd.low[end][0][k] = -x, odd.high[end][0][k] = x;
        }
    BOOST_TEST(RINGLET_DISPATCH(separated_in_boxes, odd) == 0u);
}

// Their motions are long and nearly shared.
BOOST_AUTO_TEST_CASE(culling_on_moves_is_conservative_and_mostly_sharp) {
    std::mt19937 random(11);
    std::uniform_real_distribution<double> in(-1.0, 1.0), part(0.0, 1.0);
    const auto anywhere = [&] { return Vec3(in(random), in(random), in(random)); };
    std::array<int, 2> wrong = {}, culled = {}, beyond = {}; // in triangles; in motion
    for (int round = 0; round < 500; ++round) {
        const double reach = round % 4 == 0 ? 0.0 : 0.2, far = round % 5 == 0 ? 1000.0 : 0.0, own = round % 3 == 0 ? 1.0 : 0.1;
        MovingEdgePairs pairs;
        std::array<std::array<std::array<Vec3, 4>, 3>, MovingEdgePairs::room> corners;
        for (int k = 0; k < MovingEdgePairs::room; ++k) {
            const Vec3 motion = round % 7 == 0 ? Vec3(Vec3::Zero()) : Vec3(2.0 * anywhere()), apex = anywhere();
            for (int end = 0; end < 4; ++end) {
                const Vec3 start = Vec3::Constant(far) + anywhere();
                const std::array<Vec3, 3> of = {start, start + motion + own * anywhere(), start + 0.5 * motion + 0.1 * apex};
                for (int corner = 0; corner < 3; ++corner)
                    for (int axis = 0; axis < 3; ++axis)
                        corners[k][corner][end][axis] = pairs.at[corner][end][axis][k] = float(of[corner][axis]);
            }
            pairs.reach[k] = float(reach + 0x1p-19 * (1.0 + far));
        }
        const std::array<unsigned, 2> separated = {RINGLET_DISPATCH(separated_in_triangles, pairs),
                                                   RINGLET_DISPATCH(separated_in_motion, pairs)};
        for (int k = 0; k < MovingEdgePairs::room; ++k) {
            const auto distance = [&](const auto &weights_of) { // at the weights of its three corners, for each end
                Vec3 x[4];
                for (int end = 0; end < 4; ++end) {
                    const Vec3 w = weights_of(end);
                    x[end] = w[0] * corners[k][0][end] + w[1] * corners[k][1][end] + w[2] * corners[k][2][end];
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
                wrong[kind] += (separated[kind] >> k & 1u) && nearest[kind] < reach;
                culled[kind] += separated[kind] >> k & 1u;
                beyond[kind] += nearest[kind] > reach + 0.02;
            }
        }
    }
    BOOST_TEST(wrong[0] == 0);
    BOOST_TEST(wrong[1] == 0);
    BOOST_TEST(culled[0] > 0.7 * beyond[0], culled[0] << " of " << beyond[0]);
    BOOST_TEST(culled[1] > 0.7 * beyond[1], culled[1] << " of " << beyond[1]);
    MovingEdgePairs odd = {}; // coincident, infinite or NaN coordinates cull nothing
    for (int corner = 0; corner < 3; ++corner)
        for (int end = 0; end < 4; ++end)
            for (int k = 0; k < MovingEdgePairs::room; ++k)
                odd.at[corner][end][end % 3][k] = k % 2 == 0 ? 0.0f
                                                  : k % 4 == 1
                                                      ? (end % 2 == 0 ? -1.0f : 1.0f) * std::numeric_limits<float>::infinity()
                                                      : std::nanf("");
    BOOST_TEST(RINGLET_DISPATCH(separated_in_triangles, odd) == 0u);
    BOOST_TEST(RINGLET_DISPATCH(separated_in_motion, odd) == 0u);
}

BOOST_AUTO_TEST_SUITE_END()
