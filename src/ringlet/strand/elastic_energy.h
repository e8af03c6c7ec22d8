// Elastic energy of gathered strands outside of a time step: without inertia and damping, with relaxed material frames.
#pragma once

#include "ringlet/dynamics/newton.h"
#include "ringlet/strand/gathered_group.h"

namespace ringlet::RINGLET_SIMD {

// Rotates the material frames to their least energy at the positions in memory.x; returns that energy [J]. Newton acts on the
// frames alone, as all vertices are held meanwhile. Their `free` flags are saved in `start`, which is not read again.
template <class Objective> Pack relax_frames(GatheredGroup<Objective> &group) {
    GroupMemory<Objective> &memory = group.memory;
    if (!Objective::has_frames) return group.objective.evaluate(memory.x);
    for (int i = 0; i < group.vertices; ++i) {
        memory.start[i].x = memory.rows[i].free;
        memory.rows[i].free = Pack{};
    }
    newton(group.objective, memory.x, {strand_settings::frame_iterations, strand_settings::frame_tolerance}, memory.newton);
    for (int i = 0; i < group.vertices; ++i) memory.rows[i].free = memory.start[i].x;
    return group.objective.evaluate(memory.x);
}

// The same, and keeps the frames as references; one energy per strand.
template <class Objective> void keep_relaxed_frames(GatheredGroup<Objective> &group, double *energies) {
    const Pack energy = relax_frames(group);
    for (int k = 0; k < group.gather.strands(); ++k) {
        const StrandLane &strand = group.gather.lane(k);
        energies[k] = energy[k];
        for (int i = 1; strand.has_edge(i); ++i) group.scatter_normal(strand, i);
    }
}

// Energy, gradient (3 per vertex) and dense Hessian (all unknowns; null to leave it out) of the first lane's strand at other
// positions, with relaxed frames.
template <class Objective>
double elastic_energy(GatheredGroup<Objective> &group, const double *positions, double *gradient, double *hessian) {
    constexpr int dofs = Objective::dofs;
    GroupMemory<Objective> &memory = group.memory;
    for (int i = 0; i < group.vertices; ++i) {
        Vec<Pack> p;
        for (int k = 0; k < 3; ++k) p[k] = constant<Pack>(positions[3 * (group.gather.lane(0).first + i) + k]);
        Objective::set_position(memory.x, i, p);
    }
    const double energy = lane(relax_frames(group), 0);
    typename Objective::Matrix band = group.matrix();
    group.objective.assemble(memory.newton.gradient, band);
    for (int i = 0; i < 3 * group.vertices; ++i) gradient[i] = lane(memory.newton.gradient[dofs * (i / 3) + i % 3], 0);
    const int size = group.objective.size();
    for (int c = 0; hessian && c < size; ++c)
        for (int r = c; r < size && r < c + Objective::Matrix::rows(c); ++r)
            hessian[r * size + c] = hessian[c * size + r] = lane(band.entry(c)[r - c], 0);
    return energy;
}

} // namespace ringlet::RINGLET_SIMD
