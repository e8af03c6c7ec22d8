// Contact forces from energies.
#include "random.h"
#include "ringlet/contact/contact.h"
#include "ringlet/contact/contact_set.h"

#include <boost/test/unit_test.hpp>

#include <Eigen/Eigenvalues>
#include <limits>

using namespace ringlet;

namespace {

Contact some_contact(Random &random) {
    Contact contact{};
    contact.first = 2;
    contact.normal = random.vector(1.0).normalized();
    contact.distance = 1e-3;
    contact.barrier_end = 1e-3 / 64;
    contact.stiffness = random(0.1, 10.0);
    contact.friction = random(0.0, 1.0);
    contact.give = 2e-5;
    contact.start = random.vector(1e-3);
    contact.force = random(0.0, 1e-3);
    return contact;
}

} // namespace

BOOST_AUTO_TEST_SUITE(contact_forces)

BOOST_AUTO_TEST_CASE(potentials_are_the_integrals_of_their_forces) {
    Random random;
    const double h = 1e-7;
    for (int i = 0; i < 1000; ++i) {
        const double r = 1.0, g = random(-0.5, 1.2);
        const auto at = [&](double gap) { return contact_potential(gap, r, r / 64); };
        const double scale = 1.0 + at(g).second;
        BOOST_TEST(std::abs((at(g + h).value - at(g - h).value) / (2 * h) - at(g).first) < 1e-5 * scale);
        if (std::abs(g - r) > 1e-3 && std::abs(g - r / 64) > 1e-4)
            BOOST_TEST(std::abs((at(g + h).first - at(g - h).first) / (2 * h) - at(g).second) < 1e-4 * scale);
        BOOST_TEST(at(g).first <= 0.0);
        BOOST_TEST(at(g).second >= 0.0);

        const double y = random(0.0, 2.0);
        const auto rub = [&](double slid) { return friction_potential(slid, 1.0); };
        if (y > h) BOOST_TEST(std::abs((rub(y + h).value - rub(y - h).value) / (2 * h) - rub(y).first) < 1e-6);
    }
}

BOOST_AUTO_TEST_CASE(a_contact_bears_what_it_is_to_bear_where_it_began) {
    Random random;
    for (int i = 0; i < 1000; ++i) {
        const double gap = random(1e-3, 1.0), force = random(1e-3, 3.0), r = distance_to_bear(force, gap);
        BOOST_TEST(std::abs(contact_potential(gap, r, 0.0).first + force) < 1e-12);
        const double part = random(0.0, 1.0);
        BOOST_TEST(std::abs(friction_potential(sheared_to_hold(part), 1.0).first - part) < 1e-12);
    }
}

BOOST_AUTO_TEST_CASE(what_is_expanded_is_right_to_second_order) {
    Random random;
    for (int i = 0; i < 1000; ++i) {
        Contact contact = some_contact(random);
        const double r = contact.distance;
        contact.gap = random(0.05, 0.45) * r; // within the barrier
        const auto off = [&](double nearer) {
            const Vec3 apart = (contact.gap - nearer * contact.gap) * contact.normal;
            return std::abs(expanded_push_energy(contact, apart) - push_energy(contact, apart)) / (contact.stiffness * r * r);
        };
        BOOST_TEST(off(0.0) < 1e-15);
        BOOST_TEST(std::abs(off(2e-2) / off(1e-2) - 8.0) < 0.2);
    }
}

BOOST_AUTO_TEST_CASE(the_gradient_is_that_of_the_energy_and_the_hessian_semi_definite) {
    Random random;
    const double h = 1e-9;
    for (int i = 0; i < 1000; ++i) {
        const Contact contact = some_contact(random);
        const Vec3 separation = random.vector(1e-3);
        const ContactValue value = contact_value(contact, separation);
        const double scale = value.gradient.norm() + contact.stiffness * contact.distance;
        for (int k = 0; k < 3; ++k) {
            const Vec3 step = h * Vec3::Unit(k);
            const double slope =
                (contact_energy(contact, separation + step) - contact_energy(contact, separation - step)) / (2 * h);
            BOOST_TEST(std::abs(slope - value.gradient[k]) < 1e-4 * scale);
        }
        const Eigen::SelfAdjointEigenSolver<Mat3> eigen(value.hessian);
        BOOST_TEST(eigen.eigenvalues()[0] >= -1e-9 * eigen.eigenvalues()[2]);
    }
}

BOOST_AUTO_TEST_CASE(friction_never_exceeds_its_cone) {
    Random random;
    for (int i = 0; i < 1000; ++i) {
        const Contact contact = some_contact(random);
        const Vec3 gradient = contact_value(contact, random.vector(1e-3)).gradient;
        const Vec3 tangential = gradient - contact.normal.dot(gradient) * contact.normal;
        BOOST_TEST(tangential.norm() <=
                   contact.friction * contact.force + 1e-14 * gradient.norm()); // what rounding leaves of the push
    }
}

// Where the held ends of two edges touch, nothing that moves is nearest; as the others turn, it is, by a little.
BOOST_AUTO_TEST_CASE(edges_that_touch_at_held_ends_are_no_stiffer_than_their_other_ends) {
    constexpr double held = std::numeric_limits<double>::infinity();
    CollisionMesh mesh;
    mesh.edges = {{0, 1}, {2, 3}};
    mesh.strand_edges = 2;
    mesh.radius.assign(4, 1e-3);
    mesh.moves = {0, 1, 0, 1};
    mesh.object = {0, 0, 1, 1};
    mesh.anchor.assign(4, -1);
    const ContactMaterial material{{held, 2.0, held, 3.0}, {0, 0, 0, 0}, {0.3}, 1, 1e-5};
    for (const double turned : {0.0, 1e-6, 1e-3}) {
        const std::vector<Vec3> now = {{0, 0, 0}, {0.01, 0, 0}, {turned, -turned, 1e-3}, {turned, 0.01, 1e-3}};
        mesh.rest = now;
        PairCache near(mesh);
        near.update_bounds({now, now}, {.margin = 1e-3, .max_path = 0.1});
        ContactSet contacts;
        contacts.find(mesh, material, near.contact_pairs(now), now, now);
        BOOST_REQUIRE(contacts.contacts().size() == 1u);
        BOOST_TEST(contacts.contacts()[0].stiffness == 2.0, boost::test_tools::tolerance(1e-12));
    }
}

BOOST_AUTO_TEST_SUITE_END()
