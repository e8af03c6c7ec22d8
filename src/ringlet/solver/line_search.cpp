#include "ringlet/solver/line_search.h"

#include "ringlet/math/parallel_copy.h"
#include "ringlet/solver/settings.h"

#include <algorithm>
#include <cmath>
#include <limits>

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

// Of the objects whose energy is above its bound by `excess`, those that make up for the excess of their cluster, the largest
// first. Where energies are convex along the path, half a step leaves at most half of an excess: so twice that of the cluster.
std::vector<unsigned char> cause_excess(const std::vector<int> &cluster, const std::vector<double> &excess,
                                        const std::vector<double> &excess_of_cluster) {
    std::vector<int> above;
    for (size_t o = 0; o < excess.size(); ++o)
        if (!(excess[o] <= 0.0) && !(excess_of_cluster[cluster[o]] <= 0.0)) above.push_back(int(o));
    const auto rank = [&](int o) { return std::isfinite(excess[o]) ? excess[o] : std::numeric_limits<double>::infinity(); };
    std::stable_sort(above.begin(), above.end(), [&](int a, int b) { return rank(a) > rank(b); });
    std::vector<double> left(excess.size());
    for (size_t c = 0; c < left.size(); ++c) left[c] = 2.0 * excess_of_cluster[c];
    std::vector<unsigned char> causes(excess.size(), 0);
    for (const int o : above) {
        causes[o] = !(left[cluster[o]] <= 0.0);
        if (causes[o]) left[cluster[o]] -= excess[o];
    }
    return causes;
}

// In clusters whose energies are above their bounds in sum, those that cause it with those that they touch. Where none does, or
// `whole_clusters`, all of the cluster must take a shorter step. Only objects that are searched count, and only those that move
// can go less far.
std::vector<unsigned char> too_far(const Objective &objective, const std::vector<unsigned char> &searched,
                                   const std::vector<double> &step, const std::vector<double> &energy,
                                   const std::vector<double> &bound, bool whole_clusters) {
    const size_t objects = step.size();
    const std::vector<int> &cluster = objective.couplings.clusters();
    std::vector<double> excess(objects, 0.0), excess_of_cluster(objects, 0.0);
    for (size_t o = 0; o < objects; ++o)
        if (searched[o]) excess_of_cluster[cluster[o]] += excess[o] = energy[o] - bound[o];
    for (size_t o = 0; o < objects; ++o)
        if (step[o] == 0.0) excess[o] = 0.0;
    std::vector<unsigned char> shorter = cause_excess(cluster, excess, excess_of_cluster), any(objects, 0);
    for (size_t o = 0; o < objects; ++o) any[cluster[o]] |= shorter[o];
    shorter = objective.with_touched(shorter);
    for (size_t o = 0; o < objects; ++o)
        if ((!any[cluster[o]] || whole_clusters) && !(excess_of_cluster[cluster[o]] <= 0.0)) shorter[o] = 1;
    for (size_t o = 0; o < objects; ++o) shorter[o] &= searched[o] && step[o] > 0.0;
    return shorter;
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

    AlignedVector trial = parallel_copy(x);
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
