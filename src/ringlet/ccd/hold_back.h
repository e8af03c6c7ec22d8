// Where nothing kinematic moves, so that staying is safe: what would meet is held back.
#pragma once

#include "ringlet/ccd/filter_scene.h"
#include "ringlet/ccd/meeting.h"

#include <vector>

namespace ringlet {

// Strands of pairs that would meet go only as far as that, as a whole, and both equally far; one that would then meet a strand
// that does not go as far goes no further than that one. So what is stopped stops others, in the order in which they meet. One
// that could hardly move is in the first rounds held back near the pair alone, so that the rest of it can follow. What would
// meet after some more rounds stays: two that stay do not meet. A cloth is held back near the pair, and stays as a whole only
// when all else fails.
class HoldBack {
public:
    // Of a move from `start` to `end`, which is changed; `near` has set out on it.
    HoldBack(const FilterScene &scene, const NearPairs &near, View<Vec3> start, std::vector<Vec3> &end);

    void round(const std::vector<Met> &met);                               // of what has changed in the last
    const std::vector<unsigned char> &changed() const { return changed_; } // vertices, in the last round

private:
    // At `go` strands a and b would meet if they went further than that. Valid while they go as far as they did.
    struct Event {
        double go;
        int a, b; // −1: it does not move as a strand
        double go_a, go_b;

        bool operator>(const Event &other) const {
            if (go != other.go) return go > other.go;
            return a != other.a ? a > other.a : b > other.b;
        }
    };

    std::vector<int> hold_near(const std::vector<Met> &met); // says which strands are not to stop as a whole
    void stop(const std::vector<Met> &met, const std::vector<int> &held_near);
    void stop(int strand, double go, std::vector<Event> &events);
    void note(const Met &pair, std::vector<Event> &events) const;
    int strand_of(int v, int w) const; // an edge's; −1: it is none, or is held
    void scale(int strand, double part);
    void draw_back(int v, double part); // leaves it that part of its way
    void change(int v) {
        if (!changed_[v]) touched_.push_back(v);
        changed_[v] = 1;
    }

    const FilterScene &scene_;
    View<Vec3> start_;
    std::vector<Vec3> &end_;
    int strands_, round_ = 0;
    std::vector<NearPair> passing_;      // as they were at first: rounds change what `near` has of them
    Lists<const NearPair *> of_strands_; // pairs with another whose way comes near
    std::vector<double> go_;             // per strand: how much of its way is left to it
    std::vector<unsigned char> changed_;
    std::vector<int> touched_; // the vertices that have changed
};

} // namespace ringlet
