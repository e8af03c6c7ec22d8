#include "ringlet/scene/scene_parts.h"

#include <algorithm>
#include <functional>

namespace ringlet {

// Newton's method from x, which is `now`; says how many iterations it took.
int Scene::Parts::newton(const SceneStep &scene_step, const StrandStep &step, std::vector<Vec3> &now, SceneProgress &progress,
                         SceneReport &report) {
    constexpr double farther = 4.0; // than the search went last is not tried, but where a way is short
    std::vector<double> gone(vertices.parts(), 1.0), tried(vertices.parts(), 1.0);
    reach.assign(vertices.parts(), 0.0);
    int iteration = 0;
    for (bool arrived = false; !arrived; ++iteration) {
        if (iteration >= step.newton && (iteration >= step.newton + scene_step.extra || !progress.narrow(system, now))) break;
        {
            const Stopwatch watch(report.time_pairs);
            system.touch(near.contact_pairs(now), now);
        }
        {
            const Stopwatch watch(report.time_assemble);
            solver.prepare(system, x, scene_step.system);
        }
        {
            const Stopwatch watch(report.time_solve);
            const SceneSolver::Result solved = solver.solve(system, scene_step.linear_tolerance, way.straight);
            report.linear_iterations += solved.iterations;
            report.linear_residual = solved.residual;
            measure(system, way.straight, reach);
            system.expect(way.straight);
            if (stiffness.bear(system.contacts)) set_stiffness();
        }
        way.bend.fill(0.0);
        const bool small = std::all_of(reach.begin(), reach.end(), [&](double far) { return far <= step.tolerance; });
        const std::vector<unsigned char> all_parts(vertices.parts(), 1);
        const std::vector<unsigned char> &after = small ? all_parts : system.by_planes(); // are not searched then
        // A cloth that is held back here and there is strained there, so that its energy rises for once: for it and what
        // touches it the search comes before the filter, and knows of the contacts alone. So it does for what touches that in
        // turn: were it to go all of its way meanwhile, no step of the cloth would lead down, and it would stand still.
        // What only touches strands does so as the direction has it: how near they may come is for the filter, and
        // by planes, which they overstep, nearly all hair that touches hair and, somewhere, a cloth would stay.
        // A strand may be asked to go metres against friction, which is as strong to the other side after a hair's breadth: of
        // such a way no part that a search tries would lead down. And with cloth strands go straight: of how their edges turn,
        // contacts know nothing as the direction has them, and would stop nearly all hair that hangs together with it.
        if (!system.cloths.empty()) {
            const Stopwatch watch(report.time_search);
            shorten(system, worth_going(system, x, way.straight), way);
            std::vector<unsigned char> before = all_parts; // are not searched now
            if (!small) {
                const std::vector<unsigned char> beside = with_touched(system, system.by_planes());
                std::transform(beside.begin(), beside.end(), before.begin(), std::logical_not<>());
            }
            AlignedVector found(system.size());
            std::copy_n(x.data(), x.size(), found.data());
            const SceneSearch went = search(system, nullptr, way, before, found);
            if (!went.moved) break;
            shorten(system, went.step, way);
            std::vector<double> unused;
            const ReachablePairs in_reach = near.reachable_pairs(system.active_parts());
            system.energies(x, &in_reach, {}, std::vector<double>(vertices.parts(), 0.0), all_parts, unused);
        } else {
            tried = worth_going(system, x, way.straight);
            for (size_t p = 0; p < tried.size() && iteration < step.newton; ++p)
                tried[p] = std::min(tried[p], std::max(farther * gone[p], settings.strand_radius / reach[p]));
            shorten(system, tried, way);
            bend(system, x, way);
        }
        std::vector<Vec3> to;
        // The first time what can hardly move is held back where it meets something, so that the rest of it comes along; then
        // shape counts.
        hold_back(now, iteration > 0, iteration + 1 >= step.newton, to, progress, report);
        progress.cut(tried);
        arrived = small && progress.all_went();
        SceneSearch found;
        {
            const Stopwatch watch(report.time_search);
            found = search(system, &near, way, after, x);
            report.cuts += found.cuts;
        }
        if (!found.moved) break;
        progress.cut(found.step);
        for (size_t p = 0; p < tried.size(); ++p)
            if (system.is_active(int(p))) gone[p] = tried[p] * found.step[p];
        progress.judge(step.tolerance);
        if (found.cuts > 0) { // not all go equally far then
            std::vector<unsigned char> changed(vertices.count(), 0);
            for (int v = 0; v < vertices.moving_vertices(); ++v)
                if (found.step[vertices.part_of(v)] < 1.0) changed[v] = 1, to[v] = system.position(x, v);
            limit(now, to, {.whole_strands = true, .changed = changed}, report);
        }
        arrive(now, to);
        system.scatter(now, x);
    }
    return iteration;
}

} // namespace ringlet
