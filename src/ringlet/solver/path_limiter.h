// Limits a search path where it would lead through a contact.
#pragma once

#include "ringlet/solver/configuration.h"
#include "ringlet/solver/refinement.h"
#include "ringlet/solver/search_path.h"

namespace ringlet {

struct PathLimits {
    Candidates::Serve serve;
    Yield yield;                               // of what has an impact on the shortened path, too
    const std::vector<unsigned char> &uniform; // per object: its cluster takes one fraction of the path
};

struct LimitedPath {
    PlannedMove move; // that the path leads to
    ObjectMoves moves;
};

// Shortens the path from x, which are the positions, until no pair comes closer than it may.
// Strands first take the bent path. What meets something early on it goes straight instead, and half as far: the linear system
// knows the contacts in that direction, while the bend leads the rest of a strand anywhere. What meets something later goes
// that fraction. Both are limited once more.
LimitedPath limit_path(const Objective &objective, Configuration &configuration, const AlignedVector &x,
                       const PathLimits &limits, SearchPath &path, SceneReport &report);

} // namespace ringlet
