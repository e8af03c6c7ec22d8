// Initial guess of Newton's method: of rest, the root's rigid motion and free flight the one with the least energy.
#pragma once

#include "ringlet/strand/gathered_group.h"

namespace ringlet::RINGLET_SIMD {

// Writes the guess to memory.x, with held vertices at their targets; the choice is made for every lane.
template <class Objective> void predict(GatheredGroup<Objective> &group, const RootMotion<Pack> &root) {
    GroupMemory<Objective> &memory = group.memory;
    Pack *best = memory.x, *trial = memory.newton.trial;
    const auto place = [&](Pack *x, const auto &predicted) {
        for (int i = 0; i < group.vertices; ++i)
            Objective::set_position(x, i, select<Pack>(memory.rows[i].free > 0.0, predicted(i), memory.target[i]));
        return group.objective.energy(x);
    };
    Pack least = place(best, [&](int i) { return memory.start[i]; });
    const auto improve = [&](const auto &predicted) {
        const Pack energy = place(trial, predicted);
        const auto better = energy < least;
        for (int i = 0; i < group.objective.size(); ++i) best[i] = select(better, trial[i], best[i]);
        least = select(better, energy, least);
    };
    improve([&](int i) { return root.apply(memory.start[i]); });
    improve([&](int i) { return memory.start[i] + constant<Pack>(group.step.dt) * memory.velocity[i]; });
}

} // namespace ringlet::RINGLET_SIMD
