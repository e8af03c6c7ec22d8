// A third kind of block goes through Newton's method without a change to the solver.
#include "spring_masses.h"

#include <boost/test/unit_test.hpp>

using namespace ringlet;

BOOST_AUTO_TEST_SUITE(block)

BOOST_AUTO_TEST_CASE(a_mass_on_a_spring_takes_the_step_of_backward_euler) {
    constexpr double mass = 0.3, spring = 40.0, dt = 0.01;
    SpringScene scene;
    scene.add_masses({{0.1, 0.0, 0.0}}, mass, spring);
    scene.finish();
    scene.masses[0]->anchors()[0] = Vec3::Zero();
    scene.masses[0]->velocities()[0] = {0.0, 2.0, 0.0};
    const Vec3 gravity(0.0, 0.0, -9.81);
    const SolverEffort effort = scene.step(dt, gravity);
    const Vec3 start(0.1, 0.0, 0.0), speed(0.0, 2.0, 0.0);
    const Vec3 expected = (mass * (start + dt * speed + dt * dt * gravity)) / (mass + dt * dt * spring);
    BOOST_TEST((scene.masses[0]->positions()[0] - expected).norm() < 1e-14);
    BOOST_TEST((scene.masses[0]->velocities()[0] - (expected - start) / dt).norm() < 1e-11);
    BOOST_TEST(effort.converged);
    BOOST_TEST(effort.iterations == 2.0); // the second finds that nothing is left
}

BOOST_AUTO_TEST_CASE(a_mass_that_falls_on_a_triangle_comes_to_rest_above_it) {
    constexpr double mass = 1e-3, dt = 1.0 / 240;
    SpringScene scene;
    scene.add_masses({{0.0, 0.0, 5e-3}}, mass, 0.0);
    scene.add_triangle({-0.1, -0.1, 0.0}, {0.1, -0.1, 0.0}, {0.0, 0.1, 0.0});
    scene.finish();
    const Vec3 gravity(0.0, 0.0, -9.81);
    for (int k = 0; k < 400; ++k) {
        scene.step(dt, gravity);
        BOOST_REQUIRE(scene.masses[0]->positions()[0].z() > 0.0);
    }
    const double k = mass / (dt * dt), d_hat = 2.0 * SpringScene::radius, gap = scene.masses[0]->positions()[0].z();
    BOOST_TEST(std::abs(k * barrier(gap, d_hat, 0.0).first + mass * 9.81) < 1e-6 * k); // the barrier carries its weight
    BOOST_TEST(scene.masses[0]->velocities()[0].norm() < 1e-6);
}

BOOST_AUTO_TEST_CASE(masses_that_push_one_another_keep_their_momentum) {
    constexpr double dt = 1.0 / 240;
    SpringScene scene;
    scene.add_masses({{-0.01, 0.0, 0.0}, {0.01, 0.0, 0.0}}, 2e-3, 0.0);
    scene.add_masses({{0.0, -0.01, 3e-3}, {0.0, 0.01, 3e-3}}, 1e-3, 0.0);
    scene.finish(0.2);
    for (Vec3 &velocity : scene.masses[1]->velocities()) velocity = {0.0, 0.0, -0.5};
    for (int k = 0; k < 30; ++k) scene.step(dt);
    const auto momentum = [&](int b, double mass) {
        return mass * (scene.masses[b]->velocities()[0] + scene.masses[b]->velocities()[1]);
    };
    BOOST_TEST(momentum(0, 2e-3).z() < -1e-4); // they met
    BOOST_TEST((momentum(0, 2e-3) + momentum(1, 1e-3) - Vec3(0.0, 0.0, -1e-3)).norm() < 1e-10);
    BOOST_TEST(scene.masses[1]->positions()[0].z() > scene.masses[0]->positions()[0].z());
}

BOOST_AUTO_TEST_SUITE_END()
