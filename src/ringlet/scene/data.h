// What a scene is made of.
#pragma once

#include "ringlet/contact/stiffness.h"
#include "ringlet/scene/initial_penetration.h"
#include "ringlet/scene/scene.h"
#include "ringlet/solver/newton.h"
#include "ringlet/strand/block.h"

namespace ringlet {

struct SceneData {
    const StrandModel &model;
    StrandState &state;
    const SceneContact contact;
    const std::vector<int> rooted_in;          // per strand: the body that carries its root; −1: none
    const std::vector<int> pinned_to;          // per cloth; −1: none
    std::vector<int> touched;                  // per cloth: the body that it had most contacts with; −1: none
    std::vector<std::pair<int, Vec3>> lagging; // prescribed vertices that did not arrive, and where the step led them [m]

    SceneVertices vertices;
    Configuration configuration; // owns the positions
    std::vector<std::unique_ptr<StrandBlock>> strands;
    std::vector<std::unique_ptr<ClothBlock>> cloths;
    BlockSet blocks;
    Objective objective;
    LinearSystem system;
    ContactStiffness stiffness;
    Newton newton;

    std::vector<InitialPenetration::Body> bodies;
    InitialPenetration penetration;
    std::vector<std::array<int, 2>> coincident; // a vertex of each of the two primitives of exempt pairs
    std::vector<InitialForce> initial_forces;
    bool begun = false; // whether the initial overlaps are known

    SceneData(const StrandModel &model, StrandState &state, const std::vector<SceneCloth> &cloths,
              const std::vector<BodyModel> &bodies, const std::vector<int> &rooted_in, const SceneContact &contact);

    void exempt_coincident_pairs();
    bool is_placed() const; // strands and cloths are where the positions have them
    void take_placed();     // positions become those of strands and cloths
};

// One step, in scene/step.cpp.
SceneReport take_step(SceneData &scene, const SceneInput &input, const SceneStep &settings);

} // namespace ringlet
