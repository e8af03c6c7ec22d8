#include "ringlet/cloth/cloth_step.h"

#include "ringlet/linear/conjugate_gradient.h"
#include "ringlet/linear/incomplete_cholesky.h"

#include <algorithm>
#include <cmath>

namespace ringlet {
namespace {

using Positions = std::vector<Vec3>;

Eigen::Map<Eigen::VectorXd> flat(Positions &values) { return {values.data()->data(), Eigen::Index(3 * values.size())}; }

// Newton starts from the less energetic of: staying, flying on. Held vertices are where they end.
Positions guess(const ClothObjective &objective, const ClothState &state, const ClothForces &forces) {
    Positions stay = state.positions, fly = state.positions;
    for (size_t i = 0; i < stay.size(); ++i) {
        fly[i] += forces.dt * state.velocities[i];
        if (objective.model().held[i]) stay[i] = fly[i] = forces.targets[i];
    }
    return objective.energy(fly) < objective.energy(stay) ? fly : stay;
}

// Goes along the direction, halving the step until the energy has fallen. Returns whether it has moved.
bool search(const ClothObjective &objective, Positions &x, Positions &direction, double slope, double &energy, double &cuts) {
    const int most_cuts = 40;
    const double least_decrease = 1e-4; // Armijo
    const double rounding = 1e-14;      // of the energy: below this a decrease cannot be seen
    Positions trial = x;
    double step = 1;
    for (int cut = 0; cut <= most_cuts; ++cut, step *= 0.5) {
        flat(trial) = flat(x) + step * flat(direction);
        const double there = objective.energy(trial);
        if (there <= energy + least_decrease * step * slope + rounding * std::abs(energy)) {
            x = trial;
            energy = there;
            return true;
        }
        ++cuts;
    }
    return false;
}

Positions minimise(ClothObjective &objective, Positions x, const ClothStep &step, ClothReport &report) {
    BlockMatrix hessian = objective.pattern();
    IncompleteCholesky preconditioner;
    Positions gradient(x.size()), direction(x.size());
    Eigen::VectorXd solution;
    double energy = objective.energy(x);
    report.unconverged = 1;
    for (int iteration = 0; iteration < step.newton && report.unconverged; ++iteration) {
        hessian.set_zero();
        objective.assemble(x, gradient, hessian);
        preconditioner.factor(hessian);
        const ConjugateGradientResult linear =
            conjugate_gradient([&](const auto &v, auto &Av) { hessian.multiply(v, Av); },
                               [&](const auto &r, auto &z) { preconditioner.solve(r, z); }, -flat(gradient), solution,
                               {step.linear_tolerance, step.linear_iterations});
        flat(direction) = solution;
        report.newton += 1;
        report.linear += linear.iterations;
        report.linear_residual = std::max(report.linear_residual, linear.residual);
        report.residual = solution.lpNorm<Eigen::Infinity>();
        report.unconverged = !(report.residual <= step.tolerance);
        if (!search(objective, x, direction, flat(gradient).dot(solution), energy, report.cuts)) break;
    }
    return x;
}

} // namespace

void end_cloth_step(const ClothObjective &objective, ClothState &state, const ClothForces &forces, const std::vector<Vec3> &end,
                    ClothReport &report) {
    const ClothModel &model = objective.model();
    if (!std::all_of(end.begin(), end.end(),
                     [](const Vec3 &x) { return x.allFinite(); })) { // keep the last good state, at rest
        report.nan = 1;
        std::fill(state.velocities.begin(), state.velocities.end(), Vec3::Zero());
        return;
    }
    for (int i = 0; i < model.vertex_count(); ++i) {
        state.velocities[i] = (end[i] - state.positions[i]) / forces.dt;
        state.positions[i] = end[i];
        if (model.held[i]) continue;
        report.gravity -= model.mass[i] * forces.gravity.dot(end[i]);
        report.kinetic += 0.5 * model.mass[i] * state.velocities[i].squaredNorm();
    }
    const ClothEnergies elastic = objective.energies(end);
    report.stretch = elastic.stretch;
    report.bend = elastic.bend;
    report.max_stretch = elastic.max_stretch;
}

ClothReport step_cloth(ClothObjective &objective, ClothState &state, const ClothForces &forces, const ClothStep &step) {
    ClothReport report{};
    objective.begin(state, forces);
    end_cloth_step(objective, state, forces, minimise(objective, guess(objective, state, forces), step, report), report);
    return report;
}

} // namespace ringlet
