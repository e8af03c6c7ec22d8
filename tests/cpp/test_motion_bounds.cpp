// Motion bounds and the vertices that escape them.
#include "ringlet/collision/motion_bounds.h"

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
    BOOST_TEST(bounds.clearance(1, end[1]) == 0.01, boost::test_tools::tolerance(1e-9));
    BOOST_TEST(bounds.clearance(2, end[2]) < 0.0);
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
