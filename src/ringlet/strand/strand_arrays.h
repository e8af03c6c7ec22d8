// The border between the portable core and the kernels of each instruction set: plain pointers and numbers.
#pragma once

#include "ringlet/linear/band_layout.h"
#include "ringlet/math/simd.h"

#include <cstddef>

namespace ringlet {

// How signs and turns are carried (scene/continuation_*.h), or the frame that makes them needless
// (scene/frame_objective.h).
enum class Continuation { history, least_energy, material_frame };

// How velocities and rates follow from positions, see strand_objective.h.
enum class Integrator { backward_euler, bdf2 };

// What keeps degenerate virtual triangles harmless (scene/continuation_history.h); each can be turned off to study it.
struct Safeguards {
    bool flip_history = true, winding_number = true, straight_fade = true;
};

struct StrandStep {
    double dt = 1.0 / 24;          // [s]
    double gravity[3] = {0, 0, 0}; // [m/s²]
    double wind[3] = {0, 0, 0};    // [m/s]
    int newton = 5;                // iterations at most
    double tolerance = 1e-7;       // [m]; a strand is done when no coordinate moves more
    Continuation continuation = Continuation::material_frame;
    Integrator integrator = Integrator::backward_euler;
    Safeguards safeguards; // of `history`
};

// What happened to one strand in one step.
struct StrandReport {
    double newton;                                 // iterations used
    double cuts;                                   // line search halvings
    double residual;                               // largest coordinate of the last Newton step [m]
    double unconverged;                            // 1 where iterations ran out
    double stretch, bend, twist, gravity, kinetic; // energies at the end [J]
    double max_stretch;                            // largest |l/l̄ − 1| of free edges
    double flips;                                  // vertices whose sign changed
    double winding_changes;                        // edges whose number of turns changed
    double too_straight;                           // edges without twist in this step
    double clamped;                                // eigenvalues of elements' Hessians that are negative at the end
    double nan;                                    // 1 where a position is not finite (the strand then keeps its last state)
};
inline constexpr int strand_report_columns = sizeof(StrandReport) / sizeof(double);

// What finding the end of a step took.
struct StrandEffort {
    double iterations, cuts, residual;
};

// Model and state of all strands, as pointers (see scene/strands.h for what each holds).
struct StrandArrays {
    const int *offsets;
    const unsigned char *held;
    const double *rest_length, *rest_angle, *rest_dihedral;
    const double *stretch_stiffness, *bend_stiffness, *twist_stiffness;
    const double *mass, *drag, *damping;
    double mass_damping;
    const double *targets, *forces;
    double *positions, *velocities, *normals, *twist, *directors;
    double *last_positions, *last_velocities, *last_strains, *last_dt;
};

// Strands that one call of a kernel steps together, one per lane.
struct StrandGroup {
    const int *strands;
    int count;
};

// The linear system of a group whose step is solved from outside, together with what its strands touch
// (scene/coupled_strands.h). Coordinate k of vertex i of a lane's strand stands at [(freedoms i + k) lanes + lane], in the
// unknowns as in their gradient; the element in row c + k of column c of its matrix at [(c band + k) lanes + lane].
struct StrandGroupSystem {
    double *x;        // unknowns: the guess to begin with
    double *gradient; // of the energy, at the x evaluated last
    double *matrix;   // lower band of the Hessian; its factor later
    BandLayout layout;
    int lanes, vertices;
    int padding; // unknowns behind the last that solving writes to

    int freedoms() const { return layout.block; } // of a vertex
};

// clang-format off
RINGLET_DECLARE(
    int strand_lanes();
    size_t strand_workspace(int vertices); // bytes that stepping a group of strands of at most that many vertices needs
    void step_strand_group(const StrandArrays &arrays, const StrandStep &step, StrandGroup group, void *workspace, StrandReport *reports);
    void relax_strand_frames(const StrandArrays &arrays, StrandGroup group, void *workspace, double *energies);
    // A group's step in phases; `memory` holds the group from begin to end, and what begin is given must live as long.
    size_t strand_group_bytes(const StrandStep &step, int vertices);
    StrandGroupSystem begin_strand_group(const StrandArrays &arrays, const StrandStep &step, StrandGroup group, void *memory);
    void strand_group_energies(void *memory, const double *x, double *energies); // one a lane
    void evaluate_strand_group(void *memory, const double *x, double *energies); // likewise, before it is assembled there
    void assemble_strand_group(void *memory, const double *x);                    // gradient and matrix where that was last
    void factor_strand_group(void *memory);
    void solve_strand_group(void *memory, double *b); // in place
    void strand_group_worth_going(void *memory, const double *x, const double *direction, double *parts); // one a lane
    void turn_strand_group(void *memory, const double *x, const double *direction, double *to); // where all of it leads
    void end_strand_group(void *memory, const double *x, const StrandEffort &effort, StrandReport *reports);
    double strand_group_energy(const StrandArrays &arrays, const StrandStep &step, int strand, const double *positions, void *workspace, double *gradient, double *hessian);
)
// clang-format on

} // namespace ringlet
