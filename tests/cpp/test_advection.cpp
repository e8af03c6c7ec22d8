// Advection with bodies.
#include "ringlet/scene/prescribed_motion.h"

#include <Eigen/Geometry>
#include <boost/test/unit_test.hpp>

using namespace ringlet;

namespace {

// Points that move, and two bodies: the corners of cubes of 2 cm about the origin and about x = 20 cm.
SceneVertices between_two_cubes(const std::vector<Vec3> &points, std::vector<Vec3> &positions) {
    SceneVertices all;
    positions = points;
    all.cloths = {int(points.size())};
    all.dynamic_vertices = int(points.size());
    all.objects = 1;
    all.mesh.moves.assign(points.size(), 1);
    all.mesh.object.assign(points.size(), 0);
    for (const int body : {0, 1}) {
        all.bodies.push_back(all.count());
        for (int corner = 0; corner < 8; ++corner) {
            const Vec3 at(corner & 1 ? 0.01 : -0.01, corner & 2 ? 0.01 : -0.01, corner & 4 ? 0.01 : -0.01);
            positions.push_back(at + Vec3(0.2 * body, 0.0, 0.0));
            all.mesh.moves.push_back(0);
            all.mesh.object.push_back(1 + body);
        }
    }
    all.bodies.push_back(all.count());
    return all;
}

} // namespace

BOOST_AUTO_TEST_SUITE(advection)

BOOST_AUTO_TEST_CASE(space_moves_rigidly_with_bodies_that_share_a_motion) {
    const std::vector<Vec3> points = {{0.1, 0.02, 0.0}, {-0.05, 0.3, 0.1}, {0.012, 0.0, 0.0}};
    std::vector<Vec3> start;
    const SceneVertices all = between_two_cubes(points, start);
    const Eigen::Isometry3d motion = Eigen::Translation3d(0.3, -0.1, 0.2) * Eigen::AngleAxisd(0.4, Vec3(1, 2, 3).normalized());
    std::vector<Vec3> target = start, to = start;
    for (size_t v = points.size(); v < target.size(); ++v) target[v] = motion * target[v];
    const SpaceMap map({all, start, start, target});
    for (size_t v = 0; v < points.size(); ++v) to[v] = map(start[v]);
    for (size_t v = 0; v < points.size(); ++v) BOOST_TEST((to[v] - motion * points[v]).norm() < 1e-9);
}

BOOST_AUTO_TEST_CASE(space_between_parting_bodies_stretches_in_order) {
    std::vector<Vec3> points;
    for (int k = 0; k <= 80; ++k) points.emplace_back(0.02 + 0.002 * k, 0.0, 0.0);
    std::vector<Vec3> start;
    const SceneVertices all = between_two_cubes(points, start);
    std::vector<Vec3> target = start, to = start;
    for (int v = all.bodies[1]; v < all.bodies[2]; ++v) target[v][0] += 0.04;
    const SpaceMap map({all, start, start, target});
    for (size_t v = 0; v < points.size(); ++v) to[v] = map(start[v]);
    for (size_t k = 1; k < points.size(); ++k) BOOST_TEST(to[k][0] > to[k - 1][0]);
    BOOST_TEST(std::abs(to.front()[0] - points.front()[0]) < 1e-4);
    BOOST_TEST(std::abs(to[points.size() - 1][0] - points.back()[0] - 0.04) < 1e-4);
}

BOOST_AUTO_TEST_CASE(a_body_moves_affinely_unless_it_is_dented) {
    std::vector<Vec3> start;
    const SceneVertices all = between_two_cubes({}, start);
    for (const double depth : {1.0, 0.0}) { // of the cube: solid, then flat
        for (Vec3 &at : start) at[2] *= depth;
        Mat3 map;
        map << 1.1, 0.3, 0.0, -0.2, 0.9, 0.1, 0.0, 0.4, 1.3;
        std::vector<Vec3> target;
        for (const Vec3 &at : start) target.push_back(map * at + Vec3(0.3, -0.1, 0.2));
        BOOST_TEST(PrescribedMotion({all, start, start, target}).moves_affinely(1));
        target.back() += Vec3(0.0, 1e-3, 0.0);
        BOOST_TEST(!PrescribedMotion({all, start, start, target}).moves_affinely(1));
    }
}

BOOST_AUTO_TEST_SUITE_END()
