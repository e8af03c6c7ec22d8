// What contacts remember from step to step: stiffness levels, initial overlaps, initial penetration.
#include "ringlet/contact/initial_overlap.h"
#include "ringlet/contact/stiffness.h"
#include "ringlet/scene/initial_penetration.h"
#include "shapes.h"
#include "spring_masses.h"

#include <boost/test/unit_test.hpp>

using namespace ringlet;

BOOST_AUTO_TEST_SUITE(contact_state)

BOOST_AUTO_TEST_CASE(a_vertex_is_as_stiff_as_its_load_asks_for) {
    constexpr double largest = 1000.0, d_hat = 1e-3;
    CollisionMesh mesh;
    mesh.moves = {0, 1, 1, 1, 1};
    mesh.object = {0, 0, 0, 0, 0};
    mesh.along_curve.resize(5);
    mesh.radius.assign(5, 0.5 * d_hat);
    ContactStiffness stiffness(5);
    stiffness.begin_step({std::numeric_limits<double>::infinity(), largest, largest, largest, largest}, 0.01);
    stiffness.recall({0.0, 0.0, 0.0, 0.0, 0.05});
    ContactMaterial material;
    stiffness.set_levels(mesh, material);
    const std::vector<double> &levels = material.stiffness, &firm = material.firm_stiffness;
    BOOST_TEST(std::isinf(levels[0]));
    BOOST_TEST(levels[1] == 0.001 * largest); // carries nothing
    BOOST_TEST(firm[1] == 0.01 * largest);
    BOOST_TEST(std::isinf(firm[0]));
    BOOST_TEST(levels[3] == 0.1 * largest, boost::test_tools::tolerance(1e-12)); // as its neighbour
    BOOST_TEST(levels[4] == 0.1 * largest, boost::test_tools::tolerance(1e-12)); // 10 < 0.05 / d̂ ≤ 100
    stiffness.recall({0.0, 0.0, 0.0, 0.0, 10.0});
    stiffness.set_levels(mesh, material);
    BOOST_TEST(levels[4] == largest);
    BOOST_TEST(firm[4] == largest);
    stiffness.begin_step({largest, largest, largest, largest, largest}, 0.25); // a half-life
    BOOST_TEST(stiffness.loads()[4] == 5.0, boost::test_tools::tolerance(1e-12));
}

BOOST_AUTO_TEST_CASE(an_initial_overlap_pushes_only_as_far_as_its_activation_distance_has_grown) {
    const ContactPair pair{{{0, 1}, true, 1e-3}, {}};
    InitialOverlaps overlaps;
    overlaps.add(contact_name(pair), 4e-4, 0.0);
    BOOST_TEST(overlaps.search().find(pair)->activation == 4e-4); // no force where it begins
    overlaps.grow(1e-4);
    BOOST_TEST(overlaps.search().find(pair)->activation == 5e-4, boost::test_tools::tolerance(1e-12));
    for (int k = 0; k < 6; ++k) overlaps.grow(1e-4);
    BOOST_TEST(overlaps.search().find(pair) == nullptr); // an ordinary pair now
}

BOOST_AUTO_TEST_CASE(an_overlap_that_stays_keeps_its_force_at_any_stiffness) {
    CollisionMesh mesh;
    mesh.edges = {{0, 1}, {2, 3}};
    const ContactPair pair{{{0, 1}, true, 1e-3}, {{0.5, 0.5, -0.5, -0.5}, 1e-8}};
    for (const double stiffness : {1.0, 10.0, 1e4}) {
        InitialOverlaps overlaps;
        overlaps.add(contact_name(pair), 1e-4, 2e-4);
        const std::vector<double> of_vertices(4, stiffness);
        overlaps.activate(mesh, {of_vertices, of_vertices, {}, {}, 1, 0.0}, {pair});
        const double d_hat = overlaps.search().find(pair)->activation;
        BOOST_TEST(-stiffness * barrier(1e-4, d_hat, 0.0).first == 2e-4, boost::test_tools::tolerance(1e-10));
    }
}

BOOST_AUTO_TEST_CASE(a_vertex_inside_a_body_is_exempt_until_it_has_come_out) {
    const OwnedMesh ball = octahedron();
    InitialPenetration::Body body{2, int(ball.points.size()), 1, ball.triangles};
    CollisionMesh mesh;
    mesh.moves = {0, 1};
    mesh.object = {0, 0};
    mesh.objects = {{0, 2}};
    mesh.radius = {0.01, 0.01};
    mesh.anchor = {-1, -1};
    std::vector<Vec3> positions = {{0.5, 0.5, 0.5}, {0.3, 0.3, 0.3}};
    for (const Vec3 &at : ball.points) {
        positions.push_back(at);
        mesh.moves.push_back(0), mesh.object.push_back(1), mesh.radius.push_back(0.0), mesh.anchor.push_back(-1);
    }
    InitialPenetration penetration;
    penetration.add(1, body, mesh);
    BOOST_TEST(mesh.anchor[1] == 1);
    const std::vector<double> stiffness(positions.size(), 7.0);
    const std::vector<RecoverySpring> springs = penetration.recover(mesh, positions, stiffness, 1e-3);
    BOOST_REQUIRE(springs.size() == 1u);
    BOOST_TEST(springs[0].normal.dot(Vec3(1, 1, 1).normalized()) > 0.99);
    BOOST_TEST(springs[0].stiffness == 7.0);
    BOOST_TEST(springs[0].depth(positions[1]) == 1e-3, boost::test_tools::tolerance(1e-6)); // no farther than a step's rise
    BOOST_TEST(springs[0].energy(positions[1] + 2e-3 * springs[0].normal) == 0.0);
    positions[1] = {0.4, 0.4, 0.4};
    BOOST_TEST(penetration.recover(mesh, positions, stiffness, 1e-3).empty());
    BOOST_TEST(penetration.count() == 0);
    BOOST_TEST(mesh.anchor[1] == -1);
}

BOOST_AUTO_TEST_SUITE_END()
