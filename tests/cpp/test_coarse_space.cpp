// The two-level preconditioner: conjugate gradients take few iterations, however many objects share a motion.
#include "spring_masses.h"

#include <boost/test/unit_test.hpp>

using namespace ringlet;

namespace {

constexpr int masses = 8;

// Stacks of rows of masses with gaps below the activation distance, on springs that are soft compared with the contacts. The
// second stack, if any, is far from the first.
SpringScene stacks(std::initializer_list<int> counts) {
    SpringScene scene;
    double place = 0.0;
    for (const int count : counts) {
        for (int bar = 0; bar < count; ++bar) {
            std::vector<Vec3> at;
            for (int i = 0; i < masses; ++i) at.push_back({place + 0.01 * i, 2e-4 * (bar % 3), 1.6e-3 * bar});
            scene.add_masses(at, 1e-4, 1e-2);
        }
        place += 1.0;
    }
    scene.finish();
    scene.begin(0.02, {0.5, 0.2, -9.81});
    const std::vector<Vec3> &now = scene.configuration->positions;
    scene.objective->find_contacts(scene.touching(), scene.all_objects(), now, now);
    return scene;
}

AlignedVector solution(SpringScene &scene, const LinearSettings &settings, int *iterations = nullptr) {
    AlignedVector direction(scene.blocks->size());
    scene.system->assemble(scene.unknowns(), settings);
    const LinearSystem::Result result = scene.system->solve(settings, direction);
    if (iterations != nullptr) *iterations = result.iterations;
    return direction;
}

} // namespace

BOOST_AUTO_TEST_SUITE(coarse_space)

BOOST_AUTO_TEST_CASE(iterations_do_not_grow_with_what_moves_together) {
    std::vector<int> iterations;
    for (const int count : {16, 64, 256}) {
        SpringScene scene = stacks({count});
        int &of = iterations.emplace_back();
        const AlignedVector direction = solution(scene, {.tolerance = 1e-6}, &of),
                            direct = solution(scene, {.system = System::direct});
        double error = 0.0, size = 0.0;
        for (size_t i = 0; i < direct.size(); ++i)
            error += std::pow(direction[i] - direct[i], 2), size += std::pow(direct[i], 2);
        BOOST_TEST(error < 1e-10 * size);
    }
    BOOST_TEST(iterations[0] > 0);
    BOOST_TEST(4 * iterations[2] <= 5 * iterations[0]);
}

// As they have step lengths of their own, and stop by errors of their own.
BOOST_AUTO_TEST_CASE(a_cluster_is_solved_to_the_same_bits_whatever_else_there_is) {
    SpringScene alone = stacks({12}), together = stacks({12, 40});
    const AlignedVector one = solution(alone, {.tolerance = 0.01}), both = solution(together, {.tolerance = 0.01});
    BOOST_TEST(one.size() == size_t(12) * 3 * masses);
    BOOST_TEST(std::equal(one.data(), one.data() + one.size(), both.data()));
}

BOOST_AUTO_TEST_CASE(the_tolerance_bounds_the_error_in_energy) {
    for (const double tolerance : {0.3, 0.1, 0.01}) {
        SpringScene scene = stacks({40});
        const AlignedVector x = scene.unknowns(), exact = solution(scene, {.tolerance = 1e-12}),
                            direction = solution(scene, {.tolerance = tolerance});
        for (int b = 0; b < scene.blocks->count(); ++b) scene.objective->assemble(b, x);
        const AssembledMatrix whole(*scene.objective);
        SparseMatrix matrix(whole.pattern());
        matrix.assemble(whole.triplets());
        const Eigen::MatrixXd A = matrix.dense();
        const Eigen::Map<const Eigen::VectorXd> d(direction.data(), A.rows()), e(exact.data(), A.rows());
        BOOST_TEST((d - e).dot(A * (d - e)) < tolerance * tolerance * e.dot(A * e));
    }
}

BOOST_AUTO_TEST_SUITE_END()
