// Inertia of a group's vertices, with gravity, mass damping, drag and external forces: ½ a ‖x − y‖² of the step's objective.
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
        const Pack mass = gather.scalar(arrays.mass, i, 0.0), drag = gather.scalar(arrays.drag, i, 0.0);
        const Vec<Pack> force = gather.vector(arrays.forces, i);
        const Inertia<Pack> inertia = integrator.inertia(mass, arrays.mass_damping, drag);
        row.inertia = inertia.stiffness;
        for (int k = 0; k < 3; ++k)
            row.inertia_target[k] =
                inertia.target(position[k], velocity[k], group.step.gravity[k], group.step.wind[k], force[k]);
    }
}

} // namespace ringlet::RINGLET_SIMD
