// A scene: strands, cloths and kinematic bodies in contact, one implicit step for all of them.
#pragma once

#include "ringlet/cloth/block.h"
#include "ringlet/contact/contact_set.h"
#include "ringlet/scene/vertices.h"
#include "ringlet/solver/linear_system.h"
#include "ringlet/solver/report.h"

#include <memory>
#include <utility>
#include <vector>

namespace ringlet {

struct SceneStep {
    StrandStep strands; // time, forces and Newton's method of all blocks; model and integrator of the strands
    LinearSettings linear;
    int extra = 60; // Newton iterations more, at most, for strands that were limited and are stretched
};

struct SceneInput {
    View<Vec3> targets; // where prescribed and attached vertices end, of all vertices [m]
    View<Vec3> forces;  // external, of dynamic vertices [N]
};

// What a scene remembers from step to step besides the states of its strands and cloths.
struct SceneMemory {
    bool begun = false;
    std::vector<Vec3> bodies; // where their vertices are [m]
    std::vector<InitialOverlap> overlaps;
    std::vector<LaggedForce> lagged_forces;
    std::vector<double> loads; // of vertices [N]
    std::vector<FrictionState> friction;
    std::vector<std::pair<int, double>> penetrations; // vertices inside a body, and the heights that they are to have [m]
    std::vector<std::pair<int, Vec3>> lagging;        // prescribed vertices that did not arrive, and where they were led [m]
    std::vector<int> touched;                         // per cloth: the body that it had most contacts with; −1: none
};

class Scene {
public:
    // Borrows strands and cloths, which must outlive it. Bodies that `rooted_in` names (per strand, −1: none) carry the
    // prescribed vertices of strands: the two are not tested against each other.
    Scene(const StrandModel &model, StrandState &state, const std::vector<SceneCloth> &cloths,
          const std::vector<BodyModel> &bodies, const std::vector<int> &rooted_in, const SceneContact &contact);
    ~Scene();
    Scene(Scene &&) noexcept;

    // Takes one step, with a report of every strand and every cloth.
    SceneReport step(const SceneInput &input, const SceneStep &step, std::vector<StrandReport> &of_strands,
                     std::vector<ClothReport> &of_cloths);

    // Takes the positions of strands and cloths that were placed elsewhere than the last step left them. A step throws
    // std::invalid_argument where that was forgotten.
    void place();

    // The contacts of all pairs that are closer than their activation distance at the present positions, initial overlaps
    // included. Their forces are known in a step alone; no step depends on this.
    std::vector<Contact> touching();

    // Before the first step: the forces of contact pairs.
    void set_initial_forces(std::vector<InitialForce> forces);

    // Exempts a strand's vertex that begins inside a body, or too close to it, until it has come out: see
    // initial_penetration.h.
    void allow_penetration(int vertex, int body);
    int penetrating() const; // how many still are

    // Pairs that coincide where the scene is made: without a distance they have no direction to part in, and are exempt from
    // contact. A vertex of each of the two.
    const std::vector<std::array<int, 2>> &coincident() const;

    // Keeps the positions after each move of the last step. The first are those of its start after a rigid motion of
    // everything: no pair meets while every vertex goes straight from one to the next.
    void record(bool on);
    const std::vector<std::vector<Vec3>> &path() const;

    // A scene made in the same way, with its states and this memory, continues with the same bits.
    SceneMemory memory() const;
    void recall(const SceneMemory &memory);

    View<Vec3> positions() const;   // of all vertices: strands, cloths, bodies
    int dynamic_vertices() const;   // those of strands and cloths
    View<Contact> contacts() const; // of the last step

private:
    std::unique_ptr<struct SceneData> data_;
};

// A cloth alone: a scene of one block, without contact.
class ClothAlone {
public:
    // Borrows model and state, which must outlive it.
    ClothAlone(const ClothModel &model, ClothState &state)
        : scene_(no_strands_, no_state_, {{&model, &state}}, {}, {}, {.enabled = false}) {}

    // One step from the state as it is. `targets` and `forces` are those of the cloth's vertices.
    ClothReport step(const SceneInput &input, const SceneStep &step) {
        std::vector<StrandReport> of_strands;
        std::vector<ClothReport> of_cloths;
        scene_.place();
        scene_.step(input, step, of_strands, of_cloths);
        return of_cloths.front();
    }

private:
    StrandModel no_strands_{.offsets = {0}};
    StrandState no_state_;
    Scene scene_;
};

} // namespace ringlet
