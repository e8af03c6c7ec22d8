#include "ringlet/solver/newton.h"

#include "ringlet/solver/path_limiter.h"

#include <algorithm>

namespace ringlet {

Newton::Newton(VertexTable &table, Objective &objective, LinearSystem &system, Configuration &configuration,
               ContactStiffness &stiffness)
    : table_(table), objective_(objective), system_(system), configuration_(configuration), stiffness_(stiffness) {}

SolverEffort Newton::minimise(View<Vec3> start, const NewtonSettings &settings, Refinement &refinement, AlignedVector &x,
                              SceneReport &report) {
    largest_.assign(table_.objects, 0.0);
    moved_.assign(table_.objects, 0);
    stuck_.assign(table_.objects, 0);
    // Damped hair pulls at a cloth that holds it, and strains.
    const double damping = objective_.blocks.all_exact() ? solver_settings::first_damping : 0.0;
    const std::vector<unsigned char> none(table_.objects, 0);
    Iteration iteration{0, damping, none, false, SearchPath(objective_.blocks.size()), {}, none, {}, {}};
    const std::vector<Vec3> initial = configuration_.positions;
    int &number = iteration.number;
    for (bool all_converged = false; !all_converged; ++number) {
        if (number >= settings.iterations + settings.extra) break;
        if (number >= settings.iterations && !activate_unfinished(settings.tolerance, refinement)) break;
        find_contacts(start, iteration.damping, report);
        iteration.leads_into_contact = number == 0 && settings.iterations > 1;
        solve(settings, x, report, iteration);
        if (number < settings.iterations) set_full_step(iteration);
        choose_path(x, iteration);
        // A strand that could hardly move is limited near the pair alone, so that the rest of it follows in the first
        // iteration. In extra ones a single pair could hold it for good. Between these its shape counts.
        iteration.move =
            limit_path(objective_, configuration_, x,
                       {number > 0 && number < settings.iterations, number + 1 >= settings.iterations, iteration.cautious},
                       iteration.path, refinement, report);
        refinement.add_steps(iteration.step);
        all_converged =
            std::count(iteration.converged.begin(), iteration.converged.end(), 0) == 0 && refinement.all_moved_fully();
        const LineSearchResult found = search(iteration, report, x);
        mark_cautious(found, number >= settings.iterations, iteration);
        refinement.add_steps(found.step);
        refinement.end_iteration(settings.tolerance);
        accept(found, report, iteration, x);
        iteration.damping *= solver_settings::damping_decay;
        if (iteration.damping < solver_settings::least_damping) iteration.damping = 0.0;
    }
    std::vector<unsigned char> stalled_objects = stalled(settings.tolerance);
    measure_left(initial, iteration, stalled_objects, report);
    report.stalled = double(std::count(stalled_objects.begin(), stalled_objects.end(), 1));
    const double residual = largest_.empty() ? 0.0 : *std::max_element(largest_.begin(), largest_.end());
    return {double(number), report.cuts, residual, residual <= settings.tolerance, std::move(stalled_objects)};
}

void Newton::set_full_step(Iteration &iteration) const {
    iteration.full_step = configuration_.positions;
#pragma omp parallel for schedule(static)
    for (int v = 0; v < table_.dynamic_vertices; ++v)
        if (table_.mesh.moves[v]) iteration.full_step[v] += objective_.blocks.position(iteration.path.straight, v);
}

// The part of what is left that goes on with the motion so far tells how much of that is missing; the rest is noise of contacts
// that come and go. Of objects that have stalled all of it is missing.
void Newton::measure_left(View<Vec3> initial, const Iteration &iteration, View<unsigned char> stalled,
                          SceneReport &report) const {
    if (iteration.full_step.empty()) return; // not a single iteration
    for (int v = 0; v < table_.dynamic_vertices; ++v) {
        if (!table_.mesh.moves[v]) continue;
        const Vec3 moved = configuration_.positions[v] - initial[v];
        const Vec3 left = iteration.full_step[v] - configuration_.positions[v];
        report.moved += moved.squaredNorm();
        report.left += stalled[table_.mesh.object[v]] ? left.squaredNorm() : moved.dot(left);
    }
}

void Newton::find_contacts(View<Vec3> start, double damping, SceneReport &report) {
    const Stopwatch watch(report.time_pairs);
    const std::vector<Vec3> &now = configuration_.positions;
    objective_.find_contacts(configuration_.pairs.contact_pairs(now), start, now, damping);
}

void Newton::solve(const NewtonSettings &settings, const AlignedVector &x, SceneReport &report, Iteration &iteration) {
    {
        const Stopwatch watch(report.time_assemble);
        system_.assemble(x, settings.linear);
    }
    const Stopwatch watch(report.time_solve);
    AlignedVector &direction = iteration.path.straight;
    const LinearSystem::Result solved = system_.solve(settings.linear, direction);
    report.linear_iterations += solved.iterations;
    report.linear_residual = solved.residual;
    measure_direction(objective_.blocks, direction, largest_);
    stop_converged(settings.tolerance, iteration);
    objective_.lag_normal_forces(direction);
    if (stiffness_.raise_loads(objective_.contacts)) stiffness_.set_levels(table_.mesh, table_.material);
}

// A cluster that has converged stays from then on, however long others take. A damped direction is too short to tell.
void Newton::stop_converged(double tolerance, Iteration &iteration) const {
    const std::vector<int> &cluster = objective_.couplings.clusters();
    std::vector<unsigned char> small(table_.objects, 1), before(table_.objects, 1); // of clusters
    if (iteration.damping > 0.0)
        for (const Contact &contact : objective_.contacts.contacts())
            if (contact.damping > 0.0) small[cluster[table_.object_of(contact.vertex[0])]] = 0;
    for (int o = 0; o < table_.objects; ++o) {
        small[cluster[o]] &= largest_[o] <= tolerance;
        before[cluster[o]] &= iteration.converged[o];
    }
    std::vector<double> part(table_.objects, 1.0);
    for (int o = 0; o < table_.objects; ++o) {
        iteration.converged[o] = small[cluster[o]];
        if (small[cluster[o]] && before[cluster[o]]) part[o] = 0.0;
    }
    shorten(objective_.blocks, part, iteration.path);
}

// How far objects may go, and how their paths bend. The matrix is positive definite, so its direction is one of descent; what
// is bent, or shortened object by object, need not be. So cautious clusters go straight, all of one fraction.
void Newton::choose_path(const AlignedVector &x, Iteration &iteration) const {
    const BlockSet &blocks = objective_.blocks;
    SearchPath &path = iteration.path;
    path.bend.fill(0.0);
    iteration.step = max_step(blocks, x, path.straight);
    share_least(objective_.couplings.clusters(), iteration.cautious, iteration.step);
    shorten(blocks, iteration.step, path);
    bend(blocks, x, path);
    straighten(blocks, iteration.cautious, path);
}

// A cluster that has not moved is cautious until it moves. Where that does not help, nor an extra iteration, nothing does.
void Newton::mark_cautious(const LineSearchResult &found, bool extra, Iteration &iteration) {
    const BlockSet &blocks = objective_.blocks;
    const std::vector<int> &cluster = objective_.couplings.clusters();
    std::vector<unsigned char> moved(table_.objects, 0); // clusters
    for (int o = 0; o < table_.objects; ++o) moved[cluster[o]] |= blocks.is_active(o) && found.step[o] > 0.0;
    for (int o = 0; o < table_.objects; ++o) {
        if (!blocks.is_active(o)) continue;
        moved_[o] |= found.step[o] > 0.0;
        stuck_[o] = found.step[o] == 0.0 && (extra || iteration.cautious[o]);
        iteration.cautious[o] = !moved[cluster[o]];
    }
}

bool Newton::activate_unfinished(double tolerance, Refinement &refinement) {
    std::vector<unsigned char> stays = stalled(tolerance);
    for (int o = 0; o < table_.objects; ++o) stays[o] &= !stuck_[o];
    return refinement.activate_unfinished(objective_.blocks, configuration_.positions, stays);
}

// Objects that are not at rest in the step, and yet have not moved.
std::vector<unsigned char> Newton::stalled(double tolerance) const {
    std::vector<unsigned char> stalled(table_.objects);
    for (int o = 0; o < table_.objects; ++o) stalled[o] = !moved_[o] && largest_[o] > tolerance;
    return stalled;
}

LineSearchResult Newton::search(const Iteration &iteration, SceneReport &report, AlignedVector &x) {
    const Stopwatch watch(report.time_search);
    std::vector<unsigned char> accepted = iteration.converged, searched = objective_.blocks.active_objects();
    for (int o = 0; o < table_.objects; ++o) {
        accepted[o] |= iteration.leads_into_contact && objective_.couplings.couples(o);
        searched[o] &= !accepted[o];
    }
    const ReachablePairs pairs = configuration_.pairs.reachable_pairs(searched);
    const LineSearchResult found = line_search(objective_, pairs, iteration.path, accepted, x);
    report.cuts += found.cuts;
    return found;
}

void Newton::accept(const LineSearchResult &found, SceneReport &report, Iteration &iteration, AlignedVector &x) {
    const BlockSet &blocks = objective_.blocks;
    PlannedMove &move = iteration.move;
    if (found.cuts > 0) { // objects no longer move in the proportion that was limited
        std::vector<unsigned char> changed(table_.count(), 0);
        for (int v = 0; v < table_.dynamic_vertices; ++v)
            if (found.step[table_.mesh.object[v]] < 1.0) changed[v] = 1, move.to[v] = blocks.position(x, v);
        move.apex.clear();
        configuration_.limit_again(move, true, changed, report);
    }
    configuration_.commit(move.to);
    blocks.scatter(configuration_.positions, x);
}

} // namespace ringlet
