// Motion bounds and the vertices that escape them.
#include "ringlet/collision/motion_bounds.h"

#include <Eigen/Geometry>
#include <boost/test/unit_test.hpp>

using namespace ringlet;

namespace {

CollisionMesh points(int count) {
    CollisionMesh mesh;
    for (int v = 0; v < count; ++v) mesh.rest.emplace_back(v, 0.0, 0.0);
    mesh.radius.assign(count, 0.01);
    mesh.moves.assign(count, 1);
    mesh.object.assign(count, 0);
    mesh.anchor.assign(count, -1);
    return mesh;
}

} // namespace

BOOST_AUTO_TEST_SUITE(motion_bounds)

BOOST_AUTO_TEST_CASE(a_vertex_escapes_where_its_path_leaves_its_bound) {
    const CollisionMesh mesh = points(4);
    MotionBounds bounds(mesh);
    std::vector<Vec3> end = mesh.rest, apex = mesh.rest;
    bounds.fit({mesh.rest, mesh.rest}, {0.1, 1.0});
    end[1].y() += 0.09;
    end[2].y() += 0.11;
    apex[3].z() -= 0.11;
    bounds.find_escaped({mesh.rest, end, apex});
    const std::vector<bool> expected = {false, false, true, true};
    for (int v = 0; v < 4; ++v) BOOST_TEST(bool(bounds.escaped()[v]) == expected[v]);
    BOOST_TEST(bounds.any_escaped());
}

BOOST_AUTO_TEST_CASE(a_bound_that_moves_rigidly_stays_inside_the_old_one) {
    const CollisionMesh mesh = points(3);
    MotionBounds bounds(mesh);
    bounds.fit({mesh.rest, mesh.rest}, {0.1, 1.0});
    const Mat3 turn = Eigen::AngleAxisd(0.5, Vec3::UnitZ()).toRotationMatrix();
    std::vector<Vec3> from = mesh.rest, to;
    from[0].y() += 0.04; // inside its bound; the next outside
    from[1].y() += 0.2;
    for (const Vec3 &x : from) to.push_back(turn * x + Vec3(3.0, 0.0, 0.0));
    bounds.move_rigidly(from, to);
    const double half[] = {0.06 / std::sqrt(3.0), 0.0, 0.1 / std::sqrt(3.0)};
    for (const double part : {0.99, 1.01}) {
        std::vector<Vec3> end = to;
        for (int v = 0; v < 3; ++v) end[v].z() -= part * half[v];
        bounds.find_escaped({to, end});
        for (const int v : {0, 2}) BOOST_TEST(bool(bounds.escaped()[v]) == (part > 1.0));
        BOOST_TEST(bool(bounds.escaped()[1]));
    }
}

BOOST_AUTO_TEST_CASE(without_bounds_everything_that_moves_has_escaped) {
    CollisionMesh mesh = points(2);
    mesh.moves[1] = 0;
    MotionBounds bounds(mesh);
    BOOST_TEST(bounds.empty());
    bounds.find_escaped({mesh.rest, mesh.rest});
    BOOST_TEST(bounds.escaped()[0]);
    BOOST_TEST(!bounds.escaped()[1]);
}

BOOST_AUTO_TEST_CASE(the_bound_of_a_long_path_encloses_its_start_alone) {
    const CollisionMesh mesh = points(2);
    MotionBounds bounds(mesh);
    std::vector<Vec3> end = mesh.rest;
    end[0].y() += 0.5, end[1].y() += 2.0;
    const Move move{mesh.rest, end};
    bounds.fit(move, {0.1, 1.0});
    BOOST_TEST(bounds.outside(move, 1.0, 0.0).empty()); // of the long path nothing more is asked
    bounds.find_escaped(move);
    BOOST_TEST(!bounds.escaped()[0]);
    BOOST_TEST(bounds.escaped()[1]);
    end[0].y() += 0.2;
    BOOST_TEST((bounds.outside(move, 1.0, 0.0) == std::vector<int>{0}));
    bounds.fit(move, {0.1, 1.0}, {0});
    bounds.find_escaped(move);
    BOOST_TEST(!bounds.escaped()[0]);
}

BOOST_AUTO_TEST_SUITE_END()
