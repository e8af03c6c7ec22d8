// Which objects of a line search must take a shorter step.
#pragma once

#include "ringlet/solver/objective.h"

#include <vector>

namespace ringlet {

// In clusters whose energies are above their bounds in sum, those that cause it with those that they touch. Where none does, or
// `whole_clusters`, all of the cluster must. Only objects that are searched count, and only those that move can go less far.
std::vector<unsigned char> too_far(const Objective &objective, const std::vector<unsigned char> &searched,
                                   const std::vector<double> &step, const std::vector<double> &energy,
                                   const std::vector<double> &bound, bool whole_clusters);

} // namespace ringlet
