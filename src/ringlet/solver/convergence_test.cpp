#include "ringlet/solver/convergence_test.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace ringlet {

ConvergenceTest::ConvergenceTest(double tolerance, const Couplings &couplings, const CoarseSpace &coarse,
                                 const std::vector<int> &inexact, const std::vector<double> &residual2,
                                 const std::vector<double> &rz)
    : tolerance_(tolerance), couplings_(couplings), inexact_(inexact), by_error_(residual2.size(), 0),
      goes_on_(residual2.size(), 1), small_(residual2) {
    const double small = std::pow(solver_settings::residual_share * tolerance, 2);
    for (double &residual : small_) residual *= small;
    for (size_t cluster = 0; cluster < by_error_.size(); ++cluster) by_error_[cluster] = coarse.covers(int(cluster));
    for (const int object : inexact) {
        by_error_[couplings.clusters()[object]] = 1;
        small_inexact_.push_back(small * rz[object]);
    }
    decreases_.fill(std::vector<double>(residual2.size(), std::numeric_limits<double>::infinity()));
}

void ConvergenceTest::add_decreases(const std::vector<double> &of_clusters) {
    std::rotate(decreases_.begin(), decreases_.end() - 1, decreases_.end());
    decreases_.front() = of_clusters;
}

double ConvergenceTest::error2(int cluster) const {
    double sum = 0.0;
    for (const std::vector<double> &decrease : decreases_) sum += decrease[cluster];
    return sum;
}

std::vector<unsigned char> ConvergenceTest::unconverged(const IterationProgress &now) {
    const std::vector<int> &cluster = couplings_.clusters();
    // Loosely solved, few objects are not worth more iterations, for which all others would wait.
    const bool enough =
        tolerance_ >= solver_settings::loose_tolerance && now.iterations >= solver_settings::max_loose_iterations;
    std::vector<unsigned char> goes_on(cluster.size());
    for (size_t c = 0; c < cluster.size(); ++c)
        goes_on[c] = by_error_[c] ? now.residual2[c] > 0.0 && !(error2(int(c)) <= tolerance_ * tolerance_ * now.decrease[c])
                                  : now.residual2[c] > small_[c] && !enough;
    for (size_t k = 0; k < inexact_.size(); ++k) {
        const int object = inexact_[k];
        const bool is_small = now.iterations > 0 && now.rz[object] <= small_inexact_[k];
        goes_on[cluster[object]] |= now.residual2[cluster[object]] > 0.0 && !is_small;
    }
    for (size_t c = 0; c < cluster.size(); ++c) goes_on_[c] &= goes_on[c];
    std::vector<unsigned char> objects(cluster.size());
    for (size_t object = 0; object < objects.size(); ++object) objects[object] = goes_on_[cluster[object]];
    return objects;
}

} // namespace ringlet
