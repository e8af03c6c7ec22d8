// Limits a move on which nothing kinematic moves, so that staying is safe: pairs keep their minimum separation.
#pragma once

#include "ringlet/ccd/impact.h"

#include <vector>

namespace ringlet {

// A move of all dynamic vertices while prescribed ones stay.
struct PlannedMove {
    std::vector<Vec3> to;   // where it ends [m]
    std::vector<Vec3> apex; // the path is in the triangle of the start, this and the end; empty: it is straight [m]
};

// How an object yields to an impact that is `whole` in the mesh.
enum class Yield {
    as_a_whole,  // it keeps its shape and makes a fraction of its move
    near_impacts // the same, but one that could hardly move is corrected near its impacts alone
};

// Shortens a move from `start`, which `pairs` have begun or updated, so that no pair has an impact while every vertex goes
// straight to its end. Both whole objects of an impact make the same fraction of their moves; others are corrected near it.
// Apexes are scaled with the ends: until the move is committed an end may be updated to anywhere in the triangle of start, end
// and apex.
CcdReport limit_move(MoveCandidates &pairs, View<Vec3> start, PlannedMove &move, Yield yield);

} // namespace ringlet
