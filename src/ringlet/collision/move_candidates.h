// The candidate pairs of one move: which of them it may bring into contact, or to an impact.
#pragma once

#include "ringlet/collision/candidates.h"
#include "ringlet/collision/narrow_phase.h"
#include "ringlet/collision/primitive_paths.h"

#include <vector>

namespace ringlet {

// Each pair stores a lower bound on its gap; the lengths of paths are subtracted from it. While the bound is large enough, no
// distance is computed. Pairs of vertices that escape their bounds on the move are found for it alone, and are transient.
// Borrows the candidates.
class MoveCandidates {
public:
    explicit MoveCandidates(Candidates &candidates);
    const Candidates &candidates() const { return candidates_; }

    // Begins a move from the present positions, for which there are bounds. Until it is committed its end may change: to points
    // in the triangle of start, first end and apex, or without an apex of start and first end.
    void begin(const Move &move);
    void update(const Move &move, View<unsigned char> changed);
    // An update where paths became shorter and are known to have no impact.
    void shorten(const Move &move, View<unsigned char> changed);
    // The vertices are at `end` now: that of the move, or at any fraction of it.
    void commit(View<Vec3> start, View<Vec3> end);

    // Pairs that may have an impact on the move, in order; after an update only those with a changed vertex. Whoever measures a
    // gap at the start of the move may raise min_gap to it.
    const std::vector<CandidatePair *> &impact_candidates() const { return impact_candidates_; }
    // Pairs of vertices in their bounds that may have one wherever in their triangles these are.
    const std::vector<CandidatePair *> &path_candidates() const { return path_candidates_; }
    // Upper bounds on the lengths of the paths of a pair's primitives [m].
    std::array<double, 2> path_lengths(const CandidatePair &pair) const { return paths_.lengths(pair); }
    // Pairs of escaped vertices, in order; an update replaces them.
    const std::vector<CandidatePair> &transient_pairs() const { return transient_; }
    bool any_escaped() const { return any_escaped_; }

    // Pairs nearer than their activation distance where the last move was begun or committed, in order. Raises the lower bounds
    // that it measures.
    std::vector<ContactPair> contact_pairs(View<Vec3> positions);
    // Pairs with a marked object that may come into contact anywhere on the move, in order.
    ReachablePairs reachable_pairs(View<unsigned char> objects) const;

    int size() const { return int(candidates_.pairs().size() + transient_.size()); }

private:
    MeshSubset refit(const Move &move, View<unsigned char> changed);
    template <class Filter> std::vector<CandidatePair *> cull_straight(const Filter &filter) const;
    void add_transient_candidates();
    bool may_contact(const CandidatePair &pair) const { return pair.min_gap - paths_.length(pair) < pair.d_hat; }
    bool may_impact(const CandidatePair &pair) const {
        return pair.min_gap - paths_.length(pair) < collision::impact_distance * pair.d_hat;
    }

    Candidates &candidates_;
    const CollisionMesh &mesh_;
    const MeshSubset all_;
    std::vector<unsigned char> escaped_; // vertices
    bool any_escaped_ = false;
    SweptBoxes boxes_; // of the move
    PrimitivePaths paths_;
    std::vector<CandidatePair> transient_;
    // Reachable: pairs of vertices in their bounds that may come into contact.
    std::vector<CandidatePair *> reachable_, path_candidates_, impact_candidates_;
};

} // namespace ringlet
