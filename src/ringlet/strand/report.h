// Report of one strand's step, from the state that the step has written.
#pragma once

#include "ringlet/energy/strand/stretch.h"
#include "ringlet/strand/gathered_group.h"

namespace ringlet::RINGLET_SIMD {

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

} // namespace ringlet::RINGLET_SIMD
