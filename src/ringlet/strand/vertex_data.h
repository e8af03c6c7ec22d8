// Data of a strand's vertices in the kernels, one row per vertex; values of an edge stand in the row of its first vertex.
#pragma once

#include "ringlet/energy/strand/bend.h"
#include "ringlet/energy/strand/plane.h"
#include "ringlet/math/pack.h"
#include "ringlet/strand/kernel.h"

namespace ringlet::RINGLET_SIMD {

// Reference of the next step: the last accepted state of a vertex and its edge.
template <class T> struct Reference {
    Vec<T> normal;  // of the model of bend and twist
    Vec<T> tangent; // of the edge
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

// Constant during a step; models of bend and twist add to it. `damped_` values are the rest values of the energies with damping
// (time_discretisation.h).
template <class T> struct StrandRow : StrandCoefficients<T> {
    T free;                // 1, or 0 where the vertex is held
    T inertia;             // a of ½ a ‖x − y‖² [kg/s²]
    Vec<T> inertia_target; // y [m]
    T damped_length, damped_strain;
    T elastic_share; // 1 / (1 + β/h): of a stiffness with damping, the share without
    Reference<T> reference;

    void scale_stiffnesses(T factor) {
        this->stretch_stiffness *= factor;
        this->bend_stiffness *= factor;
        this->twist_stiffness *= factor;
    }
};

// Geometry at the positions evaluated last; models of bend and twist add to it.
template <class T> struct StrandShape {
    Vec<T> tangent; // of the edge
    T length;
    Corner<T> corner;
    T strain; // of the twist, whose energy is ½ k strain²
};

// Material frames: the normal of the reference is the director D of the edge.
template <class T> struct RodRow : StrandRow<T> {
    T damped_curvature1, damped_curvature2;
    T frame_free; // 1, or 0 where both ends of the edge are held and its frame with them
};

// The same in front of planes.
template <class T> struct PlaneRow : RodRow<T> {
    Plane<T> plane;
};

template <class Row> inline constexpr bool has_plane = requires(Row row) { row.plane; };

template <class T> struct RodShape : StrandShape<T> {
    Vec<T> director;          // D of the edge
    T curvature1, curvature2; // material curvatures less those at rest: K·D − θ̄ and K·(t×D)
};

} // namespace ringlet::RINGLET_SIMD
