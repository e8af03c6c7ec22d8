// What the kernels keep of a strand, one row per vertex; an edge's values stand in the row of the vertex where it begins.
#pragma once

#include "ringlet/energy/strand/bend.h"
#include "ringlet/math/pack.h"

namespace ringlet::RINGLET_SIMD {

// What a vertex and the edge that begins there remember of the last accepted step.
template <class T> struct Reference {
    Vec<T> normal;  // σ n of the vertex, or (material frames) the director D of the edge
    Vec<T> tangent; // of the edge
    T delta;        // Δφ of the edge, with its turns (`history`)
    T fade;         // of the twist, 0 … 1 (`history`)
};

// What Kelvin–Voigt damping resists the rate of.
template <class T> struct Strains {
    static constexpr int count = 4;
    T of[count] = {}; // length of the edge [m]; bend: σθ and 0, or the two material curvatures less those at rest; twist
    T &operator[](int k) { return of[k]; }
    T operator[](int k) const { return of[k]; }
    T length() const { return of[0]; }
    T twist() const { return of[3]; }
};

// Fixed during a step. What is damped rests at a value between the groom's and that of the step's start (see
// strand_objective.h).
template <class T> struct StrandRow {
    T free;          // 1, or 0 where the vertex is held
    T inertia;       // a [kg/s²]
    Vec<T> inertial; // y [m]
    T stretch, rest_length, damped_length;
    T bend, rest_angle, damped_angle;
    Vec<T> damped_bend; // of the two material curvatures (material frames; z unused)
    T twist, rest_dihedral, damped_strain;
    T damping;    // β [s]
    T undamped;   // 1 / (1 + β/dt): takes damping out of a stiffness
    T frame_free; // 1, or 0 where both ends of the edge are held and its frame with them
    Reference<T> reference;
    T start_sigma, start_turns; // as the step begins, for the report
};

// At the positions evaluated last.
template <class T> struct StrandShape {
    Vec<T> tangent; // of the edge that begins here
    T length;
    Corner<T> corner;
    T strain; // of the twist: what its energy is the square of

    // Hinges
    T sigma;                          // ±1, sign of the corner's bend
    T phi;                            // dihedral angle of the edge, in (−π, π]
    T delta;                          // φ − φ̄ of the edge as the signs and turns have it
    T turns;                          // whole turns in it
    T by_dihedral, by_angle, by_next; // ∂strain by φ, by the angle at this corner and by that at the next
    T choice_plus, choice_minus;      // `least_energy`: best sign of the corner before, were this one's + or −

    // Material frames
    Vec<T> director; // D of the edge
    T across, along; // material curvatures less those at rest: K·D − θ̄ and K·(t×D)
};

} // namespace ringlet::RINGLET_SIMD
