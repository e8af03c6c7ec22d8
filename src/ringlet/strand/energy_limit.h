// Energy limit of a step that has not converged: it may leave the strand with no more energy than it had.
#pragma once

#include "ringlet/strand/report.h"

#include <cmath>

namespace ringlet::RINGLET_SIMD {

// Whether gravity and forces alone do work on the strand: its held vertices rest, and so does the air. (Backward Euler only.)
template <class Objective> bool is_isolated(const GatheredGroup<Objective> &group, const StrandLane &strand) {
    if (group.step.integrator != Integrator::backward_euler) return false;
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
