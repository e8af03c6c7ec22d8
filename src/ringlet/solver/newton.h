// Newton's method on the objective of a step, with contacts found anew at every iterate and moves that pass through nothing.
#pragma once

#include "ringlet/contact/stiffness.h"
#include "ringlet/solver/configuration.h"
#include "ringlet/solver/line_search.h"
#include "ringlet/solver/linear_system.h"
#include "ringlet/solver/newton_rules.h"
#include "ringlet/solver/search_path.h"

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
    void find_contacts(View<Vec3> start, double damping, std::vector<unsigned char> &moved, SceneReport &report);
    void solve(const LinearSettings &settings, const AlignedVector &x, AlignedVector &direction, SceneReport &report);
    void follow_loads(const AlignedVector &direction);
    std::vector<double> choose_path(const AlignedVector &x, const std::vector<unsigned char> &cautious, SearchPath &path) const;
    LineSearchResult search(const SearchPath &path, std::vector<unsigned char> accepted, bool into_contact, AlignedVector &x,
                            SceneReport &report);
    void accept(PlannedMove move, const LineSearchResult &found, AlignedVector &x, SceneReport &report);
    std::vector<Vec3> end_of(const AlignedVector &direction) const;
    void measure_left(View<Vec3> initial, View<Vec3> full_step, View<unsigned char> stalled, SceneReport &report) const;

    VertexTable &table_;
    Objective &objective_;
    LinearSystem &system_;
    Configuration &configuration_;
    ContactStiffness &stiffness_;
};

} // namespace ringlet
