// Border between the portable core and the strand kernels of each instruction set: plain pointers and numbers.
#pragma once

#include "ringlet/linear/band_layout.h"
#include "ringlet/math/row.h"
#include "ringlet/math/simd.h"

#include <cstddef>

namespace ringlet {

// Model of bend and twist: hinges whose signs and turns follow one of two continuations (strand/hinge/continuation.h), or a
// material frame, which needs neither (strand/rod_objective.h).
enum class Continuation { history, least_energy, material_frame };

// See dynamics/time_integrator.h.
enum class Integrator { backward_euler, bdf2 };

// Safeguards against degenerate virtual triangles (strand/hinge/continuation.h); each can be turned off to study it.
struct Safeguards {
    bool flip_history = true, winding_number = true, straight_fade = true;
};

struct StrandStep {
    double dt = 1.0 / 24;          // [s]
    double gravity[3] = {0, 0, 0}; // [m/s²]
    double wind[3] = {0, 0, 0};    // [m/s]
    int newton = 5;                // iterations, at most
    double tolerance = 1e-7;       // a strand has converged when no coordinate moves more [m]
    Continuation continuation = Continuation::material_frame;
    Integrator integrator = Integrator::backward_euler;
    Safeguards safeguards; // of `history`
};

// Rest shape and coefficients of strands, one value per vertex in each column. Values of an edge belong to its first vertex.
// A column is a vector in the model, a pointer in the arrays and one number per lane in the rows of the kernels; all three
// pass on whatever is in `columns`.
template <class Column> struct StrandCoefficients {
    Column rest_length;       // l̄ per edge [m]
    Column rest_angle;        // θ̄ per vertex [rad], in [0, π]
    Column rest_dihedral;     // φ̄ per edge [rad]
    Column stretch_stiffness; // EA / l̄ per edge [N/m]
    Column bend_stiffness;    // EI / l_v per vertex [N m]
    Column twist_stiffness;   // c EI / l̄ per edge [N m]
    Column mass;              // per vertex [kg]
    Column drag;              // per vertex [kg/s]
    Column damping;           // β per vertex [s]

    using Self = StrandCoefficients;
    static constexpr Column Self::*columns[] = {
        &Self::rest_length,    &Self::rest_angle,      &Self::rest_dihedral, &Self::stretch_stiffness,
        &Self::bend_stiffness, &Self::twist_stiffness, &Self::mass,          &Self::drag,
        &Self::damping};
    static constexpr int column_count = sizeof(columns) / sizeof(*columns);
};

// Report of one strand in one step.
RINGLET_ROW(StrandReport,
            newton,                                 // iterations used
            cuts,                                   // line search halvings
            residual,                               // largest coordinate of the last Newton step [m]
            unconverged,                            // 1 where iterations ran out
            stalled,                                // 1 where it is not at rest in the step, and yet has not moved
            stretch, bend, twist, gravity, kinetic, // energies at the end [J]
            max_stretch,                            // largest |l/l̄ − 1| of free edges
            flips,                                  // vertices whose sign changed
            winding_changes,                        // edges whose number of turns changed
            too_straight,                           // edges without twist in this step
            clamped,                                // negative eigenvalues of the elements' Hessians at the end
            nan);                                   // 1 where a position is not finite (the strand then keeps its last state)

// Effort of finding the end of a step.
struct StrandEffort {
    double iterations, cuts, residual;
};

// A plane in front of each vertex, which resists what comes behind it (energy/strand/plane.h). Null: there are none.
struct PlaneArrays {
    const double *normal = nullptr, *offset = nullptr, *stiffness = nullptr;
};

// A spring from each vertex to a target, ½ k ‖x − p‖², part of the inertia. Null: there are none.
struct SpringArrays {
    const double *target = nullptr, *stiffness = nullptr;
};

// Model and state of all strands, as pointers (see strand/model.h and strand/state.h).
struct StrandArrays : StrandCoefficients<const double *> {
    const int *offsets;
    const unsigned char *held;
    double mass_damping;
    const double *targets, *forces;
    double *positions, *velocities, *normals, *twist, *directors;
    double *last_positions, *last_velocities, *last_strains, *last_dt;
    PlaneArrays planes;   // of steps without contact, with a material frame
    SpringArrays springs; // of steps without contact
};

// Strands that one call of a kernel steps together, one per lane; `strands` are their numbers.
struct StrandGroup {
    const int *strands;
    int count;
};

// Linear system of a group whose step is solved from outside, together with its contacts. Coordinate k of vertex i of a lane's
// strand stands at [(dofs i + k) lanes + lane] of the unknowns and of the gradient. The element in row c + k of column c of the
// matrix stands at [(begin(c) + k) lanes + lane] (linear/band_layout.h).
struct StrandGroupSystem {
    double *x;        // unknowns: the initial guess
    double *gradient; // of the energy, at the x evaluated last
    double *matrix;   // lower band of the Hessian; its factor later
    BandLayout layout;
    int lanes, vertices;
    int padding; // unknowns behind the last that `solve` writes to

    int dofs() const { return layout.block; } // per vertex
};

// A group's step in phases, for a solver outside. It lives in the caller's memory and needs no destructor.
struct PhasedStep {
    // Scratch memory for the phases from here on, which keep nothing in it. Where one block of it serves all groups of a
    // thread, it stays in the cache.
    virtual void use(void *scratch) = 0;
    virtual StrandGroupSystem begin() = 0;
    virtual void energy(const double *x, double *energies) = 0;   // one per lane
    virtual void assemble(const double *x, double *energies) = 0; // gradient and matrix at x, with the energies
    virtual void factor() = 0;
    virtual void solve(double *b) = 0;                                                        // in place
    virtual void max_step(const double *x, const double *direction, double *steps) const = 0; // one per lane
    virtual void curved_end(const double *x, const double *direction, double *to) const = 0;  // of the path at step 1
    virtual void end(const double *x, const StrandEffort &effort, StrandReport *reports) = 0;

protected:
    ~PhasedStep() = default;
};

// clang-format off
RINGLET_DECLARE(
    int strand_lanes();
    size_t strand_workspace_bytes(int vertices); // for the step of a group of strands of at most that many vertices
    void step_strand_group(const StrandArrays &arrays, const StrandStep &step, StrandGroup group, void *workspace, StrandReport *reports);
    void relax_strand_frames(const StrandArrays &arrays, StrandGroup group, void *workspace, double *energies);
    double strand_elastic_energy(const StrandArrays &arrays, const StrandStep &step, int strand, const double *positions, void *workspace, double *gradient, double *hessian);
    // The arguments of a phased step, but for the scratch memory, must live as long as its memory.
    size_t phased_step_bytes(const StrandStep &step, int vertices);
    size_t phased_scratch_bytes(const StrandStep &step, int vertices);
    PhasedStep *make_phased_step(const StrandArrays &arrays, const StrandStep &step, StrandGroup group, void *memory, void *scratch);
)
// clang-format on

} // namespace ringlet
