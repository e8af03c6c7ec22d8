// The configuration of a scene: where all vertices are, with the candidate pairs that move along with them.
#pragma once

#include "ringlet/ccd/limit_move.h"
#include "ringlet/geometry/rigid_motion.h"
#include "ringlet/solver/report.h"
#include "ringlet/solver/vertex_table.h"

#include <vector>

namespace ringlet {

class Configuration {
public:
    // `radius` scales the margin of motion bounds [m].
    Configuration(const VertexTable &table, std::vector<Vec3> positions, double radius);

    std::vector<Vec3> positions;
    Candidates candidates;
    MoveCandidates pairs; // of the last move

    // The pairs that are nearer than their activation distance: all, or those with a marked object.
    std::vector<ContactPair> contact_pairs();
    std::vector<ContactPair> contact_pairs(View<unsigned char> objects);

    // Shortens a move so that no pair comes closer than it may.
    void limit(PlannedMove &move, Yield yield, Candidates::Serve serve, SceneReport &report);
    // The same where some vertices of the last limited move end elsewhere.
    void limit_again(PlannedMove &move, Yield yield, View<unsigned char> changed, SceneReport &report);

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
    void begin(const Move &move, Candidates::Serve serve);
    void find_candidates(); // where there are none
    void limit_begun(PlannedMove &move, Yield yield, SceneReport &report);
    void add_to_record();

    const VertexTable &table_;
    double radius_;
    bool recording_ = false;
    std::vector<std::vector<Vec3>> recorded_;
};

} // namespace ringlet
