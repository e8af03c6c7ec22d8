#include "ringlet/solver/newton.h"

#include "ringlet/math/parallel_copy.h"
#include "ringlet/solver/newton_rules.h"

#include <algorithm>

namespace ringlet {

Newton::Newton(VertexTable &table, Objective &objective, LinearSystem &system, Configuration &configuration,
               ContactStiffness &stiffness)
    : table_(table), objective_(objective), system_(system), configuration_(configuration), stiffness_(stiffness) {}

SolverEffort Newton::minimise(View<Vec3> start, const NewtonSettings &settings, Refinement &refinement, AlignedVector &x,
                              SceneReport &report) {
    const std::vector<Vec3> initial = parallel_copy(configuration_.positions);
    RelativeDamping damping(objective_.blocks.all_exact()); // damped hair pulls at a cloth that holds it, and strains
    StoppingRule stopping(table_.objects, settings.tolerance);
    Stall stall(table_.objects);
    SearchPath path(objective_.blocks.size());
    std::vector<double> largest(table_.objects, 0.0);    // per object: coordinate of its last search direction [m]
    std::vector<Vec3> full_step;                         // where the last search direction of all objects leads
    std::vector<unsigned char> moved(table_.objects, 1); // since contacts were found
    int number = 0;
    for (bool finished = false; !finished && number < settings.iterations + settings.extra; ++number) {
        const bool extra = number >= settings.iterations, last = number + 1 >= settings.iterations;
        if (extra && !refinement.activate_unfinished(objective_.blocks, configuration_.positions,
                                                     stall.may_move(largest, settings.tolerance)))
            break;
        find_contacts(start, damping.part(), moved, report);
        solve(settings.linear, x, path.straight, report);
        measure_direction(objective_.blocks, path.straight, largest);
        stopping.measure(objective_, largest);
        shorten(objective_.blocks, stopping.part(), path);
        follow_loads(path.straight);
        if (!extra) full_step = end_of(path.straight);

        const std::vector<double> longest = choose_path(x, stall.cautious(), path);
        // A strand that could hardly move is limited near the pair alone, so that the rest of it follows in the first
        // iteration. In extra ones a single pair could hold it for good. Between these its shape counts.
        const Yield yield = number > 0 && !extra ? Yield::as_a_whole : Yield::near_impacts;
        const auto serve = last ? Candidates::Serve::later_moves : Candidates::Serve::this_move;
        LimitedPath limited = limit_path(objective_, configuration_, x, {serve, yield, stall.cautious()}, path, report);
        limited.moves.shorten(longest);
        finished = stopping.all_converged() && limited.moves.are_full();

        const LineSearchResult found = search(path, stopping.converged(), number == 0 && !last, x, report);
        limited.moves.shorten(found.step);
        refinement.add(limited.moves, settings.tolerance);
        stall.add_steps(objective_.blocks, objective_.couplings.clusters(), found.step, extra);
        accept(std::move(limited.move), found, x, report);
        damping.end_iteration();
    }
    std::vector<unsigned char> stalled = stall.stalled(largest, settings.tolerance);
    measure_left(initial, full_step, stalled, report);
    report.stalled = double(std::count(stalled.begin(), stalled.end(), 1));
    const double residual = largest.empty() ? 0.0 : *std::max_element(largest.begin(), largest.end());
    return {double(number), report.cuts, residual, residual <= settings.tolerance, std::move(stalled)};
}

// Of the objects that have moved since they were found last, and of those that are active.
void Newton::find_contacts(View<Vec3> start, double damping, std::vector<unsigned char> &moved, SceneReport &report) {
    const Stopwatch watch(report.time_pairs);
    for (int o = 0; o < table_.objects; ++o) moved[o] |= objective_.blocks.is_active(o);
    objective_.find_contacts(configuration_.contact_pairs(moved), moved, start, configuration_.positions, damping);
    moved = objective_.blocks.active_objects();
}

void Newton::solve(const LinearSettings &settings, const AlignedVector &x, AlignedVector &direction, SceneReport &report) {
    {
        const Stopwatch watch(report.time_assemble);
        system_.assemble(x, settings);
    }
    const Stopwatch watch(report.time_solve);
    const LinearSystem::Result solved = system_.solve(settings, direction);
    report.linear_iterations += solved.iterations;
    report.linear_residual = solved.residual;
}

// Normal forces and the stiffness of contacts.
void Newton::follow_loads(const AlignedVector &direction) {
    objective_.lag_normal_forces(direction);
    if (stiffness_.raise_loads(objective_.contacts)) stiffness_.set_levels(table_.mesh, table_.material);
}

// Bends the path as far as each object may go; returns which fraction of its direction that is. The matrix is positive
// definite, so its direction is one of descent; what is bent, or shortened object by object, need not be. So cautious clusters
// go straight, all of one fraction.
std::vector<double> Newton::choose_path(const AlignedVector &x, const std::vector<unsigned char> &cautious,
                                        SearchPath &path) const {
    const BlockSet &blocks = objective_.blocks;
    path.bend.fill(0.0);
    std::vector<double> longest = max_step(blocks, x, path.straight);
    share_least(objective_.couplings.clusters(), cautious, longest);
    shorten(blocks, longest, path);
    bend(blocks, x, path);
    straighten(blocks, cautious, path);
    return longest;
}

// The first of several paths leads `into_contact`: most contacts on it are new, and nothing in the direction knows their
// energies. Coupled objects accept it without a search, in which a few of these contacts would halve the motion of their whole
// cluster.
LineSearchResult Newton::search(const SearchPath &path, std::vector<unsigned char> accepted, bool into_contact,
                                AlignedVector &x, SceneReport &report) {
    const Stopwatch watch(report.time_search);
    std::vector<unsigned char> searched = objective_.blocks.active_objects();
    for (int o = 0; o < table_.objects; ++o) {
        accepted[o] |= into_contact && objective_.couplings.couples(o);
        searched[o] &= !accepted[o];
    }
    const ReachablePairs pairs = configuration_.pairs.reachable_pairs(searched);
    const LineSearchResult found = line_search(objective_, pairs, path, accepted, x);
    report.cuts += found.cuts;
    return found;
}

void Newton::accept(PlannedMove move, const LineSearchResult &found, AlignedVector &x, SceneReport &report) {
    const BlockSet &blocks = objective_.blocks;
    if (found.cuts > 0) { // objects no longer move in the proportion that was limited
        std::vector<unsigned char> changed(table_.count(), 0);
        for (int v = 0; v < table_.dynamic_vertices; ++v)
            if (found.step[table_.mesh.object[v]] < 1.0) changed[v] = 1, move.to[v] = blocks.position(x, v);
        move.apex.clear();
        configuration_.limit_again(move, Yield::as_a_whole, changed, report);
    }
    configuration_.commit(move.to);
    blocks.scatter(configuration_.positions, x);
}

std::vector<Vec3> Newton::end_of(const AlignedVector &direction) const {
    std::vector<Vec3> end = parallel_copy(configuration_.positions);
    parallel_for(table_.dynamic_vertices, [&](int v) {
        if (table_.mesh.moves[v]) end[v] += objective_.blocks.position(direction, v);
    });
    return end;
}

// The part of what is left that goes on with the motion so far tells how much of that is missing; the rest is noise of contacts
// that come and go. Of objects that have stalled all of it is missing.
void Newton::measure_left(View<Vec3> initial, View<Vec3> full_step, View<unsigned char> stalled, SceneReport &report) const {
    if (full_step.empty()) return; // not a single iteration
    for (int v = 0; v < table_.dynamic_vertices; ++v) {
        if (!table_.mesh.moves[v]) continue;
        const Vec3 moved = configuration_.positions[v] - initial[v], left = full_step[v] - configuration_.positions[v];
        report.moved += moved.squaredNorm();
        report.left += stalled[table_.mesh.object[v]] ? left.squaredNorm() : moved.dot(left);
    }
}

} // namespace ringlet
