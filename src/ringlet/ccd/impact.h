// Impacts: candidate pairs that come nearer on a move than their minimum separation.
#pragma once

#include "ringlet/collision/move_candidates.h"

#include <array>
#include <vector>

namespace ringlet {

struct Impact {
    std::array<int, 4> vertices;
    double toi;         // the pair keeps its minimum separation until then, in [0, 1]
    bool close = false; // it begins nearer than the largest minimum separation
};

// The time of impact of a candidate pair whose vertices move straight from `start` to `end`; above 1 if it has none. Where the
// pair's lower bound on the gap decides nothing, the gap at the start is measured and becomes the bound.
double time_of_impact(const CollisionMesh &mesh, CandidatePair &pair, View<Vec3> start, View<Vec3> end);

// In the order of the pairs.
std::vector<Impact> find_impacts(const CollisionMesh &mesh, const std::vector<CandidatePair *> &pairs, View<Vec3> start,
                                 View<Vec3> end);

// Marks the moving vertices of impacts.
void mark_vertices(const CollisionMesh &mesh, const std::vector<Impact> &impacts, std::vector<unsigned char> &marked);

// Truncates a whole move before its first impact; returns the fraction of it that is left.
double truncate_before_first(const std::vector<Impact> &impacts, View<Vec3> start, std::vector<Vec3> &end);

// What limit_move() or the corrections of an AdvectedMove did.
struct CcdReport {
    int candidates = 0;         // pairs
    int impacts = 0;            // of the move before any correction
    int corrected_vertices = 0; // moving vertices with an impact in any round
    double fraction = 1.0;      // of a limited move that everything makes; below 1 where no correction was found
};

} // namespace ringlet
