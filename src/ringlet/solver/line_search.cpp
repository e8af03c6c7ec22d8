#include "ringlet/solver/line_search.h"

#include "ringlet/solver/energy_excess.h"
#include "ringlet/solver/settings.h"

#include <algorithm>
#include <cmath>

namespace ringlet {
namespace {

// Objects of clusters whose path leads uphill, as it may where the limiter has left unequal parts of a joint direction.
std::vector<unsigned char> lead_uphill(const std::vector<int> &cluster, const std::vector<double> &slope,
                                       const std::vector<double> &energy, const std::vector<unsigned char> &searched) {
    const size_t objects = cluster.size();
    std::vector<double> slopes(objects, 0.0), sizes(objects, 0.0);
    for (size_t o = 0; o < objects; ++o)
        if (searched[o]) slopes[cluster[o]] += slope[o], sizes[cluster[o]] += std::abs(energy[o]);
    std::vector<unsigned char> uphill(objects);
    for (size_t o = 0; o < objects; ++o)
        uphill[o] = searched[o] && slopes[cluster[o]] > solver_settings::armijo.rounding * sizes[cluster[o]];
    return uphill;
}

double shortened(double step, int cut) {
    return cut < solver_settings::halvings ? 0.5 * step : cut < solver_settings::max_cuts ? 0.25 * step : 0.0;
}

} // namespace

LineSearchResult line_search(Objective &objective, const ReachablePairs &pairs, const SearchPath &path,
                             const std::vector<unsigned char> &accepted, AlignedVector &x) {
    const BlockSet &blocks = objective.blocks;
    const int objects = objective.table.objects;
    std::vector<unsigned char> searched(objects);
    for (int o = 0; o < objects; ++o) searched[o] = !accepted[o];

    std::vector<double> start, energy, bound(objects), traveled(objects);
    objective.energies_at_linearisation(start);
    const std::vector<double> slope = slopes(blocks, path.straight);
    LineSearchResult result{0, std::vector<double>(objects, 1.0)};
    std::vector<double> &step = result.step;
    const std::vector<unsigned char> uphill = lead_uphill(objective.couplings.clusters(), slope, start, searched);
    for (int o = 0; o < objects; ++o)
        if (uphill[o]) step[o] = 0.0, ++result.cuts;

    AlignedVector trial = x.copy();
    move_along(blocks, x, step, path, std::vector<unsigned char>(objects, 1), trial);
    std::vector<unsigned char> evaluated = searched;
    for (int cut = 0;; ++cut) {
        for (int o = 0; o < objects; ++o) traveled[o] = step[o] * (2.0 - step[o]); // at most, on a path that bends
        objective.exact_energies(trial, pairs, traveled, evaluated, energy);
        for (int o = 0; o < objects; ++o)
            bound[o] = RINGLET_SIMD::armijo_bound(start[o], slope[o], step[o], solver_settings::armijo);
        const std::vector<unsigned char> shorter =
            too_far(objective, searched, step, energy, bound, cut >= solver_settings::max_object_cuts);
        const int count = int(std::count(shorter.begin(), shorter.end(), 1));
        if (count == 0) break;
        result.cuts += count;
        for (int o = 0; o < objects; ++o)
            if (shorter[o]) step[o] = shortened(step[o], cut);
        move_along(blocks, x, step, path, shorter, trial);
        evaluated = shorter;
    }
    std::swap(x, trial);
    return result;
}

} // namespace ringlet
