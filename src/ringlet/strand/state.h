// The state of strands, and what acts on it without contact: the time step and the elastic energy.
#pragma once

#include "ringlet/strand/model.h"

#include <array>
#include <vector>

namespace ringlet {

// Motion of strands with the references of the next step: normals and twist (`history`) or material frames. For BDF-2, also the
// state at the start of the last step.
struct StrandState {
    std::vector<Vec3> positions;  // [m]
    std::vector<Vec3> velocities; // [m/s]
    std::vector<Vec3> normals;    // per vertex: σ n of the last accepted step
    std::vector<double> twist;    // per edge: Δφ with its turns [rad]
    std::vector<Vec3> directors;  // per edge from the second: D of its material frame
    std::vector<Vec3> last_positions, last_velocities;
    std::vector<std::array<double, 4>> last_strains; // per vertex: length [m], two of bend, twist [rad]
    std::vector<double> last_dt;                     // per strand [s]; 0 where the last step is none of BDF-2
};

// At rest at the given positions, with their normals and twist. `directors`: of the material frames; relaxed ones by default.
StrandState make_strand_state(const StrandModel &model, View<Vec3> positions, View<Vec3> directors = {});

// Least factor, at most `most`, on the stiffness of bend and twist with which each strand is stable at rest in this state. The
// fraction `left` of its stiffness remains in reserve. Infinite where `most` is not enough (rest/stability.h).
std::vector<double> stabilising_stiffness(const StrandModel &model, const StrandState &state, View<double> left, double most);

// Model and state as pointers for the kernels. All arguments must live as long as the result.
StrandArrays arrays_of(const StrandModel &model, StrandState &state, View<Vec3> targets, View<Vec3> forces);

// A plane in front of each vertex, or of none; see PlaneArrays. Only material frames have them.
struct StrandPlanes {
    View<Vec3> normal;
    View<double> offset, stiffness;
};

// A spring from each vertex to a target [m], of a stiffness [N/m] that may be 0; see SpringArrays.
struct StrandSprings {
    View<Vec3> target;
    View<double> stiffness;
};

// One time step. `targets` are the positions of held vertices at its end [m] (rows of free vertices are not read), `forces`
// external forces on the vertices [N]. One report per strand. The result does not depend on the number of threads.
void step_strands(const StrandModel &model, StrandState &state, View<Vec3> targets, View<Vec3> forces, const StrandStep &step,
                  std::vector<StrandReport> &reports, const StrandPlanes &planes = {}, const StrandSprings &springs = {});

// Elastic energy [J] at these positions with relaxed material frames, and its gradient by the free vertices [N] (rows of held
// vertices are zero). The Hessian is that of Newton's method, for one strand alone: dense, row-major, over 3 unknowns per
// vertex, 4 with material frames; null to leave it out.
double strand_energy(const StrandModel &model, const StrandState &state, Continuation continuation, View<Vec3> positions,
                     std::vector<Vec3> &gradient, std::vector<double> *hessian);

} // namespace ringlet
