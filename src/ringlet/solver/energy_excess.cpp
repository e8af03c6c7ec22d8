#include "ringlet/solver/energy_excess.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace ringlet {
namespace {

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

} // namespace

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

} // namespace ringlet
