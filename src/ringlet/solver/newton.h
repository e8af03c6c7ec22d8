// Newton's method on the objective of a step, with contacts found anew at every iterate and moves that pass through nothing.
#pragma once

#include "ringlet/contact/stiffness.h"
#include "ringlet/solver/configuration.h"
#include "ringlet/solver/line_search.h"
#include "ringlet/solver/linear_system.h"
#include "ringlet/solver/refinement.h"

namespace ringlet {

struct NewtonSettings {
    int iterations = 5;      // at most
    int extra = 60;          // more, at most, for objects that were limited and are stretched
    double tolerance = 1e-7; // [m]; converged when no coordinate of the search direction is larger
    LinearSettings linear;
};

class Newton {
public:
    // Borrows all of them. The table's contact stiffness follows the loads.
    Newton(VertexTable &table, Objective &objective, LinearSystem &system, Configuration &configuration,
           ContactStiffness &stiffness);

    // Iterates from x, which are the positions of the configuration, in a step that began at `start`. Returns the effort.
    SolverEffort minimise(View<Vec3> start, const NewtonSettings &settings, Refinement &refinement, AlignedVector &x,
                          SceneReport &report);

private:
    struct Iteration {
        int number;
        double damping; // of relative motion, as a part of the stiffness of contacts; falls from iteration to iteration
        std::vector<unsigned char> converged; // per object: no coordinate of its cluster's direction is above the tolerance
        // The first of several: most contacts on this path are new, and nothing in the direction knows their energies. Coupled
        // objects take it without a search, in which a few of these contacts would halve the motion of their whole cluster.
        bool leads_into_contact;
        SearchPath path;
        std::vector<double> step; // per object: the fraction of the direction that is tried
        // Per object: the search has found no step of descent for its cluster, which takes the direction itself next.
        std::vector<unsigned char> cautious;
        PlannedMove move;
        std::vector<Vec3> full_step; // of the last iteration of all objects: where its search direction leads
    };

    void find_contacts(View<Vec3> start, double damping, SceneReport &report);
    void stop_converged(double tolerance, Iteration &iteration) const;
    void solve(const NewtonSettings &settings, const AlignedVector &x, SceneReport &report, Iteration &iteration);
    void choose_path(const AlignedVector &x, Iteration &iteration) const;
    LineSearchResult search(const Iteration &iteration, SceneReport &report, AlignedVector &x);
    void set_full_step(Iteration &iteration) const;
    void measure_left(View<Vec3> initial, const Iteration &iteration, View<unsigned char> stalled, SceneReport &report) const;
    void mark_cautious(const LineSearchResult &found, bool extra, Iteration &iteration);
    std::vector<unsigned char> stalled(double tolerance) const;
    bool activate_unfinished(double tolerance, Refinement &refinement); // false: nothing is
    void accept(const LineSearchResult &found, SceneReport &report, Iteration &iteration, AlignedVector &x);

    VertexTable &table_;
    Objective &objective_;
    LinearSystem &system_;
    Configuration &configuration_;
    ContactStiffness &stiffness_;
    std::vector<double> largest_;      // per object: largest coordinate of its last search direction [m]
    std::vector<unsigned char> moved_; // per object: in an iteration of this step
    std::vector<unsigned char> stuck_; // per object: nothing has helped it to move
};

} // namespace ringlet
