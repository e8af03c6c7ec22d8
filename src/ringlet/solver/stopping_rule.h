// The stopping rule of Newton's method: a cluster has converged when no coordinate of its search direction is larger than the
// tolerance.
#pragma once

#include "ringlet/solver/objective.h"

#include <vector>

namespace ringlet {

class StoppingRule {
public:
    StoppingRule(int objects, double tolerance) : tolerance_(tolerance), converged_(objects, 0) {}

    // Takes the largest coordinate of each object's direction [m]. A damped direction is too short to tell.
    void measure(const Objective &objective, const std::vector<double> &largest);

    const std::vector<unsigned char> &converged() const { return converged_; } // objects
    bool all_converged() const;

    // Of each object's direction, how much it takes: nothing where its cluster had converged before, however long others take.
    const std::vector<double> &part() const { return part_; }

private:
    double tolerance_;
    std::vector<unsigned char> converged_;
    std::vector<double> part_;
};

} // namespace ringlet
