// Backward Euler and BDF-2 on motions with known solutions.
#include "ringlet/dynamics/time_integrator.h"

#include <boost/test/unit_test.hpp>
#include <cmath>

using namespace ringlet::baseline;

namespace {

// Position and velocity now and one step before.
struct Motion {
    double position, velocity, last_position, last_velocity;
};

// A step of a mass of 1 kg on a spring [N/m]; gravity in m/s².
void step(Motion &motion, const TimeIntegrator<double> &integrator, double spring, double gravity) {
    const double position = integrator.extrapolate(motion.position, motion.last_position);
    const double velocity = integrator.extrapolate(motion.velocity, motion.last_velocity);
    const Inertia<double> inertia = integrator.inertia(1.0, 0.0, 0.0);
    const double target = inertia.target(position, velocity, gravity, 0.0, 0.0);
    const double end = inertia.stiffness * target / (inertia.stiffness + spring); // least of ½ a (x − y)² + ½ k x²
    motion = {end, integrator.rate(end, position), motion.position, motion.velocity};
}

// Error of the position after one second of cos(3t), without any last step to begin with.
double oscillator_error(double lag, int steps) {
    const double frequency = 3.0;
    Motion motion{1.0, 0.0, 0.0, 0.0};
    for (int k = 0; k < steps; ++k)
        step(motion, TimeIntegrator<double>::of_step(1.0 / steps, k == 0 ? backward_euler_lag : lag), frequency * frequency,
             0.0);
    return std::abs(motion.position - std::cos(frequency));
}

} // namespace

BOOST_AUTO_TEST_SUITE(time_integrator)

BOOST_AUTO_TEST_CASE(backward_euler_is_of_first_order) {
    const double ratio = oscillator_error(backward_euler_lag, 2000) / oscillator_error(backward_euler_lag, 4000);
    BOOST_TEST(std::abs(ratio - 2.0) < 0.05);
}

BOOST_AUTO_TEST_CASE(bdf2_is_of_second_order) {
    const double ratio = oscillator_error(bdf2_lag, 2000) / oscillator_error(bdf2_lag, 4000);
    BOOST_TEST(std::abs(ratio - 4.0) < 0.1);
}

BOOST_AUTO_TEST_CASE(bdf2_is_exact_for_free_fall) {
    const double dt = 0.1, gravity = -9.81;
    const auto fall = [&](double t) { return 0.5 * gravity * t * t; };
    Motion motion{fall(dt), gravity * dt, 0.0, 0.0};
    for (int k = 2; k < 20; ++k) {
        step(motion, TimeIntegrator<double>::of_step(dt, bdf2_lag), 0.0, gravity);
        BOOST_TEST(std::abs(motion.position - fall(k * dt)) < 1e-12);
        BOOST_TEST(std::abs(motion.velocity - gravity * k * dt) < 1e-12);
    }
}

BOOST_AUTO_TEST_CASE(backward_euler_has_exact_velocities_in_free_fall) {
    const double dt = 0.1, gravity = -9.81;
    Motion motion{};
    for (int k = 1; k < 20; ++k) {
        step(motion, TimeIntegrator<double>::of_step(dt, backward_euler_lag), 0.0, gravity);
        BOOST_TEST(std::abs(motion.velocity - gravity * k * dt) < 1e-12);
        BOOST_TEST(std::abs(motion.position - 0.5 * gravity * dt * dt * k * (k + 1)) < 1e-12);
    }
}

BOOST_AUTO_TEST_CASE(drag_alone_carries_a_point_with_the_wind) {
    const auto integrator = TimeIntegrator<double>::of_step(0.1, backward_euler_lag);
    const Inertia<double> inertia = integrator.inertia(0.0, 0.0, 2.0);
    BOOST_TEST(std::abs(inertia.target(1.0, 0.0, -9.81, 3.0, 0.0) - 1.3) < 1e-15);
    BOOST_TEST(std::abs(inertia.target(1.0, 0.0, -9.81, 3.0, 4.0) - 1.5) < 1e-15); // and 2 m/s faster by a force of 4 N
}

BOOST_AUTO_TEST_CASE(mass_damping_lets_velocities_decay) {
    const double dt = 0.1, rate = 5.0;
    const auto integrator = TimeIntegrator<double>::of_step(dt, backward_euler_lag);
    const double end = integrator.inertia(2.0, rate, 0.0).target(0.0, 1.0, 0.0, 0.0, 0.0);
    BOOST_TEST(std::abs(integrator.rate(end, 0.0) - 1.0 / (1.0 + rate * dt)) < 1e-15);
}

BOOST_AUTO_TEST_CASE(a_point_that_nothing_acts_on_has_no_stiffness) {
    const Inertia<double> inertia = TimeIntegrator<double>::of_step(0.1, bdf2_lag).inertia(0.0, 1.0, 0.0);
    BOOST_TEST(inertia.stiffness == 0.0);
    BOOST_TEST(inertia.target(1.0, 2.0, 3.0, 4.0, 0.0) == 0.0);
}

BOOST_AUTO_TEST_CASE(angles_are_extrapolated_by_the_smaller_turn) {
    const auto integrator = TimeIntegrator<double>::of_step(0.1, bdf2_lag);
    BOOST_TEST(std::abs(integrator.extrapolate_angle(-3.1, 3.1) - (-3.1 + (2 * pi - 6.2) / 3)) < 1e-15);
}

BOOST_AUTO_TEST_CASE(lanes_have_integrators_of_their_own) {
    Pack lag{};
    set_lane(lag, 1, bdf2_lag);
    const TimeIntegrator<Pack> integrator = TimeIntegrator<Pack>::of_step(0.3, lag);
    const Pack now = constant<Pack>(2.0), last = constant<Pack>(1.7);
    BOOST_TEST(integrator.extrapolate(now, last)[0] == 2.0);
    BOOST_TEST(std::abs(integrator.extrapolate(now, last)[1] - 2.1) < 1e-15);
    BOOST_TEST(integrator.h[0] == 0.3);
    BOOST_TEST(std::abs(integrator.h[1] - 0.2) < 1e-15);
}

BOOST_AUTO_TEST_SUITE_END()
