// Strands: what is fixed (model), what moves (state), how to step them.
#pragma once

#include "ringlet/math/types.h"
#include "ringlet/strand/strand_arrays.h"

#include <array>
#include <vector>

namespace ringlet {

// What a lock is made of. A lock of many hairs that do not stick together moves like one of them, so these are a hair's values.
struct StrandMaterial {
    double youngs_modulus = 4e9;    // E [Pa]
    double radius = 35e-6;          // r [m]
    double density = 1300;          // ρ [kg/m³]
    double stretch_scale = 1;       // scales EA: below 1 the strand is easier to stretch than its E says
    double bend_scale = 1;          // scales EI
    double twist_ratio = 0.72;      // c = GJ / EI
    bool limit_twist = true;        // clamp c to [0, 1]
    double damping = 0.0;           // Kelvin–Voigt time β [s]: every strain resists its own rate with β times its stiffness
    double mass_damping = 0.0;      // α [1/s]: velocities decay at this rate
    double drag = 0.0;              // linear air drag per length [kg/(m s)]
    bool correct_resolution = true; // make coils of few vertices a turn as soft as smooth ones (rest/resolution.h)
};

// How the material varies: factors per vertex on what StrandMaterial says, each n long or empty (1 everywhere). An edge takes
// the mean of its two vertices.
struct StrandVariation {
    View<double> radius, stretch, bend, twist, damping;
};

// Fixed: packed like Curves, one row per vertex; row i of an edge quantity belongs to the edge from i to i+1.
struct StrandModel {
    std::vector<int> offsets;              // where each strand begins, and the end; strand count + 1
    std::vector<unsigned char> held;       // per vertex: 1 where it follows its target
    std::vector<double> rest_length;       // l̄ per edge [m]
    std::vector<double> rest_angle;        // θ̄ per vertex [rad], in [0, π]
    std::vector<double> rest_dihedral;     // φ̄ per edge [rad]
    std::vector<Vec3> rest_normal;         // of the corners, in the pose of the rest shape
    std::vector<Vec3> rest_tangent;        // of the edges, likewise
    std::vector<double> stretch_stiffness; // EA / l̄ per edge [N/m]
    std::vector<double> bend_stiffness;    // EI / l_v per vertex [N m]
    std::vector<double> twist_stiffness;   // c EI / l̄ per edge [N m]
    std::vector<double> mass;              // per vertex [kg]
    std::vector<double> drag;              // per vertex [kg/s]
    std::vector<double> damping;           // β per vertex [s]
    double mass_damping = 0.0;             // α [1/s]

    int strand_count() const { return int(offsets.size()) - 1; }
    int vertex_count() const { return offsets.back(); }
};

// Moving, with what the next step compares with: normals and twist (`history`) or the material frame; and, for BDF-2, the state
// that the last step began with.
struct StrandState {
    std::vector<Vec3> positions;  // [m]
    std::vector<Vec3> velocities; // [m/s]
    std::vector<Vec3> normals;    // per vertex: σ n of the last accepted step
    std::vector<double> twist;    // per edge: Δφ with its turns [rad]
    std::vector<Vec3> directors;  // per edge from the second: D of its material frame
    std::vector<Vec3> last_positions, last_velocities;
    std::vector<std::array<double, 4>> last_strains; // per vertex: length [m], two of bend, twist [rad]
    std::vector<double> last_dt;                     // per strand [s]; 0 where there is no such step, or not one of BDF-2
};

// The rest shape is measured from the polylines `rest` (offsets.back() points); every strand has at least 3 points, of which
// the root is held. Throws std::invalid_argument where lengths do not fit or an edge has no length.
StrandModel make_strand_model(View<int> offsets, View<Vec3> rest, View<unsigned char> held, const StrandMaterial &material,
                              const StrandVariation &variation = {});

// At rest at the given positions, with the normals and twist that they have and material frames turned to cost least.
StrandState make_strand_state(const StrandModel &model, View<Vec3> positions);

// One time step. `targets` holds where the held vertices are at its end (rows of free vertices are not read), `forces` what
// pulls at each vertex from outside [N]. One report per strand. The result does not depend on the number of threads.
void step_strands(const StrandModel &model, StrandState &state, View<Vec3> targets, View<Vec3> forces, const StrandStep &step,
                  std::vector<StrandReport> &reports);

// Energy [J] of the state's elastic terms, its gradient by the free vertices [N] (rows of held vertices are zero) and the
// Hessian that Newton uses (dense, row-major, over all unknowns of ONE strand: 3 a vertex, 4 with material frames; null to
// leave it out). Material frames take the turns that cost least at these positions.
double strand_energy(const StrandModel &model, const StrandState &state, Continuation continuation, View<Vec3> positions,
                     std::vector<Vec3> &gradient, std::vector<double> *hessian);

} // namespace ringlet
