// Limits a move on which nothing kinematic moves, so that staying is safe: pairs keep their minimum separation.
#pragma once

#include "ringlet/ccd/impact.h"

#include <vector>

namespace ringlet {

// A move of all dynamic vertices while prescribed ones stay.
struct PlannedMove {
    std::vector<Vec3> to;   // where it ends [m]
    std::vector<Vec3> apex; // the path is in the triangle of the start, this and the end; empty: it is straight [m]
};

// How strands yield that have an impact.
enum class StrandLimit {
    whole,       // a strand keeps its shape and makes a fraction of its move
    near_impacts // the same, but one that could hardly move is corrected near its impacts alone
};

struct MoveLimits {
    View<int> offsets; // first vertex of each strand, and the end; strands are the first objects of the mesh
    View<Vec3> start;  // [m]
    StrandLimit strands = StrandLimit::near_impacts;
};

// Shortens a move, which `pairs` have begun or updated, so that no pair has an impact while every vertex goes straight to its
// end. Both strands of an impact make the same fraction of their moves. Cloth is corrected near its impacts. Apexes are scaled
// with the ends: until the move is committed an end may be updated to anywhere in the triangle of start, end and apex.
CcdReport limit_move(const MoveLimits &limits, MoveCandidates &pairs, PlannedMove &move);

// One call of limit_move(). The strands of an impact are scaled to its time, and one that then hits a strand with a smaller
// fraction stops before that. Such chains are resolved within a round, event by event, the smallest fraction first. What was
// corrected locally is checked in a further round. After some rounds strands with an impact rest, and two that rest have none.
class MoveLimiter {
public:
    // `pairs` has begun the move, which is changed.
    MoveLimiter(const MoveLimits &limits, const MoveCandidates &pairs, PlannedMove &move);

    // Resolves impacts among the vertices that the last round changed.
    void resolve(const std::vector<Impact> &impacts);
    // Whether impacts may be left: events find those of strands with one another, and bodies stay.
    bool may_leave_impacts() const;
    const std::vector<unsigned char> &changed() const { return changed_; } // vertices, in the last round

private:
    // At `fraction` of their motions strands a and b have an impact. Valid while their own fractions are unchanged.
    struct Event {
        double fraction;
        int a, b; // −1: not a moving strand
        double fraction_a, fraction_b;

        bool operator>(const Event &other) const {
            if (fraction != other.fraction) return fraction > other.fraction;
            return a != other.a ? a > other.a : b > other.b;
        }
    };

    std::vector<int> correct_locally(const std::vector<Impact> &impacts);
    void limit_strands(const std::vector<Impact> &impacts, const std::vector<int> &corrected);
    void limit_strand(int strand, double fraction, std::vector<Event> &events);
    void add_event(const Impact &impact, std::vector<Event> &events) const;
    std::array<int, 2> strands_of(const Impact &impact) const;
    int strand_of(int v, int w) const;
    void scale_motion(int v, double factor);
    void mark_changed(int v) {
        if (!changed_[v]) changed_list_.push_back(v);
        changed_[v] = 1;
    }

    void prefetch(View<CandidatePair *> pairs, size_t k) const;
    bool may_have_impact(const CandidatePair &pair) const;

    const MoveLimits &limits_;
    const MoveCandidates &pairs_;
    const CollisionMesh &mesh_;
    PlannedMove &move_;
    int strands_, round_ = 0;
    bool any_cloths_;                         // other objects that move
    bool corrected_locally_ = false;          // in any round: what was known of impacts no longer holds
    std::vector<CandidatePair> transient_;    // as in the first round; later rounds change those of the cache
    Lists<CandidatePair *> pairs_of_strand_;  // pairs with another strand that may close on their paths
    std::vector<double> fraction_, measured_; // of its motion that each strand makes, now and when paths were measured
    std::vector<unsigned char> changed_;      // per vertex
    std::vector<int> changed_list_;
};

} // namespace ringlet
