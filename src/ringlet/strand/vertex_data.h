// Data of a strand's vertices in the kernels, one row per vertex; values of an edge stand in the row of its first vertex.
#pragma once

#include "ringlet/energy/strand/bend.h"
#include "ringlet/math/pack.h"
#include "ringlet/strand/kernel.h"

namespace ringlet::RINGLET_SIMD {

// Reference of the next step: the last accepted state of a vertex and its edge.
template <class T> struct Reference {
    Vec<T> normal;  // σ n of the vertex, or (material frames) the director D of the edge
    Vec<T> tangent; // of the edge
    T delta;        // Δφ of the edge, with its turns (`history`)
    T fade;         // of the twist, 0 … 1 (`history`)
};

// Strains whose rate Kelvin–Voigt damping resists.
template <class T> struct Strains {
    static constexpr int count = 4;
    T values[count] = {}; // edge length [m]; bend: σθ and 0, or both material curvatures less those at rest; twist
    T &operator[](int k) { return values[k]; }
    T operator[](int k) const { return values[k]; }
    T length() const { return values[0]; }
    T twist() const { return values[3]; }
};

// Constant during a step. An odd number of values: with a power of two, those of one column share few sets of the cache.
// `damped_` values are the rest values of the energies with damping (time_discretisation.h).
template <class T> struct StrandRow : StrandCoefficients<T> {
    T free;                // 1, or 0 where the vertex is held
    T inertia;             // a of ½ a ‖x − y‖² [kg/s²]
    Vec<T> inertia_target; // y [m]
    T damped_length, damped_angle, damped_strain;
    T damped_curvature1, damped_curvature2; // of material frames
    T elastic_share;                        // 1 / (1 + β/h): of a stiffness with damping, the share without
    T frame_free;                           // 1, or 0 where both ends of the edge are held and its frame with them
    Reference<T> reference;
    T start_sigma, start_turns; // at the start of the step, for the report

    void scale_stiffnesses(T factor) {
        this->stretch_stiffness *= factor;
        this->bend_stiffness *= factor;
        this->twist_stiffness *= factor;
    }
};

// Geometry at the positions evaluated last.
template <class T> struct StrandShape {
    Vec<T> tangent; // of the edge
    T length;
    Corner<T> corner;
    T strain; // of the twist, whose energy is ½ k strain²

    // Hinges
    T sigma;                          // ±1, sign of the corner's bend
    T phi;                            // dihedral angle of the edge, in (−π, π]
    T delta;                          // φ − φ̄ of the edge with signs and turns
    T turns;                          // whole turns in it
    T by_dihedral, by_angle, by_next; // ∂strain by φ, by the angle at this corner and by that at the next
    T choice_plus, choice_minus;      // `least_energy`: best sign of the previous corner where this one has + or −

    // Material frames
    Vec<T> director;          // D of the edge
    T curvature1, curvature2; // material curvatures less those at rest: K·D − θ̄ and K·(t×D)
};

} // namespace ringlet::RINGLET_SIMD
