// Strands, cloths and kinematic bodies that touch: one implicit step for all of them.
#pragma once

#include "ringlet/solver/scene_solver.h"

#include <memory>
#include <utility>
#include <vector>

namespace ringlet {

struct SceneStep {
    StrandStep strands; // time, forces, Newton; cloths take theirs from it
    System system = System::automatic;
    double linear_tolerance = 0.1; // of the linear solution, relative
    int extra = 60;                // iterations more, at most, for strands that were held back and are stretched
    int most_substeps = 8;         // where bodies leave no way out a step is taken in parts
};

// Where a step ends for what is told where to be, and what pulls besides. Rows of the vertices of all strands, cloths, bodies.
struct SceneInput {
    View<Vec3> strand_targets, strand_forces; // [m], [N]
    View<Vec3> cloth_targets, cloth_forces;   // of held and attached vertices
    View<Vec3> body_targets;
};

// What happened in one step.
struct SceneReport {
    double newton = 0, cuts = 0, residual = 0, unconverged = 0;
    double linear_iterations = 0, linear_residual = 0;
    double candidates = 0, contacts = 0;      // pairs looked at, and of them those that push
    double closest = 0;                       // distance of two that touch, at the end [m]
    double violations = 0, zone_vertices = 0; // pairs that would have met, vertices held back for them
    double substeps = 0, fraction = 1;        // fraction < 1: bodies left no way out, the step ends early
    double time_pairs = 0, time_assemble = 0, time_solve = 0, time_search = 0, time_filter = 0; // [s]
};
inline constexpr int scene_report_columns = sizeof(SceneReport) / sizeof(double);

// What a scene remembers from step to step, besides the states of its strands and cloths.
struct SceneMemory {
    bool begun = false;
    std::vector<Vec3> bodies;                     // where their vertices are [m]
    ContactSet::Early early;                      // pairs that began too near
    std::vector<ContactSet::Expected> expected;   // what pairs are to bear
    std::vector<double> borne;                    // what vertices had to bear lately [N]
    std::vector<Hold> held;                       // pairs that touch
    std::vector<std::pair<int, double>> embedded; // vertices that are still inside a body, and how high they are to be [m]
    std::vector<int> touched;                     // per cloth: the body that it had most contacts with; −1: none
};

class Scene {
public:
    // Borrows strands and cloths, which must outlive it. Bodies that `rooted_in` names (per strand, −1: none) carry the held
    // vertices of strands: nothing is tested between the two.
    Scene(const StrandModel &model, StrandState &state, const std::vector<SceneCloth> &cloths,
          const std::vector<BodyModel> &bodies, const std::vector<int> &rooted_in, const SceneContact &contact);
    ~Scene();

    // One step, of which there is a report of every strand and every cloth.
    SceneReport step(const SceneInput &input, const SceneStep &step, std::vector<StrandReport> &of_strands,
                     std::vector<ClothReport> &of_cloths);

    // What touches where everything is now, without a step: of all pairs that are nearer than their distance, however they
    // began. How hard they push is known in a step alone; no step depends on this.
    std::vector<Contact> touching();

    // Before the first step: how what touches bears what lies on it, where it is known.
    void bear(std::vector<ContactSet::Bearing> bearing);

    // A vertex of a strand that begins inside a body, or too near to it, may be there until it has come out: it is pushed out
    // gently, and guarded like any other from then on.
    void excuse(int vertex, int body);
    int excused() const; // how many still are

    // Keeps where everything was after each move of the last step, the first being where the step began: nothing meets while
    // every vertex goes straight from one to the next.
    void record(bool on);
    const std::vector<std::vector<Vec3>> &path() const;

    // To go on elsewhere: a scene that was made in the same way, with its states and this memory, does the same, to the bit.
    SceneMemory memory() const;
    void recall(const SceneMemory &memory);

    View<Vec3> positions() const;                 // of all vertices: strands, cloths, bodies
    const std::vector<Contact> &contacts() const; // of the last step

private:
    struct Parts;
    std::unique_ptr<Parts> parts_;
};

} // namespace ringlet
