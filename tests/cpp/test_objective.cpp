// The objective of a step: energies of contacts shared to objects, their derivatives, and the linear system.
#include "ringlet/math/parallel_copy.h"
#include "spring_masses.h"

#include <boost/test/unit_test.hpp>

#include <Eigen/Eigenvalues>
#include <random>

using namespace ringlet;

namespace {

// Three bars of two masses each that cross closer than their activation distance: two contacts, one cluster. A fourth is alone.
SpringScene crossing_bars(double friction = 0.3) {
    SpringScene scene;
    scene.add_masses({{-0.01, 0.0, 0.0}, {0.01, 0.0, 0.0}}, 2e-3, 1.0);
    scene.add_masses({{0.001, -0.01, 1.5e-3}, {0.001, 0.01, 1.5e-3}}, 1e-3, 2.0);
    scene.add_masses({{-0.01, 0.002, 2.8e-3}, {0.01, 0.002, 2.8e-3}}, 3e-3, 0.5);
    scene.add_masses({{0.5, 0.0, 0.0}, {0.52, 0.0, 0.0}}, 1e-3, 1.0);
    scene.finish(friction);
    return scene;
}

void find_contacts(SpringScene &scene, double damping = 0.0) {
    const std::vector<Vec3> &now = scene.configuration->positions;
    scene.objective->find_contacts(scene.touching(), scene.all_objects(), now, now, damping);
}

// Begins a step; the path along its first Newton direction.
SearchPath newton_path(SpringScene &scene) {
    scene.begin(0.01);
    find_contacts(scene);
    scene.system->assemble(scene.unknowns(), {});
    SearchPath path(scene.blocks->size());
    scene.system->solve({.tolerance = 1e-10}, path.straight);
    return path;
}

// The Hessian that the objective has assembled, as a dense matrix.
Eigen::MatrixXd dense(const Objective &objective) {
    const AssembledMatrix whole(objective);
    SparseMatrix matrix(whole.pattern());
    matrix.assemble(whole.triplets());
    return matrix.dense();
}

} // namespace

BOOST_AUTO_TEST_SUITE(objective)

BOOST_AUTO_TEST_CASE(clusters_are_the_objects_that_contacts_join) {
    SpringScene scene = crossing_bars();
    scene.begin(0.01);
    find_contacts(scene);
    BOOST_TEST(scene.objective->contacts.contacts().size() == 2u);
    BOOST_TEST((scene.objective->couplings.clusters() == std::vector<int>{0, 0, 0, 3}));
    BOOST_TEST(!scene.objective->is_alone(1));
    BOOST_TEST(scene.objective->is_alone(3));
    BOOST_TEST(scene.objective->couplings.count() == 6);
}

BOOST_AUTO_TEST_CASE(what_touches_is_known_where_contacts_are_found_for_some) {
    SpringScene scene = crossing_bars();
    scene.begin(0.01);
    find_contacts(scene);
    Objective &objective = *scene.objective;
    for (int k = 0; k < 2; ++k) objective.contacts.set_lagged_force(k, 1e-2 * (k + 1));
    const std::vector<Vec3> &now = scene.configuration->positions;
    const std::vector<unsigned char> first = {1, 0, 0, 0};
    scene.blocks->activate(first);
    objective.find_contacts(scene.configuration->contact_pairs(first), first, now, now);
    BOOST_TEST(objective.contacts.contacts().size() == 1u);
    BOOST_TEST(objective.contacts.contacts()[0].friction.normal_force == 1e-2);
    BOOST_TEST((objective.with_touched({0, 0, 1, 0}) == std::vector<unsigned char>{0, 1, 1, 0}));
    scene.blocks->activate_all();
    find_contacts(scene);
    BOOST_TEST(objective.contacts.contacts().size() == 2u);
    BOOST_TEST(objective.contacts.contacts()[1].friction.normal_force == 2e-2);
}

BOOST_AUTO_TEST_CASE(the_gradient_is_the_derivative_of_the_energy) {
    SpringScene scene = crossing_bars();
    scene.begin(0.01, {0.3, -0.2, -9.81});
    find_contacts(scene);
    Objective &objective = *scene.objective;
    for (int k = 0; k < 2; ++k) objective.contacts.set_lagged_force(k, 1e-2);
    find_contacts(scene); // with friction
    AlignedVector x = scene.unknowns();
    scene.system->assemble(x, {});
    const ReachablePairs pairs = scene.configuration->pairs.reachable_pairs(scene.blocks->active_objects());
    const auto energy = [&](const AlignedVector &at) {
        std::vector<double> of_objects;
        objective.exact_energies(at, pairs, std::vector<double>(4, 0.0), std::vector<unsigned char>(4, 1), of_objects);
        return of_objects[0] + of_objects[1] + of_objects[2] + of_objects[3];
    };
    std::vector<double> unused;
    objective.energies_at_linearisation(unused);
    const double h = 1e-8;
    for (size_t i = 0; i < x.size(); ++i) {
        AlignedVector more = parallel_copy(x), less = parallel_copy(x);
        more[i] += h, less[i] -= h;
        const int block = int(i / 6);
        const double slope = (energy(more) - energy(less)) / (2 * h), gradient = (*scene.blocks)[block].gradient()[i % 6];
        BOOST_TEST(std::abs(slope - gradient) < 1e-5 * (1e-3 + std::abs(gradient)));
    }
}

BOOST_AUTO_TEST_CASE(the_models_of_the_contact_energy_agree_where_contacts_were_linearised) {
    SpringScene scene = crossing_bars();
    scene.begin(0.01);
    find_contacts(scene);
    const AlignedVector x = scene.unknowns();
    scene.system->assemble(x, {});
    const std::vector<unsigned char> all(4, 1);
    std::vector<double> known, exact;
    scene.objective->energies_at_linearisation(known);
    const ReachablePairs pairs = scene.configuration->pairs.reachable_pairs(scene.blocks->active_objects());
    scene.objective->exact_energies(x, pairs, std::vector<double>(4, 0.0), all, exact);
    for (int object = 0; object < 4; ++object) BOOST_TEST(exact[object] == known[object], boost::test_tools::tolerance(1e-12));
    BOOST_TEST(known[0] > 0.0);
}

BOOST_AUTO_TEST_CASE(conjugate_gradients_and_the_direct_solver_find_the_newton_direction) {
    SpringScene scene = crossing_bars();
    scene.begin(0.01, {0.0, 0.0, -9.81});
    find_contacts(scene);
    const AlignedVector x = scene.unknowns();
    AlignedVector direction(scene.blocks->size()), direct(scene.blocks->size());
    scene.system->assemble(x, {.system = System::direct});
    scene.system->solve({.system = System::direct}, direct);
    scene.system->assemble(x, {.tolerance = 1e-12});
    const LinearSystem::Result result = scene.system->solve({.tolerance = 1e-12}, direction);
    BOOST_TEST(result.iterations > 0);
    BOOST_TEST(result.residual < 1e-11);
    for (size_t i = 0; i < x.size(); ++i) BOOST_TEST(std::abs(direction[i] - direct[i]) < 1e-12);

    // Against the dense matrix, whose blocks have to be assembled anew: the factors stand in their place.
    for (int b = 0; b < 4; ++b) scene.objective->assemble(b, x);
    const Eigen::MatrixXd A = dense(*scene.objective);
    BOOST_TEST((A - A.transpose()).norm() < 1e-12 * A.norm());
    BOOST_TEST(Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(A).eigenvalues()[0] > 0.0);
    Eigen::VectorXd d(24), b(24);
    for (int i = 0; i < 24; ++i) d[i] = direction[i], b[i] = -(*scene.blocks)[i / 6].gradient()[i % 6];
    BOOST_TEST((A * d - b).norm() < 1e-9 * b.norm());
}

BOOST_AUTO_TEST_CASE(the_couplings_are_the_off_diagonal_part_of_the_hessian) {
    SpringScene scene = crossing_bars();
    scene.begin(0.01);
    find_contacts(scene);
    scene.objective->linearise_contacts(scene.unknowns());
    for (int b = 0; b < 4; ++b) scene.objective->assemble(b, scene.unknowns());
    Eigen::MatrixXd C = dense(*scene.objective);
    for (int b = 0; b < 4; ++b) C.block<6, 6>(6 * b, 6 * b).setZero();
    std::mt19937 engine(3);
    std::uniform_real_distribution<> some(-1.0, 1.0);
    Eigen::VectorXd p(24);
    for (int i = 0; i < 24; ++i) p[i] = some(engine);
    Couplings &couplings = scene.objective->couplings;
    std::vector<Vec3> at_points;
    for (int k = 0; k < couplings.count(); ++k) at_points.push_back(p.segment<3>(3 * couplings.vertex(k)));
    couplings.multiply(at_points, scene.objective->pair_values(), std::vector<unsigned char>(4, 1));
    const Eigen::VectorXd expected = C * p;
    for (int k = 0; k < couplings.count(); ++k)
        BOOST_TEST((couplings.product(k) - expected.segment<3>(3 * couplings.vertex(k))).norm() < 1e-10 * expected.norm());
}

BOOST_AUTO_TEST_CASE(damping_resists_relative_motion_and_changes_neither_forces_nor_joint_motion) {
    SpringScene scene = crossing_bars(0.0);
    scene.begin(0.01);
    const AlignedVector x = scene.unknowns();
    const auto assembled = [&](double damping) {
        find_contacts(scene, damping);
        scene.objective->linearise_contacts(x);
        for (int b = 0; b < 4; ++b) scene.objective->assemble(b, x);
        Eigen::VectorXd gradient(24);
        for (int i = 0; i < 24; ++i) gradient[i] = (*scene.blocks)[i / 6].gradient()[i % 6];
        return std::pair{dense(*scene.objective), gradient};
    };
    const auto [plain, force] = assembled(0.0);
    const auto [damped, same_force] = assembled(0.03);
    BOOST_TEST((force - same_force).norm() == 0.0);
    const Eigen::MatrixXd added = damped - plain;
    Eigen::VectorXd joint(24), alone = Eigen::VectorXd::Zero(24);
    for (int i = 0; i < 24; ++i) joint[i] = i % 3 == 1 ? 1.0 : 0.0;
    alone[0] = alone[3] = 1.0; // one bar alone
    BOOST_TEST((added * joint).norm() < 1e-12 * added.norm());
    double expected = 0.0;
    for (const Contact &contact : scene.objective->contacts.contacts()) {
        BOOST_TEST(contact.damping.coefficient == 0.03 * contact.barrier.stiffness);
        if (scene.table.object_of(contact.at.vertex[0]) == 0) expected += contact.damping.coefficient;
    }
    BOOST_TEST(alone.dot(added * alone) == expected, boost::test_tools::tolerance(1e-9));
}

BOOST_AUTO_TEST_CASE(damped_pairs_are_contacts_beyond_their_own_activation_distance_and_do_not_push) {
    SpringScene scene = crossing_bars();
    scene.begin(0.01);
    ContactSet &contacts = scene.objective->contacts;
    const std::vector<Vec3> now = scene.configuration->positions;
    contacts.begin(scene.table.mesh, scene.table.material, scene.touching(), {}, now); // each activates at its initial gap
    find_contacts(scene);
    BOOST_TEST(contacts.contacts().empty());
    find_contacts(scene, 0.03);
    BOOST_REQUIRE(contacts.contacts().size() == 2u);
    for (const Contact &contact : contacts.contacts()) {
        BOOST_TEST(contact.force() == 0.0);
        BOOST_TEST(contact.damping.coefficient > 0.0);
    }
    scene.system->assemble(scene.unknowns(), {});
    AlignedVector together(scene.blocks->size());
    for (size_t i = 0; i < together.size(); ++i) together[i] = i % 3 == 2 && i < 6 ? 1e-3 : 0.0; // one bar into another
    scene.objective->lag_normal_forces(together);
    for (const LaggedForce &lagged : contacts.lagged_forces()) BOOST_TEST(lagged.force == 0.0);
}

BOOST_AUTO_TEST_CASE(a_direct_solver_that_fails_says_so) {
    SpringScene scene;
    scene.add_masses({{0.0, 0.0, 0.0}, {0.01, 0.0, 0.0}}, 1e-4, -1e6); // springs that push
    scene.finish();
    scene.begin(0.01);
    find_contacts(scene);
    AlignedVector direction(scene.blocks->size());
    scene.system->assemble(scene.unknowns(), {.system = System::direct});
    BOOST_CHECK_THROW(scene.system->solve({.system = System::direct}, direction), FactorisationError);
}

BOOST_AUTO_TEST_CASE(both_solvers_leave_blocks_where_they_are_that_are_not_active) {
    SpringScene scene = crossing_bars();
    scene.begin(0.01, {0.0, 0.0, -9.81});
    scene.blocks->activate({0, 1, 1, 0});
    find_contacts(scene);
    const AlignedVector x = scene.unknowns();
    AlignedVector iterated(scene.blocks->size()), direct(scene.blocks->size());
    scene.system->assemble(x, {.tolerance = 1e-12});
    scene.system->solve({.tolerance = 1e-12}, iterated);
    scene.system->assemble(x, {.system = System::direct});
    scene.system->solve({.system = System::direct}, direct);
    for (size_t i = 0; i < x.size(); ++i) BOOST_TEST(std::abs(iterated[i] - direct[i]) < 1e-12);
    for (size_t i = 0; i < 6; ++i) BOOST_TEST(direct[i] == 0.0);
    BOOST_TEST(direct[8] != 0.0);
}

BOOST_AUTO_TEST_CASE(the_line_search_shortens_a_cluster_and_leaves_the_others_alone) {
    SpringScene scene = crossing_bars();
    SearchPath path = newton_path(scene);
    const AlignedVector x = scene.unknowns();
    for (size_t i = 0; i < 18; ++i) path.straight[i] *= 3.0; // the cluster overshoots: its energy would rise
    AlignedVector to = parallel_copy(x);
    const ReachablePairs pairs = scene.configuration->pairs.reachable_pairs(scene.blocks->active_objects());
    const LineSearchResult found = line_search(*scene.objective, pairs, path, std::vector<unsigned char>(4, 0), to);
    BOOST_TEST(found.cuts > 0);
    BOOST_TEST(found.step[0] < 1.0);
    BOOST_TEST(found.step[3] == 1.0);
    for (size_t i = 0; i < x.size(); ++i) BOOST_TEST(std::abs(to[i] - x[i] - found.step[i / 6] * path.straight[i]) < 1e-15);
}

BOOST_AUTO_TEST_CASE(the_line_search_shortens_the_objects_that_cause_the_excess_of_their_cluster) {
    SpringScene scene = crossing_bars();
    SearchPath path = newton_path(scene);
    const AlignedVector x = scene.unknowns();
    for (size_t i = 0; i < 6; ++i)
        path.straight[i] *= 3.0; // bar 0 overshoots far, and bar 2, which does not touch it, a little
    for (size_t i = 12; i < 18; ++i) path.straight[i] *= 2.05;
    const ReachablePairs pairs = scene.configuration->pairs.reachable_pairs(scene.blocks->active_objects());
    const auto steps = [&](const std::vector<unsigned char> &accepted) {
        AlignedVector to = parallel_copy(x);
        return line_search(*scene.objective, pairs, path, accepted, to).step;
    };
    BOOST_TEST(steps({1, 1, 0, 1})[2] < 1.0); // its energy rises
    const std::vector<double> step = steps({0, 0, 0, 0});
    BOOST_TEST(step[0] < 1.0);
    BOOST_TEST(step[1] == step[0]); // which touches it
    BOOST_TEST(step[2] == 1.0);
}

BOOST_AUTO_TEST_CASE(an_initial_overlap_has_only_its_own_activation_distance_to_build_its_force_in) {
    SpringScene scene = crossing_bars();
    scene.begin(0.01);
    ContactSet &contacts = scene.objective->contacts;
    const std::vector<Vec3> now = scene.configuration->positions;
    contacts.begin(scene.table.mesh, scene.table.material, scene.touching(), {}, now); // gaps of 0.75 and 0.65 of d̂
    contacts.overlaps.grow(1e-4);
    find_contacts(scene);
    BOOST_REQUIRE(contacts.contacts().size() == 2u);
    for (const Contact &contact : contacts.contacts()) {
        BOOST_TEST(contact.barrier.d_hat < 0.9 * 2.0 * SpringScene::radius);
        BOOST_TEST(contact.loaded_fraction == contact.barrier.d_hat / (2.0 * SpringScene::radius),
                   boost::test_tools::tolerance(1e-12));
    }
}

BOOST_AUTO_TEST_CASE(a_shortened_path_is_the_beginning_of_the_path) {
    SpringScene scene = crossing_bars();
    scene.begin(0.01);
    const AlignedVector x = scene.unknowns();
    SearchPath path(scene.blocks->size());
    std::mt19937 engine(5);
    std::uniform_real_distribution<> some(-1.0, 1.0);
    for (size_t i = 0; i < x.size(); ++i) path.straight[i] = some(engine), path.bend[i] = some(engine);
    const std::vector<double> t = {0.3, 0.5, 1.0, 0.0}, whole(4, 1.0);
    const std::vector<unsigned char> all(4, 1);
    AlignedVector partway(x.size()), at_the_end(x.size());
    move_along(*scene.blocks, x, t, path, all, partway);
    shorten(*scene.blocks, t, path);
    move_along(*scene.blocks, x, whole, path, all, at_the_end);
    for (size_t i = 0; i < x.size(); ++i) BOOST_TEST(std::abs(partway[i] - at_the_end[i]) < 1e-14);
    straighten(*scene.blocks, {1, 0, 0, 0}, path);
    for (size_t i = 0; i < x.size(); ++i) BOOST_TEST((path.bend[i] == 0.0) == (i < 6 || i >= 18));
}

BOOST_AUTO_TEST_CASE(a_direction_that_is_not_finite_is_not_taken) {
    SpringScene scene = crossing_bars();
    scene.begin(0.01);
    AlignedVector direction(scene.blocks->size());
    direction.fill(0.25);
    direction[7] = std::numeric_limits<double>::quiet_NaN();
    std::vector<double> largest(4, 0.0);
    measure_direction(*scene.blocks, direction, largest);
    BOOST_TEST((largest == std::vector<double>{0.25, 0.0, 0.25, 0.25}));
    for (size_t i = 0; i < direction.size(); ++i) BOOST_TEST(direction[i] == (i / 6 == 1 ? 0.0 : 0.25));
}

BOOST_AUTO_TEST_CASE(gathered_positions_are_those_that_were_scattered) {
    SpringScene scene = crossing_bars();
    scene.begin(0.01);
    std::vector<Vec3> positions(8);
    scene.blocks->gather(scene.unknowns(), positions);
    BOOST_TEST((positions == scene.configuration->positions));
    BOOST_TEST(scene.blocks->size() == 24u);
    BOOST_TEST(scene.blocks->dofs(5) == 3);
}

BOOST_AUTO_TEST_CASE(objects_that_were_limited_but_are_not_stretched_need_no_more_iterations) {
    SpringScene scene = crossing_bars();
    scene.begin(0.01);
    find_contacts(scene);
    Refinement refinement(*scene.objective);
    std::vector<Vec3> now = scene.configuration->positions, wanted = now, to = now;
    wanted[0].x() += 1.0, to[0].x() += 0.1;
    const ObjectMoves limited(*scene.blocks, now, wanted, to);
    BOOST_TEST(!limited.are_full());
    refinement.add(limited, 1e-6);
    const std::vector<unsigned char> none(scene.blocks->objects(), 0);
    BOOST_TEST(!refinement.activate_unfinished(*scene.blocks, now, none));
    BOOST_TEST(ObjectMoves(*scene.blocks, now, wanted, wanted).are_full());
}

BOOST_AUTO_TEST_SUITE_END()
