// `history`: production's safeguards against virtual triangles that degenerate or flip. Signs and turns are compared with those
// of the last accepted step, the fade is fixed within a step.
#pragma once

#include "ringlet/strand/strand_arrays.h"
#include "ringlet/strand/strand_shape.h"

namespace ringlet::RINGLET_SIMD {

// Normal flips. A normal reversed against its predecessor is the triangle inverting (a curl passing through straight), not half
// a turn of twist: σ = −1. The old normal is first carried along with the edge's own rotation, so that a fast rigid turn of the
// strand is never taken for a flip.
template <class T> inline T carried_sign(const Reference<T> &reference, Vec<T> tangent, Vec<T> normal) {
    return sign(dot(normal, transport(reference.normal, reference.tangent, tangent)));
}

// Winding. Δφ is known up to whole turns: the one nearest to the last step's is taken, so twist accumulates past ±π. Where one
// of the two triangles is inverted (signs differ) the dihedral is half a turn off.
template <class T> inline T carried_turns(T before, T delta, T sign_product) {
    const T with_sign = delta + select(sign_product < 0.0, constant<T>(pi), T{});
    return before + wrap(with_sign - before);
}

// Too straight to twist. An edge with a corner below 0.15° or above 179.85° gets no twist; a hard cut would take away a large
// stiffness at once, so it fades in smoothly up to twice that limit.
template <class T> inline T straightness_fade(T angle) {
    const double low = 0.15 * pi / 180, high = 0.30 * pi / 180;
    const T u = (min(angle, pi - angle) - low) * (1.0 / (high - low));
    const T y = min(max(u, T{}), constant<T>(1.0));
    return y * y * (3.0 - 2.0 * y);
}

template <class T>
void continue_history(int vertices, const StrandRow<T> *rows, StrandShape<T> *shapes, Safeguards safeguards) {
    for (int i = 1; i + 1 < vertices; ++i)
        shapes[i].sigma = safeguards.flip_history ? carried_sign(rows[i].reference, shapes[i].tangent, shapes[i].corner.normal)
                                                  : constant<T>(1.0);
    for (int i = 1; i + 2 < vertices; ++i) {
        StrandShape<T> &s = shapes[i];
        const T delta = s.phi - rows[i].rest_dihedral;
        s.delta =
            carried_turns(safeguards.winding_number ? rows[i].reference.delta : T{}, delta, s.sigma * shapes[i + 1].sigma);
        s.turns = round((s.delta - delta) * (0.5 / pi));
        s.strain = rows[i].reference.fade * s.delta;
        s.by_dihedral = rows[i].reference.fade;
        s.by_angle = s.by_next = T{};
    }
}

} // namespace ringlet::RINGLET_SIMD
