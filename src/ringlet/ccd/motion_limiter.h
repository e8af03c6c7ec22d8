// Limits a move on which nothing kinematic moves, so that staying is safe: pairs keep their minimum separation.
#pragma once

#include "ringlet/ccd/impact.h"
#include "ringlet/ccd/spread_correction.h"

#include <vector>

namespace ringlet {

struct LimitMotionInput {
    ConnectedMesh connected;
    View<Vec3> start; // [m]
    // Strands are only scaled as a whole; otherwise one that could hardly move is corrected near its impacts alone.
    bool whole_strands = false;
    // Continues the move that was limited last: vertices whose end differs since. Empty: a new move.
    View<unsigned char> changed = {};
};

// Changes `end` so that no pair has an impact while every vertex moves straight from `start` to `end`. A strand is scaled as a
// whole, which keeps its shape, and both strands of an impact to the same fraction. Cloth is corrected locally.
// The apexes of curved paths, if given, are scaled with `end`: until the move is committed an end may be updated to anywhere in
// the triangle of start, end and apex.
CcdReport limit_motion(const LimitMotionInput &input, PairCache &pairs, std::vector<Vec3> &end,
                       std::vector<Vec3> *apex = nullptr);

// One move of limit_motion(). The strands of an impact are scaled to its time, and one that then hits a strand with a smaller
// fraction stops before that. Such chains are resolved within a round, event by event, the smallest fraction first. What was
// corrected locally is checked in a further round. After some rounds strands with an impact rest, and two that rest have none.
class MotionLimiter {
public:
    // `pairs` has begun the move from `input.start` to `end`, which is changed, as is `apex`.
    MotionLimiter(const LimitMotionInput &input, PairCache &pairs, std::vector<Vec3> &end, std::vector<Vec3> *apex);

    // Resolves impacts among the vertices that the last round changed. Whether others may follow: events find those of strands
    // with one another, and bodies stay.
    bool resolve(const std::vector<Impact> &impacts);
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

    const LimitMotionInput &input_;
    const PairCache &pairs_;
    const CollisionMesh &mesh_;
    std::vector<Vec3> &end_;
    std::vector<Vec3> *apex_; // null: paths are straight
    int strands_, round_ = 0;
    bool corrected_locally_ = false;          // in any round: what was known of impacts no longer holds
    std::vector<CandidatePair> transient_;    // as in the first round; later rounds change those of the cache
    Lists<CandidatePair *> pairs_of_strand_;  // pairs with another strand that may close on their paths
    std::vector<double> fraction_, measured_; // of its motion that each strand makes, now and when paths were measured
    std::vector<unsigned char> changed_;      // per vertex
    std::vector<int> changed_list_;
};

} // namespace ringlet
