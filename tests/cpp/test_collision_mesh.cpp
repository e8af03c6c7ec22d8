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

BOOST_AUTO_TEST_SUITE_END()
