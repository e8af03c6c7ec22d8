// A time step of cloth that is alone: backward Euler by Newton's method with a line search on the true energy, each system
// solved by preconditioned conjugate gradients.
#pragma once

#include "ringlet/cloth/cloth_objective.h"

namespace ringlet {

struct ClothStep {
    int newton = 5;                 // iterations at most
    double tolerance = 1e-7;        // [m]; done when no coordinate moves more
    double linear_tolerance = 1e-3; // of the residual of each linear system
    int linear_iterations = 2000;   // at most, of each
};

// What happened in one step. All are doubles, so that a report is a row of an array.
struct ClothReport {
    double newton;                          // iterations used
    double linear;                          // iterations of conjugate gradients, of all systems together
    double cuts;                            // line search halvings
    double residual;                        // largest coordinate of the last Newton step [m]
    double linear_residual;                 // largest ‖b − A x‖ / ‖b‖ of the systems
    double unconverged;                     // 1 where iterations ran out
    double stretch, bend, gravity, kinetic; // energies at the end [J]
    double max_stretch;                     // largest strain along warp or weft
    double nan;                             // 1 where a position is not finite (the cloth then keeps its last state)
};
inline constexpr int cloth_report_columns = sizeof(ClothReport) / sizeof(double);

// Steps the state of the objective's cloth. `targets` must have a row per vertex where any is held or attached. The result does
// not depend on the number of threads.
ClothReport step_cloth(ClothObjective &objective, ClothState &state, const ClothForces &forces, const ClothStep &step);

// The end of a step whose positions were found elsewhere: velocities, the energies of the report.
void end_cloth_step(const ClothObjective &objective, ClothState &state, const ClothForces &forces, const std::vector<Vec3> &end,
                    ClothReport &report);

} // namespace ringlet
