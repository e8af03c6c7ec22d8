// The configuration of a scene: where all vertices are, with the candidate pairs that move along with them.
#pragma once

#include "ringlet/ccd/motion_limiter.h"
#include "ringlet/geometry/rigid_motion.h"
#include "ringlet/solver/report.h"
#include "ringlet/solver/vertex_table.h"

#include <vector>

namespace ringlet {

// A move of all dynamic vertices while prescribed ones stay.
struct PlannedMove {
    std::vector<Vec3> to;   // where it ends
    std::vector<Vec3> apex; // the path is in the triangle of the start, this and the end; empty: it is straight
};

class Configuration {
public:
    // `strands` and `cloths` say where each begins among the vertices, and the end; corrections spread along them.
    Configuration(const VertexTable &table, View<int> strands, View<int> cloths, std::vector<Vec3> positions,
                  double strand_radius);

    std::vector<Vec3> positions;
    PairCache pairs;

    // The pairs that are nearer than their activation distance.
    std::vector<ContactPair> contact_pairs();

    ConnectedMesh connected() const { return {table_.mesh, strands_, cloths_, &cloth_neighbours_}; }

    // Shortens a move so that no pair comes closer than it may. Strands keep their shape and take a fraction of the whole move
    // (`whole`), or may be limited near the pair alone where else they could hardly move. `lasts`: candidates serve later
    // moves.
    struct LimitSettings {
        bool whole = true, lasts = true;
        bool few = false; // vertices move: candidates are found for them alone
    };
    void limit(PlannedMove &move, const LimitSettings &settings, SceneReport &report);
    // The same where some vertices of the last limited move end elsewhere.
    void limit_again(PlannedMove &move, bool whole, View<unsigned char> changed, SceneReport &report);

    // Takes the last limited move, or any fraction of it.
    void commit(const std::vector<Vec3> &to);
    static void add(const CcdReport &limited, SceneReport &report);

    // Begins a step in the frame of its end: as if all vertices had made the motion that most make. No gap changes.
    void begin_step(const RigidMotion &motion_of_most);

    // Keeps the positions as the step begins and after each of its moves; no pair meets while vertices go straight from one to
    // the next.
    void record(bool on) { recording_ = on; }
    const std::vector<std::vector<Vec3>> &recorded() const { return recorded_; }

private:
    void bound(const PlannedMove &move, bool lasts);
    void limit(PlannedMove &move, bool whole, View<unsigned char> changed, SceneReport &report);
    void add_to_record();

    const VertexTable &table_;
    View<int> strands_, cloths_;
    VertexLists cloth_neighbours_;
    double strand_radius_;
    bool recording_ = false;
    std::vector<std::vector<Vec3>> recorded_;
};

} // namespace ringlet
