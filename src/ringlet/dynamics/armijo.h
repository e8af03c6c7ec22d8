// Armijo's condition of a line search: the energy decreases in proportion to its slope, but for rounding.
// For T = double or one search per lane (T = Pack). Nocedal & Wright, Numerical Optimization, section 3.1.
#pragma once

#include "ringlet/math/pack.h"

namespace ringlet::RINGLET_SIMD {

struct ArmijoSettings {
    double least_decrease = 1e-4; // of what the slope predicts
    double rounding = 1e-14;      // of the energy: below this a decrease cannot be seen
};

// Largest energy that is accepted at step length `step`, where `slope` is that of the energy along the direction.
template <class T> inline T armijo_bound(T energy, T slope, T step, ArmijoSettings settings = {}) {
    return energy + settings.least_decrease * step * slope + settings.rounding * abs(energy);
}

// False where the trial energy is not a number.
template <class T>
inline MaskOf<T> sufficient_decrease(T trial_energy, T energy, T slope, T step, ArmijoSettings settings = {}) {
    return trial_energy <= armijo_bound(energy, slope, step, settings);
}

} // namespace ringlet::RINGLET_SIMD
