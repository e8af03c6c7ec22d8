// Activation distances of a collision mesh.
#include "ringlet/collision/mesh.h"

#include <boost/test/unit_test.hpp>

using namespace ringlet;

BOOST_AUTO_TEST_SUITE(collision_mesh)

BOOST_AUTO_TEST_CASE(a_strand_groomed_through_itself_activates_at_a_hundredth_of_its_thickness) {
    CollisionMesh mesh; // a loop that ends on itself
    mesh.rest = {{0.0, 0.0, 0.0}, {0.02, 0.0, 0.0}, {0.02, 0.02, 0.0}, {0.01, 0.02, 0.0}, {0.01, -0.01, 0.0}};
    mesh.radius.assign(5, 0.001);
    mesh.object.assign(5, 0);
    const std::array<int, 2> first{0, 1}, last{3, 4}, third{2, 3};
    BOOST_TEST(activation_distance(mesh, first, last) == 0.00002, boost::test_tools::tolerance(1e-12));
    BOOST_TEST(activation_distance(mesh, first, third) == 0.002); // all of it
    mesh.rest[4].z() = 0.002;
    const double apart = std::sqrt(closest_points(mesh.rest, first, last).distance2);
    BOOST_TEST(activation_distance(mesh, first, last) == std::min(0.002, 0.9 * apart), boost::test_tools::tolerance(1e-12));
}

BOOST_AUTO_TEST_CASE(objects_that_hardly_yield_activate_below_their_distance_at_rest) {
    CollisionMesh mesh; // two strands, 0.5 mm from each other, with their prescribed vertices first
    mesh.rest = {{0.0, 0.0, 0.0},    {0.0, 0.001, 0.0},    {0.0, 0.1, 0.0},
                 {0.0005, 0.0, 0.0}, {0.0005, 0.001, 0.0}, {0.0005, 0.1, 0.0}};
    mesh.radius.assign(6, 0.001);
    mesh.object = {0, 0, 0, 1, 1, 1};
    mesh.yield = {0.0, 0.001, 0.1, 0.0, 0.001, 0.1};
    const std::array<int, 2> root{0, 1}, other_root{3, 4}, tip{1, 2};
    BOOST_TEST(activation_distance(mesh, root, other_root) == 0.0005, boost::test_tools::tolerance(1e-12)); // a quarter of 2 mm
    BOOST_TEST(activation_distance(mesh, tip, other_root) == 0.002);
    mesh.yield[1] = mesh.yield[4] = 0.0005;
    BOOST_TEST(activation_distance(mesh, root, other_root) == 0.00045, boost::test_tools::tolerance(1e-12)); // at rest
    for (int v : other_root) mesh.rest[v].x() = 0.1;
    BOOST_TEST(activation_distance(mesh, root, other_root) == 0.002);
    mesh.yield.clear();
    BOOST_TEST(activation_distance(mesh, root, other_root) == 0.002);
}

BOOST_AUTO_TEST_SUITE_END()
