// State update at the end of a step: one strand of a group is scattered back to the arrays.
#pragma once

#include "ringlet/dynamics/time_integrator.h"
#include "ringlet/strand/gathered_group.h"

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
        if (!Objective::has_frames && strand.has_hinge(i))
            group.arrays.twist[strand.row(i)] = group.memory.shapes[i].delta[strand.index];
    }
}

} // namespace ringlet::RINGLET_SIMD
