// Refinement: which objects need more Newton iterations than were asked for, so that what is violent costs only where it is.
#pragma once

#include "ringlet/solver/objective.h"

#include <vector>

namespace ringlet {

// How far each object wanted to go in a move, and the least fraction of that which it went.
struct ObjectMoves {
    std::vector<double> length, fraction; // [m]; 0 and 1 of those that are not active

    // A move from `now` to `wanted` was limited to `to`.
    ObjectMoves(const BlockSet &blocks, View<Vec3> now, View<Vec3> wanted, View<Vec3> to);

    void shorten(const std::vector<double> &t); // to those fractions
    bool are_full() const;
};

class Refinement {
public:
    explicit Refinement(const Objective &objective) : objective_(objective), limited_(objective.table.objects, 0) {}

    void add(const ObjectMoves &moves, double tolerance); // of each iteration, and of the initial guess

    // Activates the objects that were limited and are stretched or that `stay`, those that touch them and so on for some rings,
    // so that there is something to give way. False: there are none.
    bool activate_unfinished(BlockSet &blocks, View<Vec3> now, const std::vector<unsigned char> &stay);

private:
    const Objective &objective_;
    std::vector<unsigned char> limited_; // objects
};

} // namespace ringlet
