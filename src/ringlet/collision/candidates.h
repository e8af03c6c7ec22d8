// Candidate pairs: all that may come into contact while each vertex stays inside its motion bound, with lower bounds on gaps.
#pragma once

#include "ringlet/collision/broad_phase.h"
#include "ringlet/collision/motion_bounds.h"

#include <vector>

namespace ringlet {

struct CandidatePair : PrimitivePair {
    double min_gap;            // lower bound on the gap [m]
    std::array<int, 2> object; // of each primitive
};

// Found once for the many moves of a step (MoveCandidates). They only save work: contacts and impacts do not depend on which
// pairs are held, nor on earlier moves. Borrows the mesh, which must outlive it.
class Candidates {
public:
    explicit Candidates(const CollisionMesh &mesh) : mesh_(mesh), broad_phase_(mesh), bounds_(mesh) {}

    void clear() { bounds_.clear(), pairs_.clear(), refitted_all_ = of_one_move_ = false; }
    bool empty() const { return bounds_.empty(); } // there are no bounds

    // What pairs are found for.
    enum class Serve { this_move, later_moves };
    // Gives vertices that a move leads out of their bounds new ones, and finds their pairs. Where that are most, and where
    // there were no bounds, all are found anew. Where that happens again, pairs may be found for this move alone: without a
    // margin, and culled.
    void enclose(const Move &move, const MotionBounds::Fit &how, Serve serve = Serve::later_moves);

    // All vertices make one rigid motion from where they are, which changes no gap.
    void move_rigidly(const RigidMotion &motion, View<Vec3> from);

    const CollisionMesh &mesh() const { return mesh_; }
    const Incidence &incidence() const { return broad_phase_.incidence(); }
    const MotionBounds &bounds() const { return bounds_; }

    // In order. Whoever measures a gap may raise its bound to it, and who moves has to lower it.
    std::vector<CandidatePair> &pairs() { return pairs_; }

    // The pairs of escaped vertices on a move that have a changed vertex, in order: `boxes` are those of the move, and have the
    // origin of the bounds'. Vertices that have not escaped may be anywhere in their bounds.
    std::vector<CandidatePair> find_escaped(const SweptBoxes &boxes, View<unsigned char> escaped, View<unsigned char> changed) {
        return with_gaps(broad_phase_.find_escaped(boxes, bounds_.boxes(), escaped, changed));
    }

private:
    std::vector<CandidatePair> with_gaps(const std::vector<PrimitivePair> &found) const;
    std::vector<PrimitivePair> find_in_triangles(const Move &move);

    const CollisionMesh &mesh_;
    BroadPhase broad_phase_;
    MotionBounds bounds_;
    bool refitted_all_ = false; // by the last enclose()
    bool of_one_move_ = false;  // bounds without a margin, and pairs that serve no other
    std::vector<CandidatePair> pairs_;
};

} // namespace ringlet
