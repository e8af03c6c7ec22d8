// End of one strand's step: its state is scattered back to the arrays, its report follows from them, and its energy is limited.
#pragma once

#include "ringlet/dynamics/time_integrator.h"
#include "ringlet/energy/strand/stretch.h"
#include "ringlet/strand/gathered_group.h"

#include <cmath>

namespace ringlet::RINGLET_SIMD {

template <class Objective> double coordinate(const GatheredGroup<Objective> &group, const StrandLane &strand, int i, int k) {
    return group.memory.x[Objective::dofs * i + k][strand.index];
}

template <class Objective> bool is_finite(const GatheredGroup<Objective> &group, const StrandLane &strand) {
    double sum = 0;
    for (int i = 0; i < strand.vertices; ++i)
        for (int k = 0; k < 3; ++k) sum += coordinate(group, strand, i, k);
    return sum - sum == 0;
}

// The strand keeps its last state, at rest.
template <class Objective> void reject_step(const GatheredGroup<Objective> &group, const StrandLane &strand) {
    for (int i = 3 * strand.first; i < 3 * (strand.first + strand.vertices); ++i) group.arrays.velocities[i] = 0;
    group.arrays.last_dt[strand.strand] = 0;
}

// Positions and velocities.
template <class Objective> void scatter_motion(const GatheredGroup<Objective> &group, const StrandLane &strand, double lag) {
    const StrandArrays &arrays = group.arrays;
    const double dt = group.step.dt;
    const bool bdf2 = group.step.integrator == Integrator::bdf2;
    const TimeIntegrator<double> integrator = TimeIntegrator<double>::of_step(dt, lag);
    arrays.last_dt[strand.strand] = bdf2 ? dt : 0.0;
    for (int i = 0; i < strand.vertices; ++i)
        for (int k = 0; k < 3; ++k) {
            const int at = 3 * strand.row(i) + k;
            const double start = arrays.positions[at], end = coordinate(group, strand, i, k);
            const double extrapolated = integrator.extrapolate(start, arrays.last_positions[at]);
            if (bdf2) {
                arrays.last_positions[at] = start;
                arrays.last_velocities[at] = arrays.velocities[at];
            }
            arrays.positions[at] = end;
            arrays.velocities[at] = integrator.rate(end, extrapolated);
        }
}

// Normals or directors, and the twist with its turns: what the next step compares with.
template <class Objective> void scatter_references(const GatheredGroup<Objective> &group, const StrandLane &strand) {
    for (int i = 1; strand.has_edge(i); ++i) {
        group.scatter_normal(strand, i);
        if constexpr (!Objective::has_frames)
            if (strand.has_hinge(i)) group.arrays.twist[strand.row(i)] = group.memory.shapes[i].delta[strand.index];
    }
}

inline StrandReport report_of(const StrandEffort &effort, double tolerance) {
    StrandReport report{};
    report.newton = effort.iterations;
    report.cuts = effort.cuts;
    report.residual = effort.residual;
    report.unconverged = effort.residual > tolerance;
    return report;
}

// Gravity's and kinetic energy of the free vertices [J].
template <class Objective>
void add_motion(const GatheredGroup<Objective> &group, const StrandLane &strand, StrandReport &report) {
    const StrandArrays &arrays = group.arrays;
    for (int i = 0; i < strand.vertices; ++i) {
        const int at = strand.row(i);
        const bool free = group.memory.rows[i].free[strand.index] > 0;
        double speed2 = 0;
        for (int k = 0; k < 3; ++k) {
            const double v = arrays.velocities[3 * at + k];
            speed2 += v * v;
            report.gravity -= arrays.mass[at] * group.step.gravity[k] * arrays.positions[3 * at + k] * free;
        }
        report.kinetic += 0.5 * arrays.mass[at] * speed2 * free;
    }
}

// Elastic energies [J] and counters. Edges that end in a held vertex are left out.
template <class Objective>
void add_elastic(const GatheredGroup<Objective> &group, const StrandLane &strand, StrandReport &report) {
    const StrandArrays &arrays = group.arrays;
    const Objective &objective = group.objective;
    const auto is_free = [&](int i) { return group.memory.rows[i].free[strand.index] > 0; };
    for (int i = 0; i < strand.vertices; ++i) {
        const int at = strand.row(i), k = strand.index;
        if (strand.has_edge(i) && is_free(i + 1)) {
            const double length = group.memory.shapes[i].length[k];
            report.stretch += stretch_energy(length, arrays.rest_length[at], arrays.stretch_stiffness[at]);
            report.max_stretch = max(report.max_stretch, abs(length / arrays.rest_length[at] - 1.0));
            report.clamped += objective.clamped_eigenvalues(i)[k];
        }
        if (strand.has_corner(i)) {
            report.bend += objective.bend_energy_at(i)[k];
            report.flips += objective.sign_changes(i)[k];
        }
        if (strand.has_hinge(i)) {
            report.twist += objective.twist_energy_at(i)[k];
            report.winding_changes += objective.winding_changes(i)[k];
            report.too_straight += is_free(i + 2) * objective.too_straight(i)[k];
        }
    }
}

// Whether gravity and forces alone do work on the strand: its held vertices rest, and so does the air, and no spring pulls.
// (Backward Euler only.)
template <class Objective> bool is_isolated(const GatheredGroup<Objective> &group, const StrandLane &strand) {
    if (group.step.integrator != Integrator::backward_euler || group.arrays.springs.stiffness != nullptr) return false;
    const GroupMemory<Objective> &memory = group.memory;
    for (int k = 0; k < 3; ++k) {
        if (group.step.wind[k] != 0.0) return false;
        for (int i = 0; i < strand.vertices; ++i)
            if (!(memory.rows[i].free[strand.index] > 0) &&
                !(memory.target[i][k][strand.index] == memory.start[i][k][strand.index]))
                return false;
    }
    return true;
}

// Scales the velocities so that the kinetic energy is at most: the energy at the start and the work of gravity and forces,
// less the elastic energy. A converged step of backward Euler always obeys this.
template <class Objective>
void limit_energy(const GatheredGroup<Objective> &group, const StrandLane &strand, StrandReport &report) {
    const StrandArrays &arrays = group.arrays;
    const GroupMemory<Objective> &memory = group.memory;
    double most = group.start_energy[strand.index] - report.stretch - report.bend - report.twist;
    for (int i = 0; i < strand.vertices; ++i) {
        const int at = strand.row(i);
        if (!(memory.rows[i].free[strand.index] > 0)) { // the report leaves out edges that end in a held vertex
            if (i > 0)
                most -= stretch_energy(memory.shapes[i - 1].length[strand.index], arrays.rest_length[at - 1],
                                       arrays.stretch_stiffness[at - 1]);
            continue;
        }
        for (int k = 0; k < 3; ++k) {
            const double velocity = memory.velocity[i][k][strand.index];
            const double displacement = arrays.positions[3 * at + k] - memory.start[i][k][strand.index];
            most += 0.5 * arrays.mass[at] * velocity * velocity;
            most += (arrays.mass[at] * group.step.gravity[k] + arrays.forces[3 * at + k]) * displacement;
        }
    }
    if (!(report.kinetic > most)) return;
    const double share = most > 0 ? most / report.kinetic : 0.0;
    for (int i = 3 * strand.first; i < 3 * (strand.first + strand.vertices); ++i) arrays.velocities[i] *= std::sqrt(share);
    report.kinetic *= share;
}

} // namespace ringlet::RINGLET_SIMD
