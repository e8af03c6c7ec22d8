// Newton's method with a line search on the true energy, one independent problem per lane.
// It knows objectives, not hair. An objective offers
//   int size()                                        unknowns
//   T evaluate(const T *x)                            energy of every lane at x; remembers what assembling needs
//   void assemble(T *gradient, Objective::Matrix &)   at the x evaluated last; the Hessian positive definite
//   T worth_going(const T *x, const T *direction)     how much of a direction is worth a try
//   void move(const T *x, T step, const T *direction, T *to)
//                                                     where a part `step` of it leads, x + step · direction to first order
//   Objective::Matrix                                 a Banded matrix
#pragma once

#include "ringlet/linear/banded.h"
#include "ringlet/math/pack.h"

namespace ringlet::RINGLET_SIMD {

struct NewtonSettings {
    int iterations;   // at most
    double tolerance; // a lane is done when no unknown changes more than this [m]
};

template <class T> struct NewtonResult {
    T energy;
    T iterations; // used, per lane
    T cuts;       // times a step was halved
    T residual;   // largest unknown of the last full step [m]
};

// What Newton works in: `direction` has Matrix::padding entries of room behind its last.
template <class T> struct NewtonSpace {
    T *trial, *gradient, *direction, *band;
};

template <class T, class Objective>
NewtonResult<T> newton(Objective &objective, T *x, const NewtonSettings &settings, const NewtonSpace<T> &space) {
    const int most_cuts = 40;
    const double least_decrease = 1e-4; // Armijo
    const double rounding = 1e-14;      // of the energy: below this a decrease cannot be seen
    const T one = constant<T>(1.0);
    const int size = objective.size();

    typename Objective::Matrix hessian(space.band, size);
    NewtonResult<T> result{objective.evaluate(x), T{}, T{}, T{}};
    T active = one; // 1 while a lane still moves, else 0

    for (int iteration = 0; iteration < settings.iterations; ++iteration) {
        objective.assemble(space.gradient, hessian);
        hessian.factor();
        for (int i = 0; i < size; ++i) space.direction[i] = -space.gradient[i];
        hessian.solve(space.direction);

        T slope{}, largest{};
        for (int i = 0; i < size; ++i) {
            slope += space.gradient[i] * space.direction[i];
            largest = max(largest, abs(space.direction[i]));
        }
        result.residual = select(active > 0.0, largest, result.residual);
        result.iterations += active;

        // A lane that has arrived takes its last step only if that is no step up; it is not worth a search.
        const auto arrived = largest <= settings.tolerance;
        T step = active * objective.worth_going(x, space.direction);
        for (int cut = 0;; ++cut) {
            objective.move(x, step, space.direction, space.trial);
            const T energy = objective.evaluate(space.trial);
            const T bound = result.energy + least_decrease * step * slope + rounding * abs(result.energy);
            const T refused = select(energy <= bound, T{}, one) * select(step > 0.0, one, T{}); // also where energy is NaN
            if (!any(refused > 0.0)) {
                result.energy = select(step > 0.0, energy, result.energy);
                break;
            }
            result.cuts += select(arrived, T{}, refused);
            const T shorter = select(arrived, T{}, constant<T>(cut < most_cuts ? 0.5 : 0.0));
            step *= select(refused > 0.0, shorter, one);
        }
        for (int i = 0; i < size; ++i) x[i] = select(step > 0.0, space.trial[i], x[i]);
        active = select(arrived, T{}, select(step > 0.0, active, T{})); // where no step is one down, none will be
        if (!any(active > 0.0)) break;
    }
    return result;
}

} // namespace ringlet::RINGLET_SIMD
