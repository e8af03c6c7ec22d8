// Newton's method with a backtracking Armijo line search on the true energy, one independent problem per lane.
// It knows objectives, not hair. An objective offers
//   int size()                                        unknowns
//   T evaluate(const T *x)                            energy of every lane at x; keeps what assemble needs
//   void assemble(T *gradient, Objective::Matrix &, T &curved)
//                                                     at the x evaluated last; the Hessian positive definite, and along
//                                                     curved paths in lanes where that is 1: set to 0 where it cannot be
//   T max_step(const T *x, const T *direction)        largest step to try, at most 1
//   void curved_path(const T *x, T step, const T *direction, T *to)
//                                                     the point at `step` of its path, x + step · direction to first order
//   Objective::Matrix                                 a Banded matrix
#pragma once

#include "ringlet/dynamics/armijo.h"
#include "ringlet/linear/banded.h"
#include "ringlet/math/pack.h"

namespace ringlet::RINGLET_SIMD {

struct NewtonSettings {
    int iterations;   // at most
    double tolerance; // a lane has converged when no unknown changes more than this [m]
};

inline constexpr int newton_halvings = 40;      // of a step at most; then the lane stays
inline constexpr double fast_contraction = 0.1; // of a direction by the one before; faster, a lane leaves curvature out

template <class T> struct NewtonResult {
    T energy;
    T iterations; // used, per lane
    T cuts;       // times a step was halved
    T residual;   // largest unknown of the last full step [m]
    T stalled;    // 1 where the lane has not moved, although it has not converged
};

// Working memory: `direction` has Matrix::padding more entries behind its last.
template <class T> struct NewtonMemory {
    T *trial, *gradient, *direction, *band;
};

// Never inlined: the compiler has a budget for a file, and the objective's terms need it more.
template <class T, class Objective>
[[gnu::noinline]] NewtonResult<T> newton(Objective &objective, T *x, const NewtonSettings &settings,
                                         const NewtonMemory<T> &memory) {
    const T one = constant<T>(1.0);
    const int size = objective.size();

    typename Objective::Matrix hessian(memory.band, size);
    NewtonResult<T> result{objective.evaluate(x), T{}, T{}, T{}, T{}};
    T active = one;         // 1 while a lane still moves, else 0
    T curved = one, last{}; // the largest unknown of the direction before

    for (int iteration = 0; iteration < settings.iterations; ++iteration) {
        objective.assemble(memory.gradient, hessian, curved);
        hessian.factor();
        for (int i = 0; i < size; ++i) memory.direction[i] = -memory.gradient[i];
        hessian.solve(memory.direction);

        T slope{}, largest{};
        for (int i = 0; i < size; ++i) {
            slope += memory.gradient[i] * memory.direction[i];
            largest = max(largest, abs(memory.direction[i]));
        }
        // Gauss–Newton alone is enough where directions shrink fast.
        curved = select(largest < fast_contraction * last, T{}, curved);
        last = largest;
        result.residual = select(active > 0.0, largest, result.residual);
        result.iterations += active;

        // A converged lane takes its last step only where the full step is accepted; it does not search.
        const auto converged = largest <= settings.tolerance;
        T step = active * objective.max_step(x, memory.direction);
        for (int cut = 0;; ++cut) {
            objective.curved_path(x, step, memory.direction, memory.trial);
            const T energy = objective.evaluate(memory.trial);
            const auto accepted = sufficient_decrease(energy, result.energy, slope, step);
            const T refused = select(accepted, T{}, one) * select(step > 0.0, one, T{}); // also where energy is NaN
            if (!any(refused > 0.0)) {
                result.energy = select(step > 0.0, energy, result.energy);
                break;
            }
            result.cuts += select(converged, T{}, refused);
            const T shorter = select(converged, T{}, constant<T>(cut < newton_halvings ? 0.5 : 0.0));
            step *= select(refused > 0.0, shorter, one);
        }
        for (int i = 0; i < size; ++i) x[i] = select(step > 0.0, memory.trial[i], x[i]);
        if (iteration == 0) result.stalled = select(converged | (step > 0.0), T{}, active);
        // A lane without a decreasing step stays.
        active = select(converged, T{}, select(step > 0.0, active, T{}));
        if (!any(active > 0.0)) break;
    }
    return result;
}

} // namespace ringlet::RINGLET_SIMD
