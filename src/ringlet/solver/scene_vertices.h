// The vertices of a scene in one row: those of strands, of cloths, of bodies; and what contact knows of them. Strands, cloths
// and bodies are its objects, in this order; its parts are the objects that answer: strands and cloths.
#pragma once

#include "ringlet/cloth/cloth.h"
#include "ringlet/contact/contact_set.h"
#include "ringlet/strand/state.h"

#include <vector>

namespace ringlet {

// A surface that moves as it is told, closed or open, touched from both sides.
struct BodyModel {
    std::vector<Vec3> rest; // [m]
    std::vector<Triangle> triangles;
    double thickness = 0.0; // contact begins this far from the surface, besides what touches it [m]
    int material = 0;       // row of SceneContact::friction
};

// Cloth in a scene. Contact begins half its thickness from it.
struct SceneCloth {
    const ClothModel *model;
    ClothState *state;
    int material = 0;   // row of SceneContact::friction
    int pinned_to = -1; // the body that carries its held vertices: nothing is tested between the two; −1: none
};

struct SceneContact {
    double strand_radius = 5e-4;          // half the distance at which two strands begin to push [m]
    int strand_material = 0;              // row of `friction`
    std::vector<double> friction = {0.0}; // μ of each pair of materials, row-major
    double stiffness = 1.0;               // scales how hard contacts push
    double creep_speed = 1e-3;            // slower than this counts as sticking [m/s]
    double parting_speed = 2e-3;          // at which pairs that begin too near may part [m/s]
};

struct SceneVertices {
    int strands = 0;                     // how many
    std::vector<int> cloths, bodies;     // where each begins, and the end
    std::vector<Vec3> positions;         // [m]
    std::vector<double> mass;            // [kg]; 0 of bodies
    std::vector<Triangle> some_triangle; // if it is kinematic: one that moves rigidly with it, or thrice itself
    CollisionMesh mesh;
    ContactMaterial material; // stiffness and creep are those of a step

    int count() const { return int(positions.size()); }
    int parts() const { return strands + int(cloths.size()) - 1; }
    int part_of(int vertex) const { return mesh.object[vertex] < parts() ? mesh.object[vertex] : -1; } // −1: of a body
    int strand_vertices() const { return cloths.front(); }
    int moving_vertices() const { return bodies.front(); } // those of parts
};

// Bodies that `rooted_in` names (per strand, −1: none) carry the held vertices of strands.
SceneVertices number_vertices(const StrandModel &strands, const StrandState &state, const std::vector<SceneCloth> &cloths,
                              const std::vector<BodyModel> &bodies, const std::vector<int> &rooted_in,
                              const SceneContact &contact);

} // namespace ringlet
