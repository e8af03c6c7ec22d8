// A move on which kinematic vertices move, corrected round by round until it has no impacts.
#pragma once

#include "ringlet/ccd/impact.h"

#include <utility>
#include <vector>

namespace ringlet {

// Borrows all that it is made of; `end` is what corrections change. No pair has an impact when impacts() is empty, while every
// vertex moves straight from `start` to `end`.
class AdvectedMove {
public:
    AdvectedMove(MoveCandidates &pairs, View<Vec3> start, std::vector<Vec3> &end);

    const Candidates &candidates;
    const CollisionMesh &mesh;
    const View<Vec3> start; // [m]
    std::vector<Vec3> &end; // [m]

    const std::vector<Impact> &impacts() const { return impacts_; }

    // One round: correct(impacts) changes ends, and finds the impacts that are left.
    template <class Correct> void round(const Correct &correct) {
        correct(std::as_const(impacts_));
        find_impacts();
        ++report_.rounds;
    }

    CcdReport report() const;

private:
    void find_impacts();

    MoveCandidates &pairs_;
    std::vector<unsigned char> corrected_; // per vertex
    std::vector<Impact> impacts_;
    CcdReport report_;
};

} // namespace ringlet
