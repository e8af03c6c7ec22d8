#include "ringlet/scene/scene_search.h"

#include <algorithm>
#include <cmath>

namespace ringlet {
namespace {

// work(part, the unit's unknowns that are its own: first, stride, count).
template <class Work> void for_parts(const SceneSystem &system, int unit, const Work &work) {
    if (unit >= system.group_count())
        return work(unit - system.group_count() + system.vertices.strands, system.unit_begin(unit), size_t(1),
                    system.unit_end(unit) - system.unit_begin(unit));
    const StrandGroup group = system.strands.strands_of(unit);
    const StrandGroupSystem &of = system.strands.system(unit);
    for (int lane = 0; lane < group.count; ++lane)
        work(group.strands[lane], system.unit_begin(unit) + lane, size_t(of.lanes), size_t(of.freedoms) * of.vertices);
}

} // namespace

SceneSearch search(SceneSystem &system, AlignedVector &direction, double tolerance, AlignedVector &x) {
    constexpr double least_decrease = 1e-4, rounding = 1e-13;
    constexpr int most_cuts = 20, most_halvings = 12; // after which a part stays
    SceneSearch result;
    const int parts = system.vertices.parts();
    std::vector<double> step(parts, 1.0), slope(parts, 0.0), largest(parts, 0.0), now, before;
    std::vector<unsigned char> changed(system.unit_count(), 0);
    system.energies(x, changed, before); // units were asked at x already
    system.for_units([&](int u) {
        for_parts(system, u, [&](int part, size_t first, size_t stride, size_t count) {
            for (size_t i = first; i < first + count * stride; i += stride) {
                slope[part] += system.gradient(i, u) * direction[i];
                largest[part] = std::max(largest[part], std::abs(direction[i]));
            }
            if (std::isfinite(slope[part])) return;
            slope[part] = largest[part] = 0.0;
            for (size_t i = first; i < first + count * stride; i += stride) direction[i] = 0.0;
        });
    });
    for (const double of : largest) result.largest = std::max(result.largest, of);

    const auto allowed = [&](int part) { // of the energy, were it alone
        return before[part] + least_decrease * step[part] * slope[part] + rounding * std::abs(before[part]);
    };
    AlignedVector trial(system.size());
    std::copy_n(x.data(), x.size(), trial.data()); // lanes without a strand too
    changed.assign(system.unit_count(), 1);
    for (int cut = 0; cut <= most_cuts; ++cut) {
        system.for_units([&](int u) {
            if (changed[u])
                for_parts(system, u, [&](int part, size_t first, size_t stride, size_t count) {
                    for (size_t i = first; i < first + count * stride; i += stride) trial[i] = x[i] + step[part] * direction[i];
                });
        });
        system.energies(trial, changed, now);
        double sum = 0.0, bound = 0.0;
        for (int p = 0; p < parts; ++p)
            if (system.together(p)) sum += now[p], bound += allowed(p);
        const bool sum_falls = sum <= bound, near = cut == 0 && result.largest <= tolerance;
        std::fill(changed.begin(), changed.end(), 0);
        bool any = false, any_together = false;
        const auto halve = [&](int part) {
            step[part] *= cut < most_halvings ? 0.5 : 0.0;
            changed[system.unit_of(part)] = any = true;
            ++result.cuts;
        };
        for (int p = 0; p < parts && !near; ++p)
            if (step[p] > 0.0 && !(system.together(p) && sum_falls) && !(now[p] <= allowed(p))) {
                any_together |= system.together(p);
                halve(p);
            }
        if (!sum_falls && !near && !any_together)
            for (int p = 0; p < parts; ++p)
                if (system.together(p) && step[p] > 0.0) halve(p);
        if (!any) {
            std::swap(x, trial);
            result.moved = true;
            return result;
        }
    }
    changed.assign(system.unit_count(), 1);
    system.energies(x, changed, now);
    return result;
}

} // namespace ringlet
