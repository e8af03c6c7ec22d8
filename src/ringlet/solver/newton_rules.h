// The rules of Newton's method: when it stops, how it damps its directions, which objects need more of its iterations, and what
// it does about those that do not move.
#pragma once

#include "ringlet/solver/search_path.h"
#include "ringlet/solver/settings.h"

#include <vector>

namespace ringlet {

// A cluster has converged when no coordinate of its search direction is larger than the tolerance.
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

// Damping of the relative motion of strands in contact (Levenberg 1944), so that neighbours move together before they part: a
// part of the stiffness of contacts, which falls from iteration to iteration and comes to nothing.
class RelativeDamping {
public:
    explicit RelativeDamping(bool on) : part_(on ? solver_settings::first_damping : 0.0) {}

    double part() const { return part_; }

    void end_iteration() {
        part_ *= solver_settings::damping_decay;
        if (part_ < solver_settings::least_damping) part_ = 0.0;
    }

private:
    double part_;
};

// Which objects the search has not moved, and what is tried with them.
// A cluster that has not moved is cautious until it moves: it takes the search direction itself. An object that does not move
// in that, nor in an extra iteration, is stuck: nothing helps it (docs/decisions/stalled_search.md).
class Stall {
public:
    explicit Stall(int objects) : moved_(objects, 0), cautious_(objects, 0), stuck_(objects, 0) {}

    // Takes the step length that the search has found for each object.
    void add_steps(const BlockSet &blocks, const std::vector<int> &cluster, const std::vector<double> &step, bool extra);

    const std::vector<unsigned char> &cautious() const { return cautious_; }

    // Objects that are not at rest in the step, and yet have not moved; `largest` is that of their last direction [m].
    std::vector<unsigned char> stalled(const std::vector<double> &largest, double tolerance) const;
    // Those of them that more iterations may help.
    std::vector<unsigned char> may_move(const std::vector<double> &largest, double tolerance) const;

private:
    std::vector<unsigned char> moved_, cautious_, stuck_; // objects
};

// Refinement: which objects need more iterations than were asked for, so that what is violent costs only where it is.
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
