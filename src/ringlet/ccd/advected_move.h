// A move on which kinematic vertices move, corrected round by round until it has no impacts.
#pragma once

#include "ringlet/ccd/impact.h"
#include "ringlet/ccd/spread_correction.h"
#include "ringlet/geometry/rigid_motion.h"

#include <utility>
#include <vector>

namespace ringlet {

// Borrows all that it is made of; `end` is what corrections change. No pair has an impact when impacts() is empty, while every
// vertex moves straight from `start` to `end`.
class AdvectedMove {
public:
    // `motion` is what nearly everything follows. Vertices with one number ≥ 0 in `rigid` share an affine motion and have no
    // impacts; empty: none do.
    AdvectedMove(const ConnectedMesh &connected, PairCache &pairs, View<Vec3> start, std::vector<Vec3> &end,
                 const RigidMotion &motion, View<int> rigid);

    const ConnectedMesh connected;
    const View<Vec3> start; // [m]
    std::vector<Vec3> &end; // [m]
    const RigidMotion motion;

    // Among the vertices that the last round changed or that had an impact in it.
    const std::vector<Impact> &impacts() const { return impacts_; }

    // One round: correct(impacts) changes ends, and finds the impacts that are left. A vertex that is changed no longer shares
    // an affine motion.
    template <class Correct> void round(const Correct &correct) {
        const std::vector<Vec3> before = end;
        correct(std::as_const(impacts_));
        find_impacts_again(before);
    }

    // From now on the vertex follows `motion`: it has no impact with others that do.
    void follow_motion(int vertex) { follows_[vertex] = 1; }

    CcdReport report() const;

private:
    void find_impacts_again(View<Vec3> before);

    PairCache &pairs_;
    std::vector<int> rigid_;
    std::vector<unsigned char> follows_, corrected_; // per vertex
    std::vector<Impact> impacts_;
    CcdReport report_;
};

} // namespace ringlet
