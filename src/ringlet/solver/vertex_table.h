// The vertices of a scene in one row: those of the blocks' objects, then those of bodies.
#pragma once

#include "ringlet/collision/mesh.h"
#include "ringlet/contact/material.h"
#include "ringlet/contact/stencil.h"

#include <vector>

namespace ringlet {

struct VertexTable {
    int objects = 0;          // dynamic ones, which are the first of the mesh: those of the blocks
    int dynamic_vertices = 0; // theirs
    std::vector<double> mass; // per vertex [kg]; 0 of bodies
    CollisionMesh mesh;
    ContactMaterial material;

    int count() const { return int(mesh.object.size()); }
    int object_of(int vertex) const { return vertex < dynamic_vertices ? mesh.object[vertex] : -1; } // −1: of a body
    std::array<int, 2> objects_of(const Stencil &pair) const { return {object_of(pair.vertex[0]), object_of(pair.vertex[3])}; }
};

} // namespace ringlet
