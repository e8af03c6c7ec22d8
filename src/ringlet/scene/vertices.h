// The vertices of a scene: those of strands, of cloths and of bodies, in this order.
#pragma once

#include "ringlet/cloth/model.h"
#include "ringlet/contact/tie.h"
#include "ringlet/solver/vertex_table.h"
#include "ringlet/strand/state.h"

#include <vector>

namespace ringlet {

// A surface whose motion is prescribed, closed or open, touched from both sides.
struct BodyModel {
    std::vector<Vec3> rest; // [m]
    std::vector<Triangle> triangles;
    double thickness = 0.0; // contact begins this far from the surface, besides what touches it [m]
    int material = 0;       // row of SceneContact::friction
};

// A cloth in a scene. Contact begins half its thickness from it.
struct SceneCloth {
    const ClothModel *model;
    ClothState *state;
    int material = 0;   // row of SceneContact::friction
    int pinned_to = -1; // the body that carries its prescribed vertices: the two are not tested; −1: none
};

struct SceneContact {
    bool enabled = true;                  // without contact nothing is tested
    double strand_radius = 5e-4;          // half the activation distance of two strands [m]
    std::vector<double> strand_radii;     // per vertex of strands, in place of it where there are any; none is smaller
    std::vector<Tie> ties;                // of vertices of strands
    int strand_material = 0;              // row of `friction`
    std::vector<double> friction = {0.0}; // μ of each pair of materials, row-major
    double stiffness = 1.0;               // scales the contact stiffness
    double creep_speed = 1e-3;            // slower than this counts as sticking [m/s]
    double parting_speed = 2e-3;          // of initial overlaps; 0: they stay [m/s]
};

struct SceneVertices : VertexTable {
    int strands = 0;                 // how many
    std::vector<int> cloths, bodies; // the first vertex of each, and the end
    std::vector<Triangle> carriers;  // of prescribed vertices: a triangle that moves rigidly with it, or thrice itself

    int strand_vertices() const { return cloths.front(); }
};

// Numbers all vertices. Bodies that `rooted_in` names (per strand, −1: none) carry the
// prescribed vertices of strands.
SceneVertices number_vertices(const StrandModel &strands, const StrandState &state, const std::vector<SceneCloth> &cloths,
                              const std::vector<BodyModel> &bodies, const std::vector<int> &rooted_in,
                              const SceneContact &contact);

} // namespace ringlet
