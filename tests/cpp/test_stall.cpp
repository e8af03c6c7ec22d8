// A search that finds no step of descent is not the end: the direction itself is tried next. Objects that stay all the same are
// reported.
#include "spring_masses.h"

#include <boost/test/unit_test.hpp>

using namespace ringlet;

namespace {

constexpr double mass = 0.3, spring = 40.0, dt = 0.01;
const Vec3 gravity(0.0, 0.0, -9.81), start(0.1, 0.0, 0.0);
const Vec3 expected = (mass * (start + dt * dt * gravity)) / (mass + dt * dt * spring);

// Its paths bend uphill at once.
class Astray final : public SpringMasses {
public:
    using SpringMasses::SpringMasses;
    void bend(const double *, const double *straight, double *bend) const override {
        for (size_t i = 0; i < unknowns(); ++i) bend[i] = -1e5 * straight[i];
    }
};

// Its energy rises whatever it does, which no gradient can tell.
class Rising final : public SpringMasses {
public:
    using SpringMasses::SpringMasses;
    void energies(const double *, double *of_lanes) override { of_lanes[0] = ++calls_; }

private:
    double calls_ = 0.0;
};

template <class First> struct TwoMasses : SpringScene {
    TwoMasses() {
        add_masses({start}, mass, spring);
        add_masses({start + Vec3(0.0, 0.5, 0.0)}, mass, 0.0);
        masses[0] = std::make_unique<First>(0, 0, std::vector<Vec3>{start}, mass, spring);
        finish();
        masses[0]->anchors()[0] = Vec3::Zero();
    }
};

} // namespace

BOOST_AUTO_TEST_SUITE(stall)

BOOST_AUTO_TEST_CASE(a_path_that_leads_uphill_is_followed_by_the_direction_itself) {
    TwoMasses<Astray> scene;
    const SolverEffort effort = scene.step(dt, gravity, 3);
    BOOST_TEST((scene.masses[0]->positions()[0] - expected).norm() < 1e-12);
    BOOST_TEST(!effort.stalled[0]);
}

BOOST_AUTO_TEST_CASE(what_finds_no_step_stays_and_is_reported_while_the_others_move) {
    TwoMasses<Rising> scene;
    const SolverEffort effort = scene.step(dt, gravity, 5);
    BOOST_TEST((scene.masses[0]->positions()[0] - start).norm() == 0.0);
    BOOST_TEST((scene.masses[1]->positions()[0] - start - Vec3(0.0, 0.5, 0.0) - dt * dt * gravity).norm() < 1e-14);
    BOOST_TEST(effort.stalled[0]);
    BOOST_TEST(!effort.stalled[1]);
    BOOST_TEST(!effort.converged);
    BOOST_TEST(effort.iterations <= 6.0); // it gives up
}

BOOST_AUTO_TEST_CASE(an_extra_iteration_moves_what_stalled_in_the_last) {
    TwoMasses<Astray> scene;
    const SolverEffort effort = scene.step(dt, gravity, 1);
    BOOST_TEST((scene.masses[0]->positions()[0] - expected).norm() < 1e-12);
    BOOST_TEST(!effort.stalled[0]);
    BOOST_TEST(effort.iterations > 1.0);
}

BOOST_AUTO_TEST_SUITE_END()
