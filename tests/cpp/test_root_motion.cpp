// Rigid motion of a strand's root from where its held vertices are to where they go.
#include "ringlet/strand/root_motion.h"

#include <Eigen/Geometry>
#include <boost/test/unit_test.hpp>
#include <random>

using namespace ringlet::baseline;

namespace {

constexpr int strand_vertices = 6;

Vec<double> vec(const Eigen::Vector3d &v) { return {v.x(), v.y(), v.z()}; }

// A random polyline before and after a random rigid motion.
struct MovedStrand {
    explicit MovedStrand(int seed) {
        std::srand(seed);
        const Eigen::Quaterniond rotation = Eigen::Quaterniond::UnitRandom();
        const Eigen::Vector3d shift = Eigen::Vector3d::Random();
        for (int i = 0; i < strand_vertices; ++i) {
            const Eigen::Vector3d p = Eigen::Vector3d::Random();
            start[i] = vec(p);
            target[i] = vec(rotation * p + shift);
        }
    }
    Vec<double> start[strand_vertices], target[strand_vertices];
};

} // namespace

BOOST_AUTO_TEST_SUITE(root_motion)

BOOST_AUTO_TEST_CASE(three_held_vertices_move_the_strand_rigidly) {
    for (int seed = 0; seed < 50; ++seed) {
        const MovedStrand strand(seed);
        const RootMotion<double> root(strand.start, strand.target, true);
        for (int i = 0; i < strand_vertices; ++i) BOOST_TEST(norm(root.apply(strand.start[i]) - strand.target[i]) < 1e-12);
        const Vec<double> edge = strand.start[4] - strand.start[3];
        BOOST_TEST(norm(root.rotate(edge) - (strand.target[4] - strand.target[3])) < 1e-12);
    }
}

BOOST_AUTO_TEST_CASE(fewer_held_vertices_translate_it) {
    const MovedStrand strand(1);
    const RootMotion<double> root(strand.start, strand.target, false);
    const Vec<double> shift = strand.target[0] - strand.start[0];
    for (int i = 0; i < strand_vertices; ++i) BOOST_TEST(norm(root.apply(strand.start[i]) - (strand.start[i] + shift)) < 1e-15);
}

BOOST_AUTO_TEST_CASE(a_root_in_line_translates_it) {
    const Vec<double> start[3] = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}, target[3] = {{0, 0, 5}, {0, 1, 5}, {0, 2, 5}};
    const RootMotion<double> root(start, target, true);
    BOOST_TEST(norm(root.apply({1, 2, 3}) - Vec<double>{1, 2, 8}) == 0.0);
}

BOOST_AUTO_TEST_CASE(lanes_move_as_doubles_do) {
    Vec<Pack> start[3], target[3];
    for (int k = 0; k < lanes; ++k) {
        const MovedStrand strand(k);
        for (int i = 0; i < 3; ++i)
            for (int c = 0; c < 3; ++c)
                set_lane(start[i][c], k, strand.start[i][c]), set_lane(target[i][c], k, strand.target[i][c]);
    }
    const RootMotion<Pack> root(start, target, start[0].x == start[0].x);
    const Vec<Pack> p{constant<Pack>(0.3), constant<Pack>(-0.2), constant<Pack>(0.7)};
    for (int k = 0; k < lanes; ++k) {
        const MovedStrand strand(k);
        const Vec<double> expected = RootMotion<double>(strand.start, strand.target, true).apply({0.3, -0.2, 0.7});
        for (int c = 0; c < 3; ++c) BOOST_TEST(std::abs(root.apply(p)[c][k] - expected[c]) < 1e-15);
    }
}

BOOST_AUTO_TEST_SUITE_END()
