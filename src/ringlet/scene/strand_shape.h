// What the kernels keep of a strand, one row per vertex; an edge's values stand in the row of the vertex where it begins.
#pragma once

#include "ringlet/energy/strand/bend.h"
#include "ringlet/math/pack.h"

namespace ringlet::RINGLET_SIMD {

// What a vertex and the edge that begins there remember of the last accepted step (`history` only).
template <class T> struct Reference {
    Vec<T> normal;  // σ n of the vertex
    Vec<T> tangent; // of the edge
    T delta;        // Δφ of the edge, with its turns
    T fade;         // of the twist, 0 … 1
};

// Fixed during a step.
template <class T> struct StrandRow {
    T free;          // 1, or 0 where the vertex is held
    T inertia;       // a [kg/s²]
    Vec<T> inertial; // y [m]
    T stretch, rest_length;
    T bend, rest_angle;
    T twist, rest_dihedral;
    T damping;                                    // β [s]
    T damped_length, damped_angle, damped_strain; // the values that the step's energies rest at (see strand_objective.h)
    Reference<T> reference;
    T start_sigma, start_turns; // as the step begins, for the report
};

// At the positions evaluated last.
template <class T> struct StrandShape {
    Vec<T> tangent; // of the edge that begins here
    T length;
    Corner<T> corner;
    T sigma;                          // ±1, sign of the corner's bend
    T phi;                            // dihedral angle of the edge, in (−π, π]
    T delta;                          // φ − φ̄ of the edge as the signs and turns have it
    T turns;                          // whole turns in it
    T strain;                         // of the twist: what its energy is the square of
    T by_dihedral, by_angle, by_next; // ∂strain by φ, by the angle at this corner and by that at the next

    T choice_plus, choice_minus; // `least_energy`: best sign of the corner before, were this one's + or −
};

} // namespace ringlet::RINGLET_SIMD
