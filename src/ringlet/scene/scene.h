// Strands and kinematic bodies that touch: one implicit step for all of them.
#pragma once

#include "ringlet/contact/broad_phase.h"
#include "ringlet/contact/contact_set.h"
#include "ringlet/contact/step_filter.h"
#include "ringlet/scene/strands.h"

#include <memory>
#include <vector>

namespace ringlet {

// A surface that moves as it is told, closed or open, touched from both sides.
struct BodyModel {
    std::vector<Vec3> rest; // [m]
    std::vector<Triangle> triangles;
    double thickness = 0.0; // contact begins this far from the surface, besides what touches it [m]
    int material = 0;       // row of SceneContact::friction
};

struct SceneContact {
    double strand_radius = 5e-4;          // half the distance at which two strands begin to push [m]
    int strand_material = 0;              // row of `friction`
    std::vector<double> friction = {0.0}; // μ of each pair of materials, row-major
    double stiffness = 1.0;               // scales how hard contacts push
    double creep_speed = 1e-3;            // slower than this counts as sticking [m/s]
};

struct SceneStep {
    StrandStep strands;             // time, forces, Newton
    double system_tolerance = 0.05; // of the linear solution, relative
    int most_substeps = 8;          // where bodies leave no way out a step is taken in parts
};

// What happened in one step.
struct SceneReport {
    double newton = 0, cuts = 0, residual = 0, unconverged = 0;
    double linear_iterations = 0, linear_residual = 0;
    double candidates = 0, contacts = 0;      // pairs looked at, and of them those that push
    double closest = 0;                       // distance of two that touch, at the end [m]
    double violations = 0, zone_vertices = 0; // pairs that would have met, vertices held back for them
    double substeps = 0, fraction = 1;        // fraction < 1: bodies left no way out, the step ends early
    double energy = 0;                        // what Newton minimised, at its end [J]
    double time_pairs = 0, time_assemble = 0, time_solve = 0, time_search = 0, time_filter = 0; // [s]
};
inline constexpr int scene_report_columns = sizeof(SceneReport) / sizeof(double);

class Scene {
public:
    // Borrows the strands; both must outlive it. Bodies that `rooted_in` names (per strand, −1: none) carry the held vertices
    // of strands: nothing is tested between the two.
    Scene(const StrandModel &model, StrandState &state, const std::vector<BodyModel> &bodies, const std::vector<int> &rooted_in,
          const SceneContact &contact);
    ~Scene();

    // One step to where the held vertices of strands and all vertices of bodies are told to be.
    SceneReport step(View<Vec3> strand_targets, View<Vec3> strand_forces, View<Vec3> body_targets, const SceneStep &step,
                     std::vector<StrandReport> &reports);

    // A vertex of a strand that begins inside a body, or too near to it, may be there until it has come out: it is pushed out
    // gently, and guarded like any other from then on.
    void excuse(int vertex, int body);
    int excused() const; // how many still are

    // Keeps where everything was after each move of the last step, the first being where the step began: nothing meets while
    // every vertex goes straight from one to the next.
    void record(bool on);
    const std::vector<std::vector<Vec3>> &path() const;

    View<Vec3> positions() const;                 // of all vertices: strands, then bodies
    const std::vector<Contact> &contacts() const; // of the last step

private:
    struct Parts;
    std::unique_ptr<Parts> parts_;
};

} // namespace ringlet
