#include "ringlet/solver/scene_search.h"

#include "ringlet/solver/lane_vectors.h"

#include <algorithm>
#include <cmath>

namespace ringlet {
namespace {

constexpr double rounding = 1e-13; // of an energy

// Of each part the slope of its energy along its direction [J].
std::vector<double> slopes(const SceneSystem &system, const AlignedVector &direction) {
    std::vector<double> slope(system.vertices.parts(), 0.0);
    system.for_units([&](int u) {
        double slopes[most_lanes] = {};
        const size_t first = system.unit_begin(u);
        if (u < system.group_count()) {
            const StrandGroupSystem &group = system.strands.system(u);
            RINGLET_DISPATCH(lane_products, group.gradient, direction.data() + first, group.freedoms() * group.vertices,
                             slopes);
        } else {
            for (size_t i = first; i < system.unit_end(u); ++i) slopes[0] += system.gradient(i, u) * direction[i];
        }
        system.from_lanes(u, slopes, slope);
    });
    return slope;
}

// Clusters whose direction, as the filter left it of one that was to go as a whole, leads nowhere down: no part of it is any
// good.
std::vector<unsigned char> lead_uphill(const SceneSystem &system, const std::vector<double> &slope,
                                       const std::vector<double> &energy, const std::vector<unsigned char> &left_out) {
    const int parts = system.vertices.parts();
    std::vector<double> slopes(parts, 0.0), sizes(parts, 0.0);
    for (int p = 0; p < parts; ++p)
        if (!left_out[p]) slopes[system.clusters()[p]] += slope[p], sizes[system.clusters()[p]] += std::abs(energy[p]);
    std::vector<unsigned char> uphill(parts);
    for (int p = 0; p < parts; ++p) uphill[p] = slopes[p] > rounding * sizes[p];
    return uphill;
}

} // namespace

std::vector<unsigned char> with_touched(const SceneSystem &system, const std::vector<unsigned char> &parts) {
    std::vector<unsigned char> all = parts;
    for (const Contact &c : system.contacts.contacts()) {
        const int a = system.vertices.part_of(c.vertex[0]), b = system.vertices.part_of(c.vertex[3]);
        if (a < 0 || b < 0) continue;
        if (parts[a]) all[b] = 1;
        if (parts[b]) all[a] = 1;
    }
    return all;
}

SceneSearch search(SceneSystem &system, const PairCache *near, const SceneWay &way, const std::vector<unsigned char> &all_of_it,
                   AlignedVector &x) {
    constexpr double least_decrease = 1e-4;
    constexpr int halvings = 4, most_shorter = 8; // then it goes a quarter as far, and after these it stays
    constexpr int most_apart = 12;                // then all of its cluster stays
    const int parts = system.vertices.parts();
    SceneSearch result{false, 0, std::vector<double>(parts, 1.0)};
    std::vector<double> &step = result.step;
    const ReachablePairs in_reach = near != nullptr ? near->reachable_pairs(system.active_parts()) : ReachablePairs();
    const ReachablePairs *pairs = near != nullptr ? &in_reach : nullptr;
    const View<unsigned char> undecided = near != nullptr ? View<unsigned char>() : View<unsigned char>(all_of_it);
    std::vector<double> now, before;
    std::vector<unsigned char> changed(parts, 0), rises(parts), any_rises(parts);
    const std::vector<double> nowhere(parts, 0.0);
    system.energies(x, pairs, undecided, nowhere, changed, before); // parts were asked at x already
    const std::vector<double> slope = slopes(system, way.straight);
    const std::vector<unsigned char> uphill = lead_uphill(system, slope, before, all_of_it);
    const auto allowed = [&](int part) { // of the energy, were it alone
        return before[part] + least_decrease * step[part] * slope[part] + rounding * std::abs(before[part]);
    };
    const std::vector<int> &cluster = system.clusters();
    for (int p = 0; p < parts; ++p)
        if (!all_of_it[p] && uphill[cluster[p]]) step[p] = 0.0, ++result.cuts;
    std::vector<double> excess(parts), gone(parts); // of clusters; the part of the longest way that parts may have gone
    AlignedVector trial(system.size());
    std::copy_n(x.data(), x.size(), trial.data()); // what is not active too
    changed.assign(parts, 1);
    for (int cut = 0;; ++cut) {
        move(system, x, step, way, changed, trial);
        std::transform(step.begin(), step.end(), gone.begin(), [](double s) { return s * (2.0 - s); }); // at most: ways bend
        system.energies(trial, pairs, undecided, gone, changed, now);
        std::fill(excess.begin(), excess.end(), 0.0);
        std::fill(any_rises.begin(), any_rises.end(), 0);
        for (int p = 0; p < parts; ++p)
            if (!all_of_it[p]) excess[cluster[p]] += now[p] - allowed(p);
        for (int p = 0; p < parts; ++p) {
            const bool may_rise = all_of_it[p] || step[p] == 0.0 || excess[cluster[p]] <= 0.0;
            rises[p] = !may_rise && !(now[p] <= allowed(p));
            any_rises[cluster[p]] |= rises[p];
        }
        rises = with_touched(system, rises);
        for (int p = 0; p < parts; ++p)
            if ((!any_rises[cluster[p]] || cut >= most_apart) && !(excess[cluster[p]] <= 0.0)) rises[p] = 1;

        std::fill(changed.begin(), changed.end(), 0);
        bool any = false;
        for (int p = 0; p < parts; ++p)
            if (rises[p] && !all_of_it[p] && step[p] > 0.0) {
                step[p] *= cut < halvings ? 0.5 : cut < most_shorter ? 0.25 : 0.0;
                changed[p] = any = true;
                ++result.cuts;
            }
        if (!any) {
            std::swap(x, trial);
            for (int p = 0; p < parts; ++p) result.moved |= system.is_active(p) && step[p] > 0.0;
            return result;
        }
    }
}

} // namespace ringlet
