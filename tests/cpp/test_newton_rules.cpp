// The rules of Newton's method: damping, stopping, and what is tried with objects that do not move.
#include "ringlet/solver/newton_rules.h"
#include "spring_masses.h"

#include <boost/test/unit_test.hpp>

using namespace ringlet;

namespace {

// Two bars that touch and a third that is alone.
SpringScene bars() {
    SpringScene scene;
    for (const double height : {0.0, 1.5e-3, 1.0}) scene.add_masses({{0.0, 0.0, height}, {0.01, 0.0, height}}, 1e-4, 1e-2);
    scene.finish();
    scene.begin(0.02);
    const std::vector<Vec3> &now = scene.configuration->positions;
    scene.objective->find_contacts(scene.touching(), scene.all_objects(), now, now);
    return scene;
}

using Objects = std::vector<unsigned char>;

} // namespace

BOOST_AUTO_TEST_SUITE(newton_rules)

BOOST_AUTO_TEST_CASE(damping_comes_to_nothing) {
    RelativeDamping damping(true), none(false);
    BOOST_TEST(damping.part() > 0.0);
    BOOST_TEST(none.part() == 0.0);
    for (int iteration = 0; iteration < 10; ++iteration) damping.end_iteration();
    BOOST_TEST(damping.part() == 0.0);
}

BOOST_AUTO_TEST_CASE(a_cluster_converges_as_a_whole_and_stays_from_then_on) {
    const SpringScene scene = bars();
    StoppingRule stopping(3, 1e-6);
    stopping.measure(*scene.objective, {0.0, 1e-3, 0.0});
    BOOST_TEST((stopping.converged() == Objects{0, 0, 1}));
    BOOST_TEST((stopping.part() == std::vector<double>{1.0, 1.0, 1.0})); // it takes its last direction
    stopping.measure(*scene.objective, {0.0, 1e-3, 0.0});
    BOOST_TEST((stopping.part() == std::vector<double>{1.0, 1.0, 0.0}));
    BOOST_TEST(!stopping.all_converged());
    stopping.measure(*scene.objective, {0.0, 1e-7, 0.0});
    BOOST_TEST(stopping.all_converged());
}

BOOST_AUTO_TEST_CASE(an_object_that_caution_does_not_help_is_stuck) {
    const SpringScene scene = bars();
    const std::vector<int> &cluster = scene.objective->couplings.clusters();
    const std::vector<double> large(3, 1.0);
    Stall stall(3);
    stall.add_steps(*scene.blocks, cluster, {0.0, 0.5, 0.0}, false);
    BOOST_TEST((stall.cautious() == Objects{0, 0, 1})); // a cluster of which one moves is not
    BOOST_TEST((stall.may_move(large, 1e-6) == Objects{1, 0, 1}));
    stall.add_steps(*scene.blocks, cluster, {0.0, 0.5, 0.0}, false);
    BOOST_TEST((stall.stalled(large, 1e-6) == Objects{1, 0, 1}));
    BOOST_TEST((stall.may_move(large, 1e-6) == Objects{1, 0, 0}));
    BOOST_TEST((stall.stalled({0.0, 0.0, 0.0}, 1e-6) == Objects{0, 0, 0})); // at rest
}

BOOST_AUTO_TEST_SUITE_END()
