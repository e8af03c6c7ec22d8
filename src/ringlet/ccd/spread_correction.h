// Corrections of a move and their spreading to neighbours, so that no edge is strained by more than a few per cent.
#pragma once

#include "ringlet/collision/candidates.h"

#include <vector>

namespace ringlet {

// A vertex replaces the fraction `weight` of its own motion by the same fraction of `motion`.
struct Correction {
    double weight = 0.0;
    Vec3 motion = Vec3::Zero(); // [m]
};

// Spreads corrections to the vertices that share an edge with a corrected one, and so on, with weights that decrease as slowly
// as `max_strain` of an edge asks.
void spread_correction(const Candidates &candidates, View<Vec3> start, View<Vec3> end, double max_strain,
                       std::vector<Correction> &corrections);

} // namespace ringlet
