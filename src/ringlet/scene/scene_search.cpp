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

// Of those that touch one another, marks all that touch one that is marked.
void mark_touched(const SceneSystem &system, std::vector<unsigned char> &marked) {
    std::vector<unsigned char> touched = marked;
    for (const Contact &c : system.contacts.contacts()) {
        const int a = system.vertices.part_of(c.vertex[0]), b = system.vertices.part_of(c.vertex[3]);
        if (a < 0 || b < 0) continue;
        if (marked[a]) touched[b] = 1;
        if (marked[b]) touched[a] = 1;
    }
    marked = std::move(touched);
}

} // namespace

void measure(const SceneSystem &system, AlignedVector &direction, std::vector<double> &reach) {
    reach.resize(system.vertices.parts(), 0.0);
    system.for_units([&](int u) {
        for_parts(system, u, [&](int part, size_t first, size_t stride, size_t count) {
            reach[part] = 0.0;
            double sum = 0.0;
            for (size_t i = first; i < first + count * stride; i += stride) {
                reach[part] = std::max(reach[part], std::abs(direction[i]));
                sum += direction[i];
            }
            if (std::isfinite(sum)) return;
            reach[part] = 0.0;
            for (size_t i = first; i < first + count * stride; i += stride) direction[i] = 0.0;
        });
    });
}

void shorten(const SceneSystem &system, const std::vector<double> &parts, AlignedVector &direction) {
    system.for_units([&](int u) {
        for_parts(system, u, [&](int part, size_t first, size_t stride, size_t count) {
            if (parts[part] < 1.0)
                for (size_t i = first; i < first + count * stride; i += stride) direction[i] *= parts[part];
        });
    });
}

std::vector<double> worth_going(const SceneSystem &system, const AlignedVector &x, const AlignedVector &direction) {
    const StrandModel &model = system.model;
    std::vector<double> parts(system.vertices.parts(), 1.0);
#pragma omp parallel for schedule(static)
    for (int s = 0; s < system.vertices.strands; ++s)
        for (int v = model.offsets[s]; v + 1 < model.offsets[s + 1]; ++v) {
            const auto edge = [&](const AlignedVector &of) {
                return (system.position(of, v + 1) - system.position(of, v)).norm();
            };
            const double most = 2.0 * std::max(model.rest_length[v], edge(x)), way = edge(direction);
            if (parts[s] * way > most) parts[s] = most / way;
        }
    return parts;
}

SceneSearch search(SceneSystem &system, const NearPairs *near, const AlignedVector &direction,
                   const std::vector<unsigned char> &all_of_it, AlignedVector &x) {
    constexpr double least_decrease = 1e-4, rounding = 1e-13;
    constexpr int most_cuts = 20, most_halvings = 12; // after which a part stays
    const int parts = system.vertices.parts();
    SceneSearch result{false, 0, std::vector<double>(parts, 1.0)};
    std::vector<double> &step = result.step;
    std::vector<double> slope(parts, 0.0), now, before;
    std::vector<unsigned char> changed(system.unit_count(), 0), rises(parts);
    system.energies(x, near, changed, before); // units were asked at x already
    system.for_units([&](int u) {
        for_parts(system, u, [&](int part, size_t first, size_t stride, size_t count) {
            for (size_t i = first; i < first + count * stride; i += stride) slope[part] += system.gradient(i, u) * direction[i];
        });
    });

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
        system.energies(trial, near, changed, now);
        double sum = 0.0, bound = 0.0;
        for (int p = 0; p < parts; ++p)
            if (system.together(p) && !all_of_it[p]) sum += now[p], bound += allowed(p);
        const bool sum_falls = sum <= bound;
        bool any_together = false;
        for (int p = 0; p < parts; ++p) {
            const bool may_rise = all_of_it[p] || step[p] == 0.0 || (system.together(p) && sum_falls);
            rises[p] = !may_rise && !(now[p] <= allowed(p));
            any_together |= rises[p] && system.together(p);
        }
        if (any_together) mark_touched(system, rises);
        if (!any_together && !sum_falls)
            for (int p = 0; p < parts; ++p) rises[p] |= system.together(p);

        std::fill(changed.begin(), changed.end(), 0);
        bool any = false;
        for (int p = 0; p < parts; ++p)
            if (rises[p] && !all_of_it[p] && step[p] > 0.0) {
                step[p] *= cut < most_halvings ? 0.5 : 0.0;
                changed[system.unit_of(p)] = any = true;
                ++result.cuts;
            }
        if (!any) {
            std::swap(x, trial);
            result.moved = true;
            return result;
        }
    }
    changed.assign(system.unit_count(), 1);
    system.energies(x, near, changed, now);
    return result;
}

} // namespace ringlet
