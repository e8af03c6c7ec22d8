// `history`: signs and turns of the hinge model follow those of the last accepted step.
// Safeguards keep virtual triangles that degenerate or flip harmless. The fade of the twist is constant within a step.
#pragma once

#include "ringlet/strand/kernel.h"
#include "ringlet/strand/settings.h"
#include "ringlet/strand/vertex_data.h"

namespace ringlet::RINGLET_SIMD {

// Sign of a corner's bend. A normal that reverses is its virtual triangle inverting, as where a curl passes through straight,
// and not half a turn of twist. The last normal is first transported with the edge, so that a fast rotation of the strand is
// no flip.
template <class T> inline T transported_sign(const Reference<T> &reference, Vec<T> tangent, Vec<T> normal) {
    return sign(dot(normal, transport(reference.normal, reference.tangent, tangent)));
}

// Δφ with its turns: of all values whole turns apart, the one nearest to that of the last step. Twist accumulates past ±π.
// Where one of the two triangles is inverted (signs differ), the dihedral is half a turn off.
template <class T> inline T unwrapped(T last, T delta, T sign_product) {
    const T with_sign = delta + select(sign_product < 0.0, constant<T>(pi), T{});
    return last + wrap(with_sign - last);
}

// Factor on the twist of an edge with a corner that is nearly straight or folded: 0 below `straight_angle`, then a smooth rise
// to 1 at `straight_fade_angle`. A hard cut would remove a large stiffness at once.
template <class T> inline T straightness_fade(T angle) {
    const double low = strand_settings::straight_angle, high = strand_settings::straight_fade_angle;
    const T u = (min(angle, pi - angle) - low) * (1.0 / (high - low));
    const T y = min(max(u, T{}), constant<T>(1.0));
    return y * y * (3.0 - 2.0 * y);
}

template <class T>
void continue_history(int vertices, const StrandRow<T> *rows, StrandShape<T> *shapes, Safeguards safeguards) {
    for (int i = 1; i + 1 < vertices; ++i)
        shapes[i].sigma = safeguards.flip_history
                              ? transported_sign(rows[i].reference, shapes[i].tangent, shapes[i].corner.normal)
                              : constant<T>(1.0);
    for (int i = 1; i + 2 < vertices; ++i) {
        StrandShape<T> &s = shapes[i];
        const T delta = s.phi - rows[i].rest_dihedral;
        s.delta = unwrapped(safeguards.winding_number ? rows[i].reference.delta : T{}, delta, s.sigma * shapes[i + 1].sigma);
        s.turns = round((s.delta - delta) * (0.5 / pi));
        s.strain = rows[i].reference.fade * s.delta;
        s.by_dihedral = rows[i].reference.fade;
        s.by_angle = s.by_next = T{};
    }
}

} // namespace ringlet::RINGLET_SIMD
