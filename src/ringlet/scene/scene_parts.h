// What a scene is made of, and how a step goes: scene.cpp has the step, scene_moves.cpp its moves, scene_newton.cpp Newton's
// method.
#pragma once

#include "ringlet/ccd/impact_zones.h"
#include "ringlet/ccd/motion_limiter.h"
#include "ringlet/scene/embedded.h"
#include "ringlet/scene/scene.h"
#include "ringlet/scene/scene_carry.h"
#include "ringlet/solver/contact_stiffness.h"
#include "ringlet/solver/scene_progress.h"
#include "ringlet/solver/scene_search.h"

#include <chrono>

namespace ringlet {

class Stopwatch {
public:
    explicit Stopwatch(double &sum) : sum_(sum), start_(std::chrono::steady_clock::now()) {}
    ~Stopwatch() { sum_ += std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count(); }

private:
    double &sum_;
    std::chrono::steady_clock::time_point start_;
};

// What limit() is told of a move on which nothing kinematic moves; the first three as limit_motion() has them.
struct LimitedMove {
    bool whole_strands = false;
    View<unsigned char> changed = {};
    std::vector<Vec3> *apex = nullptr;
    bool lasting = true; // motion bounds are to serve moves to come
    bool few = false;    // vertices move: pairs need not be cached for moves to come
};

// How everything went along with what is kinematic.
struct Carried {
    double fraction; // of the way
    bool rigidly;    // every strand with its root
};

struct Scene::Parts {
    const StrandModel &model;
    StrandState &state;
    SceneContact settings;
    std::vector<int> root_body; // per strand; −1: none
    std::vector<int> pinned_to; // per cloth; −1: none
    std::vector<int> touched;   // per cloth: the body that it had most contacts with; −1: none
    SceneVertices vertices;
    SceneSystem system;
    SceneSolver solver;
    ContactStiffness stiffness;
    PairCache near;
    VertexLists neighbours; // of the vertices of cloths

    std::vector<Embedded::Body> embedded_bodies; // per body
    Embedded embedded;
    bool recording = false, begun = false;
    std::vector<ContactSet::Bearing> bearing; // as everything begins
    std::vector<std::vector<Vec3>> path;

    // Within a step
    std::vector<Vec3> given; // where what is kinematic ends; where the rest began
    std::vector<int> rigid;  // per vertex: what it goes along with as one in this step, as carry_rigidly() has it
    RigidMotion as_one;      // how most of it goes along
    AlignedVector x;
    SceneWay way;
    std::vector<double> reach; // per part: how far Newton's method would last have gone [m]

    Parts(const StrandModel &model_, StrandState &state_, const std::vector<SceneCloth> &cloths,
          const std::vector<BodyModel> &bodies, const std::vector<int> &rooted_in, const SceneContact &contact);

    View<Vec3> positions() const { return vertices.positions; }
    SceneCarry carry() const { return {vertices, vertices.positions, given}; }

    SceneReport step(const SceneInput &input, const SceneStep &step, std::vector<StrandReport> &of_strands,
                     std::vector<ClothReport> &of_cloths);
    double advance(const SceneInput &input, const SceneStep &scene_step, StrandStep &step, SceneReport &report,
                   std::vector<StrandReport> &of_strands, std::vector<ClothReport> &of_cloths);

    void check(const SceneInput &input) const;
    void find_placed();
    void begin(double dt);
    std::vector<Contact> touching();
    void set_stiffness();
    void note_touched();
    SceneCarriers carriers(std::vector<int> &of_cloths, double dt) const;
    ConnectedMesh connected() const {
        return {vertices.mesh, View<int>(model.offsets), View<int>(vertices.cloths), &neighbours};
    }
    double limit(View<Vec3> now, std::vector<Vec3> &to, const LimitedMove &move, SceneReport &report);
    double resolve(View<Vec3> now, std::vector<Vec3> &to, int hopeful_rounds, SceneReport &report);
    void arrive(std::vector<Vec3> &now, const std::vector<Vec3> &to);
    void make_move(std::vector<Vec3> &now, const std::vector<Vec3> &to);
    RigidMotion motion_of_most(View<Vec3> now, View<Vec3> to) const;
    Carried go_along(std::vector<Vec3> &now, double dt, SceneReport &report);
    int newton(const SceneStep &scene_step, const StrandStep &step, std::vector<Vec3> &now, SceneProgress &progress,
               SceneReport &report);
    void hold_back(View<Vec3> now, bool whole, bool lasts, std::vector<Vec3> &to, SceneProgress &progress, SceneReport &report);
    std::vector<double> parts_left(View<Vec3> now, View<Vec3> wanted, View<Vec3> to) const;
    void take(View<Vec3> now, View<Vec3> wanted, View<Vec3> to);
    void begin_strands(const StrandArrays &arrays, const StrandStep &step);
    void begin_cloths(const SceneInput &input, const StrandStep &step, View<Vec3> now);
};

} // namespace ringlet
