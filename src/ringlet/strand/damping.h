// Kelvin–Voigt damping: every strain resists its own rate with β times its stiffness.
// It needs no energy of its own. With the rate (θ − θ̂)/h (time_integrator.h) and b = β/h,
//   ½ k (θ − θ̄)² + ½ b k (θ − θ̂)² = ½ k (1 + b) (θ − (θ̄ + b θ̂)/(1 + b))² + constant:
// a stiffer energy about a rest value between the groom's and the extrapolated one.
#pragma once

#include "ringlet/strand/vertex_data.h"

namespace ringlet::RINGLET_SIMD {

// Adds damping to the stiffnesses of a row and to the rest length; objectives have `damp` for bend and twist.
template <class T> inline void add_damping(StrandRow<T> &row, T b, T extrapolated_length) {
    row.elastic_share = 1.0 / (1.0 + b);
    row.damped_length = row.elastic_share * (row.rest_length + b * extrapolated_length);
    row.stretch *= 1.0 + b;
    row.bend *= 1.0 + b;
    row.twist *= 1.0 + b;
}

template <class T> inline void remove_damping(StrandRow<T> &row) {
    row.stretch *= row.elastic_share;
    row.bend *= row.elastic_share;
    row.twist *= row.elastic_share;
}

} // namespace ringlet::RINGLET_SIMD
