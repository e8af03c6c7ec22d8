// Corrections of a move and their spreading to neighbours, so that no edge is strained by more than a few per cent.
#pragma once

#include "ringlet/collision/incidence.h"
#include "ringlet/collision/mesh.h"

#include <vector>

namespace ringlet {

// A collision mesh and how its moving vertices are connected: strands as chains, cloths as graphs. Objects are numbered strands
// first, then cloths.
struct ConnectedMesh {
    const CollisionMesh &mesh;
    View<int> strands;                             // first vertex of each strand, and the end
    View<int> cloths = {};                         // likewise of each cloth
    const VertexLists *cloth_neighbours = nullptr; // the vertices that share an edge with a vertex of cloth
};

// A vertex replaces the fraction `weight` of its own motion by the same fraction of `motion`.
struct Correction {
    double weight = 0.0;
    Vec3 motion = Vec3::Zero(); // [m]
};

// Largest strain of an edge that spreading may cause.
struct StrainLimit {
    double strand, cloth;
};

// Spreads a vertex's correction to its neighbours, with weights that decrease as slowly as the strain limit asks: along the
// listed strands in both directions, and over all cloths.
void spread_correction(const ConnectedMesh &connected, View<Vec3> start, View<Vec3> end, const StrainLimit &limit,
                       View<int> strands, std::vector<Correction> &corrections);

} // namespace ringlet
