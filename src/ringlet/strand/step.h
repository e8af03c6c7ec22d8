// Time step and elastic energy of strands without contact.
#pragma once

#include "ringlet/strand/state.h"

#include <vector>

namespace ringlet {

// One time step. `targets` are the positions of held vertices at its end [m] (rows of free vertices are not read), `forces`
// external forces on the vertices [N]. One report per strand. The result does not depend on the number of threads.
void step_strands(const StrandModel &model, StrandState &state, View<Vec3> targets, View<Vec3> forces, const StrandStep &step,
                  std::vector<StrandReport> &reports);

// Elastic energy [J] at these positions with relaxed material frames, and its gradient by the free vertices [N] (rows of held
// vertices are zero). The Hessian is that of Newton's method, for one strand alone: dense, row-major, over 3 unknowns per
// vertex, 4 with material frames; null to leave it out.
double strand_energy(const StrandModel &model, const StrandState &state, Continuation continuation, View<Vec3> positions,
                     std::vector<Vec3> &gradient, std::vector<double> *hessian);

} // namespace ringlet
