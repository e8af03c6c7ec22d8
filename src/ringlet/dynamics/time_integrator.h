// Implicit time integration of one step dt: backward Euler or BDF-2, for T = double or one integrator per lane (T = Pack).
// The rate of a quantity q (position, velocity or strain) at the end of the step is (q − q̂)/h, where
//   q̂ = qₙ + lag (qₙ − qₙ₋₁),  h = dt (1 − lag).
// Backward Euler has lag 0 and is of first order. BDF-2 has lag 1/3 and is of second order; it needs a last step of equal dt.
#pragma once

#include "ringlet/math/pack.h"

namespace ringlet::RINGLET_SIMD {

inline constexpr double backward_euler_lag = 0.0, bdf2_lag = 1.0 / 3;

// One coordinate of a point with viscous damping: ½ stiffness (x − target)², the sum of
//   ½ m/h² (x − (x̂ + h v̂ + h² g))²   inertia and gravity
//   ½ αm/h (x − x̂)²                  mass damping
//   ½ d/h (x − (x̂ + h w))²           drag of a wind w
//   − f x                            force
template <class T> struct Inertia {
    T h;
    T inertia, mass_damping, drag, stiffness; // m/h², αm/h, d/h and their sum [kg/s²]

    // Of a mass [kg], with a damping rate α [1/s] and a drag d [kg/s].
    Inertia(T step, T mass, double damping_rate, T drag_coefficient)
        : h(step), inertia(mass / (h * h)), mass_damping(damping_rate * mass / h), drag(drag_coefficient / h),
          stiffness(inertia + mass_damping + drag) {}

    // x̂ [m], v̂ [m/s], gravity [m/s²], wind [m/s] and force [N]; zero where nothing acts.
    T target(T position, T velocity, double gravity, double wind, T force) const {
        const T free_flight = position + h * velocity + h * h * gravity;
        const T with_wind = position + h * wind;
        const T weighted = inertia * free_flight + mass_damping * position + drag * with_wind + force;
        return select(stiffness > 0.0, weighted / stiffness, T{});
    }
};

template <class T> struct TimeIntegrator {
    T lag, h;

    static TimeIntegrator of_step(double dt, T lag) { return {lag, dt * (1.0 - lag)}; }

    // q̂; `last` is read where lag > 0.
    T extrapolate(T now, T last) const { return select(lag > 0.0, now + lag * (now - last), now); }
    T extrapolate_angle(T now, T last) const { return now + lag * wrap(now - last); }
    Vec<T> extrapolate(Vec<T> now, Vec<T> last) const {
        return {extrapolate(now.x, last.x), extrapolate(now.y, last.y), extrapolate(now.z, last.z)};
    }

    // At the end of the step, of a quantity that was extrapolated to q̂.
    T rate(T end, T extrapolated) const { return (end - extrapolated) / h; }

    Inertia<T> inertia(T mass, double damping_rate, T drag) const { return {h, mass, damping_rate, drag}; }
};

} // namespace ringlet::RINGLET_SIMD
