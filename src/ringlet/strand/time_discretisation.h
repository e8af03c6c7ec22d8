// Coefficients of a step's objective that depend on the time integrator: inertia and damping.
#pragma once

#include "ringlet/dynamics/time_integrator.h"
#include "ringlet/strand/gathered_group.h"

namespace ringlet::RINGLET_SIMD {

// BDF-2 in lanes whose last step was one of BDF-2 with the same dt, else backward Euler.
template <class Objective> TimeIntegrator<Pack> integrator_of_lanes(const GatheredGroup<Objective> &group) {
    Pack lag{};
    for (int k = 0; k < lanes; ++k) {
        const bool has_last = group.arrays.last_dt[group.gather.lane(k).strand] == group.step.dt;
        set_lane(lag, k, group.step.integrator == Integrator::bdf2 && has_last ? bdf2_lag : backward_euler_lag);
    }
    return TimeIntegrator<Pack>::of_step(group.step.dt, lag);
}

// Inertia of the vertices, with gravity, mass damping, drag, external forces and springs: ½ a ‖x − y‖².
template <class Objective> void set_inertia(GatheredGroup<Objective> &group, const TimeIntegrator<Pack> &integrator) {
    const StrandArrays &arrays = group.arrays;
    const LaneGather &gather = group.gather;
    const bool has_last = any(integrator.lag > 0.0);
    for (int i = 0; i < group.vertices; ++i) {
        StrandRow<Pack> &row = group.memory.rows[i];
        Vec<Pack> position = group.memory.start[i], velocity = group.memory.velocity[i];
        if (has_last) {
            position = integrator.extrapolate(position, gather.vector(arrays.last_positions, i));
            velocity = integrator.extrapolate(velocity, gather.vector(arrays.last_velocities, i));
        }
        const Vec<Pack> force = gather.vector(arrays.forces, i);
        const Inertia<Pack> inertia = integrator.inertia(row.mass, arrays.mass_damping, row.drag);
        row.inertia = inertia.stiffness;
        for (int k = 0; k < 3; ++k)
            row.inertia_target[k] =
                inertia.target(position[k], velocity[k], group.step.gravity[k], group.step.wind[k], force[k]);
        if (arrays.springs.stiffness == nullptr) continue;
        const Pack stiffness = gather.scalar(arrays.springs.stiffness, i, 0.0);
        const Pack share = select(stiffness > 0.0, stiffness / (row.inertia + stiffness), Pack{});
        row.inertia = row.inertia + stiffness;
        row.inertia_target = row.inertia_target + share * (gather.vector(arrays.springs.target, i) - row.inertia_target);
    }
}

// Kelvin–Voigt damping: every strain resists its own rate with β times its stiffness.
// It needs no energy of its own. With the rate (θ − θ̂)/h (dynamics/time_integrator.h) and b = β/h,
//   ½ k (θ − θ̄)² + ½ b k (θ − θ̂)² = ½ k (1 + b) (θ − (θ̄ + b θ̂)/(1 + b))² + constant:
// a stiffer energy about a rest value between the groom's and the extrapolated one.

// θ̂ of the strains at vertex i. With BDF-2, the present strains are kept for the next step.
template <class Objective>
Strains<Pack> extrapolate_strains(GatheredGroup<Objective> &group, const TimeIntegrator<Pack> &integrator, int i) {
    Strains<Pack> now = group.objective.strains(i);
    if (group.step.integrator == Integrator::backward_euler) return now;
    Strains<Pack> last = now;
    for (int k = 0; k < group.gather.strands(); ++k) {
        const StrandLane &strand = group.gather.lane(k);
        if (!strand.has_edge(i)) continue;
        double *kept = group.arrays.last_strains + Strains<Pack>::count * strand.row(i);
        for (int s = 0; s < Strains<Pack>::count; ++s) {
            if (integrator.lag[k] > 0) set_lane(last[s], k, kept[s]);
            kept[s] = now[s][k];
        }
    }
    for (int s = 0; s < 3; ++s) now[s] = integrator.extrapolate(now[s], last[s]);
    now[3] = integrator.extrapolate_angle(now.twist(), last.twist());
    return now;
}

// Stiffnesses and rest values of the step's energies.
template <class Objective> void add_damping(GatheredGroup<Objective> &group, const TimeIntegrator<Pack> &integrator) {
    for (int i = 0; i + 1 < group.vertices; ++i) {
        StrandRow<Pack> &row = group.memory.rows[i];
        const Pack b = row.damping / integrator.h;
        const Strains<Pack> extrapolated = extrapolate_strains(group, integrator, i);
        row.elastic_share = 1.0 / (1.0 + b);
        row.damped_length = row.elastic_share * (row.rest_length + b * extrapolated.length());
        if (i > 0) group.objective.damp(i, b, extrapolated); // bend and twist
        row.scale_stiffnesses(1.0 + b);
    }
}

// Stiffnesses without damping, for the report.
template <class Objective> void remove_damping(GatheredGroup<Objective> &group) {
    for (int i = 0; i + 1 < group.vertices; ++i) group.memory.rows[i].scale_stiffnesses(group.memory.rows[i].elastic_share);
}

} // namespace ringlet::RINGLET_SIMD
