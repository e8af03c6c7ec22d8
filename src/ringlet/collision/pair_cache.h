// The pair cache: candidate pairs with lower bounds on their gaps, found once for the many moves of a step.
#pragma once

#include "ringlet/collision/broad_phase.h"
#include "ringlet/collision/motion_bounds.h"
#include "ringlet/collision/narrow_phase.h"
#include "ringlet/collision/primitive_paths.h"

#include <vector>

namespace ringlet {

struct CandidatePair : PrimitivePair {
    double min_gap;            // lower bound on the gap where the pair is, as of the last committed move [m]
    std::array<int, 2> object; // of each primitive
};

// Each cached pair stores a lower bound on its gap; the paths of moves since the last distance query are subtracted from it.
// While the bound is large enough, a move needs no distance query. Pairs are cached for vertices that stay inside their motion
// bounds; those of escaped vertices are found for one move and are transient. The cache only skips work: contacts and impacts
// do not depend on what it holds. Borrows the mesh, which must outlive it.
class PairCache {
public:
    explicit PairCache(const CollisionMesh &mesh);

    void clear();

    struct BoundsOptions {
        double margin;       // of bounds beyond the paths of the move, on each side [m]
        double max_path;     // a bound encloses a longer path's start alone [m]
        bool lasting = true; // pairs are to serve moves to come; otherwise they may be cached for this move alone
    };
    // Before a move begins: gives vertices that would escape new bounds, and caches their pairs. Where most would escape, all
    // bounds are fitted anew; where that happens again, and need not last, pairs are cached for this move alone.
    void update_bounds(const Move &move, const BoundsOptions &options);

    // Begins a move from the present positions. Until it is committed its end may change: for `changed` vertices, and to points
    // in the triangle of start, first end and apex, or without an apex of start and first end.
    void begin_move(const Move &move);
    void update_move(const Move &move, View<unsigned char> changed);
    // Vertices whose paths became shorter without any impact: the next update takes them along with those that change then.
    void defer_update(View<unsigned char> changed) { deferred_.assign(changed.begin(), changed.end()); }
    void commit_move(View<Vec3> start, View<Vec3> end); // or any fraction of the move

    // Between moves: all vertices have moved by one rigid motion, which changes no gap.
    void move_rigidly(View<Vec3> from, View<Vec3> to);

    // Pairs that may have an impact on the move, in order; after an update only those with a changed vertex. Whoever measures a
    // gap at the start of the move may raise min_gap to it.
    const std::vector<CandidatePair *> &impact_candidates() { return impact_candidates_; }
    // Cached pairs that may have one wherever in their triangles the vertices are, since the move began.
    const std::vector<CandidatePair *> &path_candidates() { return path_candidates_; }
    // Upper bounds on the lengths of the paths of a pair's primitives, as of the last update [m].
    std::array<double, 2> path_lengths(const CandidatePair &pair) const { return paths_.lengths(pair); }
    // Pairs of escaped vertices, in order; update_move() replaces them.
    const std::vector<CandidatePair> &transient_pairs() const { return transient_; }

    // Pairs nearer than their activation distance at the present positions, in order. Raises the lower bounds that it measures.
    std::vector<ContactPair> contact_pairs(View<Vec3> positions);
    // Pairs with a marked object that may come into contact anywhere on the move, in order.
    ReachablePairs reachable_pairs(View<unsigned char> objects) const;

    // All pairs that may have an impact on the move are cached, however far each side gets.
    bool is_bounded() const { return !bounds_.any_escaped(); }
    // Whether contact_pairs() is exact: after an update of the bounds or a move, until clear().
    bool is_complete() const { return complete_; }
    int size() const { return int(cached_.size() + transient_.size()); }

private:
    enum class State {
        Empty,   // no bounds, no cached pairs
        Bounded, // all pairs of vertices inside their bounds are cached
        OneMove  // the same without margins, and only pairs that may come into contact on one move
    };

    void fit_boxes(const Move &move);
    std::vector<CandidatePair> pairs_of(const Candidates &found) const;
    std::vector<CandidatePair> find_transient(View<unsigned char> changed);
    template <class Filter> std::vector<CandidatePair *> cull_straight(const Filter &filter) const;
    void add_transient_candidates();
    bool may_contact(const CandidatePair &pair) const { return pair.min_gap - paths_.length(pair) < pair.d_hat; }
    bool may_impact(const CandidatePair &pair) const {
        return pair.min_gap - paths_.length(pair) < collision::impact_distance * pair.d_hat;
    }
    bool escaped(const CandidatePair &pair) const { return bounds_.any_escaped() && paths_.escaped(pair); }

    const CollisionMesh &mesh_;
    const MeshSubset all_;
    BroadPhase broad_phase_;
    MotionBounds bounds_;
    SweptBoxes boxes_; // of the move
    PrimitivePaths paths_;
    State state_ = State::Empty;
    bool refitted_all_ = false; // by the last update of the bounds
    bool worn_ = false;         // bounds have moved rigidly, and shrunk, since they were fitted
    bool complete_ = false;
    std::vector<unsigned char> deferred_; // vertices; empty: none

    std::vector<CandidatePair> cached_, transient_; // in order
    std::vector<CandidatePair *> reachable_, path_candidates_,
        impact_candidates_; // reachable: cached pairs that may come into contact
};

} // namespace ringlet
