// Contacts: barrier, friction, and the stiffness of a pair.
#include "random.h"
#include "ringlet/collision/move_candidates.h"
#include "ringlet/contact/contact_set.h"

#include <boost/test/unit_test.hpp>

#include <Eigen/Eigenvalues>
#include <limits>

using namespace ringlet;

namespace {

Contact some_contact(Random &random) {
    Contact contact{};
    contact.at.first = 2;
    const Vec3 normal = random.vector(1.0).normalized();
    contact.barrier = {normal, random(0.1, 10.0), 1e-3, 1e-3 / 64};
    contact.friction = {normal, random(0.0, 1.0), 2e-5, random.vector(1e-3), random(0.0, 1e-3)};
    return contact;
}

// The gradient against differences of the energy; `stiffness` is what the law can be as stiff as [N/m].
template <PairForce Law> void check_derivatives(const Law &law, const Vec3 &s, double stiffness) {
    const double h = 1e-9;
    const PairValue value = law.value(s);
    BOOST_TEST(value.energy == law.energy(s), boost::test_tools::tolerance(1e-12));
    for (int k = 0; k < 3; ++k) {
        const Vec3 step = h * Vec3::Unit(k);
        const double slope = (law.energy(s + step) - law.energy(s - step)) / (2 * h);
        BOOST_TEST(std::abs(slope - value.gradient[k]) < 1e-4 * (value.gradient.norm() + 1e-3 * stiffness));
    }
    const Eigen::SelfAdjointEigenSolver<Mat3> eigen(value.hessian);
    BOOST_TEST(eigen.eigenvalues()[0] >= -1e-9 * std::max(eigen.eigenvalues()[2], 0.0));
}

// The Hessian against differences of the gradient, where it is not projected.
template <PairForce Law> void check_hessian(const Law &law, const Vec3 &s, double h, double stiffness) {
    for (int k = 0; k < 3; ++k) {
        const Vec3 step = h * Vec3::Unit(k);
        const Vec3 column = (law.value(s + step).gradient - law.value(s - step).gradient) / (2 * h);
        BOOST_TEST((column - law.value(s).hessian.col(k)).norm() < 1e-5 * stiffness);
    }
}

} // namespace

BOOST_AUTO_TEST_SUITE(contact_energies)

BOOST_AUTO_TEST_CASE(barrier_and_friction_forces_are_the_derivatives_of_their_potentials) {
    Random random;
    const double h = 1e-7;
    for (int i = 0; i < 1000; ++i) {
        const double r = 1.0, g = random(-0.5, 1.2);
        const auto at = [&](double gap) { return barrier(gap, r, r / 64); };
        const double scale = 1.0 + at(g).second;
        BOOST_TEST(std::abs((at(g + h).value - at(g - h).value) / (2 * h) - at(g).first) < 1e-5 * scale);
        if (std::abs(g - r / 64) > 1e-4)
            BOOST_TEST(std::abs((at(g + h).first - at(g - h).first) / (2 * h) - at(g).second) < 1e-4 * scale);
        if (g > r / 64) BOOST_TEST(std::abs(at(g + h).second - at(g).second) < 1e-4 * scale); // no jump of stiffness
        BOOST_TEST(at(g).first <= 0.0);
        BOOST_TEST(at(g).second >= 0.0);

        const double y = random(0.0, 2.0);
        const auto friction = [&](double slip) { return friction_potential(slip, 1.0); };
        if (y > h) BOOST_TEST(std::abs((friction(y + h).value - friction(y - h).value) / (2 * h) - friction(y).first) < 1e-6);
    }
}

BOOST_AUTO_TEST_CASE(each_pair_force_has_the_derivatives_of_its_energy) {
    Random random;
    for (int i = 0; i < 1000; ++i) {
        const Contact contact = some_contact(random);
        const Vec3 s = random.vector(1e-3);
        check_derivatives(contact, s, contact.barrier.stiffness);
        check_derivatives(contact.barrier, s, contact.barrier.stiffness);
        check_derivatives(contact.friction, s, contact.friction.largest() / 2e-5);
        const double length = contact.friction.slip(s).norm();
        if (std::abs(length - 2e-5) > 1e-8) // the stiffness of friction is continuous, its slope not
            check_hessian(contact.friction, s, 1e-10, contact.friction.largest() / 2e-5);

        const Tie tie(3, 7, 1e-3, random(1.0, 10.0));
        const Vec3 stretched = random(0.5, 2.0) * 1e-3 * random.vector(1.0).normalized();
        check_derivatives(tie, stretched, tie.stiffness);
        if (stretched.norm() > 1e-3) check_hessian(tie, stretched, 1e-8, tie.stiffness); // pressed together it is projected
        BOOST_TEST(tie.value(1e-3 * stretched.normalized()).gradient.norm() < 1e-12 * tie.stiffness);
    }
}

BOOST_AUTO_TEST_CASE(activation_distance_and_slip_invert_the_forces) {
    Random random;
    for (int i = 0; i < 1000; ++i) {
        const double gap = random(1e-3, 1.0), force = random(1e-3, 3.0), r = activation_distance(force, gap);
        BOOST_TEST(std::abs(barrier(gap, r, 0.0).first + force) < 1e-12);
        const double fraction = random(0.0, 1.0);
        BOOST_TEST(std::abs(friction_potential(slip_to_hold(fraction), 1.0).first - fraction) < 1e-12);
    }
}

BOOST_AUTO_TEST_CASE(friction_stays_within_its_cone) {
    Random random;
    for (int i = 0; i < 1000; ++i) {
        const Contact contact = some_contact(random);
        const Vec3 gradient = contact.value(random.vector(1e-3)).gradient, &normal = contact.barrier.normal;
        const Vec3 tangential = gradient - normal.dot(gradient) * normal;
        BOOST_TEST(tangential.norm() <= contact.friction.largest() + 1e-14 * gradient.norm()); // rounding of the normal force
    }
}

// Where the prescribed ends of two edges touch, no free vertex has a weight; as the edges turn, it gets a small one.
BOOST_AUTO_TEST_CASE(edges_that_touch_at_prescribed_ends_are_no_stiffer_than_their_free_ends) {
    constexpr double prescribed = std::numeric_limits<double>::infinity();
    CollisionMesh mesh;
    mesh.edges = {{0, 1}, {2, 3}};
    mesh.curve_edges = 2;
    mesh.radius.assign(4, 1e-3);
    mesh.moves = {0, 1, 0, 1};
    mesh.object = {0, 0, 1, 1};
    mesh.objects = {{0, 2}, {2, 4}};
    mesh.anchor.assign(4, -1);
    const std::vector<double> stiffness = {prescribed, 2.0, prescribed, 3.0};
    const ContactMaterial material{stiffness, stiffness, {0, 0, 0, 0}, {0.3}, 1, 1e-5};
    for (const double turned : {0.0, 1e-6, 1e-3}) {
        const std::vector<Vec3> now = {{0, 0, 0}, {0.01, 0, 0}, {turned, -turned, 1e-3}, {turned, 0.01, 1e-3}};
        mesh.rest = now;
        Candidates candidates(mesh);
        candidates.enclose({now, now}, {.margin = 1e-3, .max_path = 0.1});
        MoveCandidates pairs(candidates);
        pairs.begin({now, now});
        ContactSet contacts;
        const std::vector<unsigned char> all(2, 1);
        contacts.find(mesh, material, pairs.contact_pairs(now, all), all, now, now);
        BOOST_REQUIRE(contacts.contacts().size() == 1u);
        BOOST_TEST(contacts.contacts()[0].barrier.stiffness == 2.0, boost::test_tools::tolerance(1e-12));
    }
}

BOOST_AUTO_TEST_CASE(a_pair_is_soft_between_strands_alone) {
    CollisionMesh mesh; // a strand of two vertices; the others are of a second strand, or of a body
    const Stencil middles{{0, 1, 2, 3}, {0.5, 0.5, -0.5, -0.5}, 2};
    const ContactMaterial material{std::vector<double>(4, 2.0), std::vector<double>(4, 5.0), {}, {}};
    mesh.along_curve.resize(4);
    BOOST_TEST(pair_stiffness(mesh, middles, material) == 2.0);
    mesh.along_curve.resize(2);
    BOOST_TEST(pair_stiffness(mesh, middles, material) == 5.0);
}

BOOST_AUTO_TEST_SUITE_END()
