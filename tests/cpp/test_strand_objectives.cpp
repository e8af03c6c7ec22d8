// Objectives of whole strands, away from rest, with references of another shape, damping and held vertices. Gradients agree
// with finite differences in all unknowns, and Hessians are positive definite.
#include "ringlet/strand/hinge/objective.h"
#include "ringlet/strand/rod_objective.h"

#include <Eigen/Dense>
#include <Eigen/Eigenvalues>
#include <boost/test/unit_test.hpp>
#include <random>
#include <vector>

using namespace ringlet::baseline;

namespace {

constexpr int vertices = 9;

Vec<double> random_unit(std::mt19937 &random) {
    std::normal_distribution<double> normal;
    const Vec<double> v{normal(random), normal(random), normal(random)};
    return (1 / norm(v)) * v;
}

// Random walk with random rest values and references; the first three vertices are held.
template <class Objective> struct RandomStrand {
    explicit RandomStrand(int seed) : random(seed), rows(vertices), shapes(vertices), x(Objective::dofs * vertices) {
        std::uniform_real_distribution<double> uniform(0.3, 1.2);
        Vec<double> p{};
        for (int i = 0; i < vertices; ++i) {
            typename Objective::Row &r = rows[i];
            const bool edge = i + 1 < vertices, corner = edge && i > 0, hinge = i > 0 && i + 2 < vertices;
            r = {};
            r.free = i > 2;
            r.inertia = uniform(random);
            r.inertia_target = random_unit(random);
            r.rest_length = uniform(random);
            r.damped_length = uniform(random);
            r.stretch_stiffness = edge * uniform(random);
            r.bend_stiffness = corner * uniform(random);
            r.twist_stiffness = hinge * uniform(random);
            r.rest_angle = uniform(random);
            r.rest_dihedral = uniform(random);
            const Vec<double> damped = 0.1 * random_unit(random);
            if constexpr (Objective::has_frames) {
                r.frame_free = corner && i > 1;
                r.damped_curvature1 = damped.x;
                r.damped_curvature2 = damped.y;
            } else {
                r.damped_angle = r.rest_angle;
                r.fade = 0.7;
            }
            r.damped_strain = 0.1;
            if constexpr (has_plane<typename Objective::Row>) {
                const Vec<double> normal = random_unit(random);
                r.plane = {normal, dot(normal, p) + (i % 2 ? 0.2 : -0.2), 3 * uniform(random)}; // behind every other one
            }
            r.reference.tangent = random_unit(random);
            r.reference.normal = perpendicular(r.reference.tangent);
            for (int k = 0; k < 3; ++k) x[Objective::dofs * i + k] = p[k];
            if (Objective::dofs == 4) x[4 * i + 3] = 0.3 * uniform(random);
            p = p + 0.8 * random_unit(random);
        }
    }
    std::mt19937 random;
    std::vector<typename Objective::Row> rows;
    std::vector<typename Objective::Shape> shapes;
    std::vector<double> x;
};

bool is_free(const RodRow<double> &row, int component) { return (component < 3 ? row.free : row.frame_free) != 0; }
bool is_free(const HingeRow<double> &row, int) { return row.free != 0; }

Vec<double> position_of(const std::vector<double> &x, int i) { return RodObjective<double>::position(x.data(), i); }

template <class Objective> void derivatives_agree_with_differences() {
    for (int seed = 0; seed < 20; ++seed) {
        RandomStrand<Objective> strand(seed);
        Objective objective(vertices, strand.rows.data(), strand.shapes.data());
        const int size = objective.size();
        std::vector<double> gradient(size), memory(Objective::Matrix::entries(size));
        typename Objective::Matrix hessian(memory.data(), size);
        objective.evaluate(strand.x.data());
        objective.assemble(gradient.data(), hessian);

        double largest = 0;
        for (const double g : gradient) largest = std::max(largest, std::abs(g));
        for (int k = 0; k < size; ++k) {
            const int vertex = k / Objective::dofs, component = k % Objective::dofs;
            if (!is_free(strand.rows[vertex], component)) {
                BOOST_TEST(gradient[k] == 0);
                continue;
            }
            const double at = strand.x[k], h = 1e-6;
            strand.x[k] = at + h;
            const double up = objective.evaluate(strand.x.data());
            strand.x[k] = at - h;
            const double down = objective.evaluate(strand.x.data());
            strand.x[k] = at;
            BOOST_TEST(std::abs(gradient[k] - (up - down) / (2 * h)) < 2e-7 * largest);
        }

        Eigen::MatrixXd dense = Eigen::MatrixXd::Zero(size, size);
        for (int c = 0; c < size; ++c)
            for (int r = c; r < std::min(size, c + Objective::Matrix::rows(c)); ++r)
                dense(r, c) = dense(c, r) = hessian.entry(c)[r - c];
        BOOST_TEST(Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(dense).eigenvalues()[0] > 0);
    }
}

// Scratch memory of one objective serves others between its phases.
template <class Objective> void objectives_may_share_shapes() {
    RandomStrand<Objective> one(1), other(2);
    Objective first(vertices, one.rows.data(), one.shapes.data());
    std::vector<double> alone(first.size()), shared(first.size()), memory(Objective::Matrix::entries(first.size()));
    typename Objective::Matrix hessian(memory.data(), first.size());
    first.evaluate(one.x.data());
    first.assemble(alone.data(), hessian);
    std::vector<double> strains;
    for (int i = 0; i < vertices; ++i)
        for (const double strain : first.strains(i).values) strains.push_back(strain);
    for (typename Objective::Shape &shape : other.shapes) { // of before
        shape.strain = 1e9;
        if constexpr (Objective::has_frames)
            shape.curvature1 = 1e9;
        else
            shape.sigma = 1e9;
    }
    first.use(other.shapes.data());
    first.evaluate(one.x.data());
    first.assemble(shared.data(), hessian);
    BOOST_TEST(alone == shared, boost::test_tools::per_element());
    for (int i = 0, k = 0; i < vertices; ++i)
        for (const double strain : first.strains(i).values) BOOST_TEST(strain == strains[k++]);
}

} // namespace

BOOST_AUTO_TEST_SUITE(strand_objectives)

BOOST_AUTO_TEST_CASE(shapes_are_scratch_memory) {
    objectives_may_share_shapes<RodObjective<double>>();
    objectives_may_share_shapes<HingeObjective<double, true>>();
}

BOOST_AUTO_TEST_CASE(hinge_with_history) { derivatives_agree_with_differences<HingeObjective<double, true>>(); }

BOOST_AUTO_TEST_CASE(hinge_with_least_energy) { derivatives_agree_with_differences<HingeObjective<double, false>>(); }

BOOST_AUTO_TEST_CASE(material_frame) { derivatives_agree_with_differences<RodObjective<double>>(); }

BOOST_AUTO_TEST_CASE(material_frame_at_planes) { derivatives_agree_with_differences<RodObjective<double, PlaneRow<double>>>(); }

// Each free edge rotates about an axis of its own, by about half a radian.
BOOST_AUTO_TEST_CASE(edges_that_rotate_keep_their_lengths) {
    RandomStrand<RodObjective<double>> strand(1);
    RodObjective<double> objective(vertices, strand.rows.data(), strand.shapes.data());
    std::vector<double> direction(objective.size(), 0.0), to(objective.size());
    for (int i = 3; i < vertices; ++i) {
        const Vec<double> edge = position_of(strand.x, i) - position_of(strand.x, i - 1);
        const Vec<double> d = position_of(direction, i - 1) + cross(0.5 * random_unit(strand.random), edge);
        for (int k = 0; k < 3; ++k) direction[4 * i + k] = d[k];
    }
    objective.curved_path(strand.x.data(), 1.0, direction.data(), to.data());
    double straight = 0.0;
    for (int i = 1; i < vertices; ++i) {
        const Vec<double> edge = position_of(strand.x, i) - position_of(strand.x, i - 1),
                          rotated = position_of(to, i) - position_of(to, i - 1);
        BOOST_TEST(std::abs(norm(rotated) - norm(edge)) < 1e-12);
        straight = std::max(straight, norm(edge + position_of(direction, i) - position_of(direction, i - 1)) - norm(edge));
        if (i < 3) BOOST_TEST(norm(position_of(to, i) - position_of(strand.x, i)) == 0.0);
    }
    BOOST_TEST(straight > 0.05);
}

// A held tip stays where it is.
BOOST_AUTO_TEST_CASE(the_curved_path_is_the_direction_to_first_order) {
    for (const bool tip_held : {false, true}) {
        RandomStrand<RodObjective<double>> strand(2);
        if (tip_held) strand.rows[vertices - 1].free = 0.0;
        RodObjective<double> objective(vertices, strand.rows.data(), strand.shapes.data());
        std::vector<double> direction(objective.size(), 0.0), to(objective.size());
        for (int i = 0; i < vertices; ++i)
            for (int k = 0; k < 4; ++k) direction[4 * i + k] = strand.rows[i].free * random_unit(strand.random)[k % 3];
        const auto deviation = [&](double step) {
            objective.curved_path(strand.x.data(), step, direction.data(), to.data());
            double most = 0.0;
            for (int i = 0; i < objective.size(); ++i)
                most = std::max(most, std::abs(to[i] - strand.x[i] - step * direction[i]));
            return most;
        };
        BOOST_TEST(deviation(1e-3) > 1e-8); // of second order
        BOOST_TEST(deviation(1e-3) / deviation(5e-4) > 3.8);
        BOOST_TEST(deviation(1e-3) / deviation(5e-4) < 4.2);
        deviation(1.0);
        if (tip_held) BOOST_TEST(norm(position_of(to, vertices - 1) - position_of(strand.x, vertices - 1)) == 0.0);
    }
}

namespace {

// A free strand with the direction, of its vertices and frames, of a rigid rotation about its first vertex, across the first
// edge: that has no frame.
struct RotatingStrand : RandomStrand<RodObjective<double>> {
    RotatingStrand(int seed, double angle) : RandomStrand(seed), direction(x.size(), 0.0) {
        const Vec<double> first = position_of(x, 1) - position_of(x, 0), across = cross(first, random_unit(random));
        const Vec<double> omega = (angle / norm(across)) * across;
        for (int i = 0; i < vertices; ++i) {
            RodRow<double> &r = rows[i];
            r.free = 1.0;
            r.rest_angle += 0.1; // curved everywhere
            r.frame_free = i > 0 && i + 1 < vertices;
            const Vec<double> d = cross(omega, position_of(x, i) - position_of(x, 0));
            for (int k = 0; k < 3; ++k) direction[4 * i + k] = d[k];
            if (i + 1 == vertices) break;
            const Vec<double> edge = position_of(x, i + 1) - position_of(x, i);
            const Vec<double> t = (1.0 / norm(edge)) * edge, about = spin(r.reference.tangent, t, norm(edge));
            direction[4 * i + 3] = r.rest_length * r.frame_free * (dot(omega, t) - dot(about, cross(omega, edge)));
        }
    }
    std::vector<double> direction;
};

} // namespace

BOOST_AUTO_TEST_CASE(a_rigid_rotation_strains_nothing) {
    for (int seed = 0; seed < 10; ++seed) {
        RotatingStrand strand(seed, 1.2);
        for (RodRow<double> &r : strand.rows) r.inertia = 0.0;
        RodObjective<double> objective(vertices, strand.rows.data(), strand.shapes.data());
        std::vector<double> to(objective.size()), straight(objective.size());
        objective.curved_path(strand.x.data(), 1.0, strand.direction.data(), to.data());
        for (int i = 0; i < objective.size(); ++i) straight[i] = strand.x[i] + strand.direction[i];
        const double energy = objective.energy(strand.x.data());
        BOOST_TEST(std::abs(objective.energy(to.data()) - energy) < 1e-12 * energy);
        BOOST_TEST(std::abs(objective.energy(straight.data()) - energy) > 0.01 * energy);
    }
}

// A solver may leave some strands of a group where they are.
BOOST_AUTO_TEST_CASE(without_a_direction_nothing_changes_by_a_bit) {
    RandomStrand<RodObjective<double>> strand(6);
    RodObjective<double> objective(vertices, strand.rows.data(), strand.shapes.data());
    std::vector<double> direction(objective.size(), 0.0), to(objective.size());
    objective.curved_path(strand.x.data(), 1.0, direction.data(), to.data());
    BOOST_TEST(to == strand.x, boost::test_tools::per_element());
}

// Loads pull along every edge, so that none is left to the stiffness of its stretch.
BOOST_AUTO_TEST_CASE(with_its_curvature_the_hessian_is_that_along_a_rotation) {
    for (int seed = 0; seed < 10; ++seed) {
        RotatingStrand strand(seed, 1.0);
        Vec<double> before{};
        for (int i = 0; i < vertices; ++i) {
            RodRow<double> &r = strand.rows[i];
            Vec<double> after{};
            if (i + 1 < vertices) {
                const Vec<double> edge = position_of(strand.x, i + 1) - position_of(strand.x, i);
                after = 2.0 * edge + 0.3 * random_unit(strand.random); // the load behind
                r.damped_length = norm(edge);
            }
            r.inertia_target = position_of(strand.x, i) + (1.0 / r.inertia) * (before - after);
            before = after;
        }
        RodObjective<double> objective(vertices, strand.rows.data(), strand.shapes.data());
        const int size = objective.size();
        std::vector<double> gradient(size), memory(RodObjective<double>::Matrix::entries(size)), to(size);
        RodObjective<double>::Matrix hessian(memory.data(), size);
        const double energy = objective.evaluate(strand.x.data());
        const auto second = [&] {
            double sum = 0.0;
            for (int c = 0; c < size; ++c)
                for (int k = 0; k < std::min(RodObjective<double>::Matrix::rows(c), size - c); ++k)
                    sum += (k > 0 ? 2.0 : 1.0) * hessian.entry(c)[k] * strand.direction[c] * strand.direction[c + k];
            return sum;
        };
        objective.assemble(gradient.data(), hessian);
        const double gauss_newton = second();
        objective.assemble_along_paths(gradient.data(), hessian, 1.0, [](int, int, double) {}, [](int) {});
        const auto along = [&](double step) {
            objective.curved_path(strand.x.data(), step, strand.direction.data(), to.data());
            return objective.energy(to.data());
        };
        const double h = 1e-3, difference = (along(h) - 2.0 * energy + along(-h)) / (h * h);
        BOOST_TEST(std::abs(second() - difference) < 1e-4 * std::abs(difference)); // frames are regularised by 1e-5
        BOOST_TEST(std::abs(gauss_newton - difference) > 0.01 * std::abs(difference));
    }
}

// Where the curvature of paths would leave too little of it, the Hessian is the one without.
BOOST_AUTO_TEST_CASE(the_hessian_along_paths_is_definite_or_without_their_curvature) {
    int with_curvature = 0;
    for (int seed = 0; seed < 20; ++seed) {
        RotatingStrand strand(seed, 1.0);
        for (int i = 0; seed % 2 && i < vertices; ++i) { // without loads, against a large inertia
            strand.rows[i].inertia *= 1e3;
            strand.rows[i].inertia_target = position_of(strand.x, i);
        }
        RodObjective<double> objective(vertices, strand.rows.data(), strand.shapes.data());
        objective.evaluate(strand.x.data());
        const int size = objective.size();
        const size_t entries = RodObjective<double>::Matrix::entries(size);
        std::vector<double> gradient(size), without(entries), with(entries), got(entries);
        RodObjective<double>::Matrix plain(without.data(), size), curved(with.data(), size), hessian(got.data(), size);
        objective.assemble(gradient.data(), plain);
        objective.assemble_along_paths(gradient.data(), curved, 1.0, [](int, int, double) {}, [](int) {});
        double used = 1.0;
        objective.assemble(gradient.data(), hessian, used);
        BOOST_TEST(got == (used == 1.0 ? with : without), boost::test_tools::per_element());
        // Least part of the matrix without curvature that is left in some direction, by dense algebra.
        const auto dense = [&](RodObjective<double>::Matrix &matrix) {
            Eigen::MatrixXd all = Eigen::MatrixXd::Zero(size, size);
            for (int c = 0; c < size; ++c)
                for (int k = 0; k < std::min(RodObjective<double>::Matrix::rows(c), size - c); ++k)
                    all(c, c + k) = all(c + k, c) = matrix.entry(c)[k];
            return all;
        };
        const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> left(dense(curved), dense(plain));
        const double least = left.eigenvalues().minCoeff();
        BOOST_TEST(used == (least > RodObjective<double>::curvature_reserve ? 1.0 : 0.0));
        with_curvature += int(used);
    }
    BOOST_TEST(with_curvature > 0);
    BOOST_TEST(with_curvature < 20);
}

BOOST_AUTO_TEST_CASE(the_largest_step_changes_an_edge_by_twice_its_length) {
    RandomStrand<RodObjective<double>> strand(4);
    RodObjective<double> objective(vertices, strand.rows.data(), strand.shapes.data());
    std::vector<double> direction(objective.size(), 0.0);
    BOOST_TEST(objective.max_step(strand.x.data(), direction.data()) == 1.0);
    const double length = std::max(0.8, strand.rows[vertices - 2].rest_length);
    direction[4 * (vertices - 1)] = 10.0 * length;
    BOOST_TEST(std::abs(objective.max_step(strand.x.data(), direction.data()) - 0.2) < 1e-12);
}

// The fades of the twist belong to the step: its initial energy is compared with the energies that follow.
BOOST_AUTO_TEST_CASE(the_energy_at_the_start_is_that_of_the_step) {
    RandomStrand<HingeObjective<double, true>> strand(5);
    HingeObjective<double, true> objective(vertices, strand.rows.data(), strand.shapes.data());
    const double start = objective.begin(strand.x.data());
    BOOST_TEST(start == objective.evaluate(strand.x.data()));
}

BOOST_AUTO_TEST_CASE(a_rotation_of_a_straight_strand_about_its_own_axis_costs_no_energy) {
    // With a straight rest shape, all frames may rotate together.
    RandomStrand<RodObjective<double>> strand(3);
    for (int i = 0; i < vertices; ++i) {
        RodRow<double> &r = strand.rows[i];
        r.free = r.inertia = r.rest_angle = r.rest_dihedral = r.damped_strain = 0;
        r.damped_curvature1 = r.damped_curvature2 = 0;
        r.frame_free = i > 0 && i + 1 < vertices;
        r.rest_length = 1;
        r.reference.tangent = {1, 0, 0};
        r.reference.normal = {0, 1, 0};
        for (int k = 0; k < 4; ++k) strand.x[4 * i + k] = k == 0 ? i : 0;
    }
    RodObjective<double> objective(vertices, strand.rows.data(), strand.shapes.data());
    const double before = objective.evaluate(strand.x.data());
    for (int i = 0; i < vertices; ++i) strand.x[4 * i + 3] = 2.5;
    BOOST_TEST(std::abs(objective.evaluate(strand.x.data()) - before) < 1e-14);
}

BOOST_AUTO_TEST_SUITE_END()
