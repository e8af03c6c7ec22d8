// Data of the vertices of hinge strands.
#pragma once

#include "ringlet/strand/vertex_data.h"

namespace ringlet::RINGLET_SIMD {

// The normal of the reference is σ n of the vertex.
template <class T> struct HingeRow : StrandRow<T> {
    T damped_angle;
    T reference_delta;          // Δφ of the edge, with its turns, in the last accepted state (`history`)
    T fade;                     // of the twist, 0 … 1 (`history`)
    T start_sigma, start_turns; // at the start of the step, for the report
};

template <class T> struct HingeShape : StrandShape<T> {
    T sigma;                          // ±1, sign of the corner's bend
    T phi;                            // dihedral angle of the edge, in (−π, π]
    T delta;                          // φ − φ̄ of the edge with signs and turns
    T turns;                          // whole turns in it
    T by_dihedral, by_angle, by_next; // ∂strain by φ, by the angle at this corner and by that at the next
    T choice_plus, choice_minus;      // `least_energy`: best sign of the previous corner where this one has + or −
};

} // namespace ringlet::RINGLET_SIMD
