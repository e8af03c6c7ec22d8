// Refinement: which objects need more Newton iterations than were asked for, so that what is violent costs only where it is.
#pragma once

#include "ringlet/solver/objective.h"

#include <vector>

namespace ringlet {

class Refinement {
public:
    explicit Refinement(const Objective &objective);

    // A move from `now` to `wanted` was limited to `to`.
    void add_move(View<Vec3> now, View<Vec3> wanted, View<Vec3> to);
    void add_steps(const std::vector<double> &t); // what fraction of its move each object took
    void end_iteration(double tolerance);         // also after the initial guess

    bool all_moved_fully() const; // in the last move

    // Activates the objects that were limited and are stretched or that `stay`, those that touch them and so on for some rings,
    // so that there is something to give way. False: there are none.
    bool activate_unfinished(BlockSet &blocks, View<Vec3> now, const std::vector<unsigned char> &stay);

private:
    const Objective &objective_;
    std::vector<double> length_, fraction_; // per object: of its move [m], and the least fraction of it that was taken
    std::vector<unsigned char> limited_;    // per object
};

} // namespace ringlet
