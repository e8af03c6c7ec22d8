// When conjugate gradients stop, cluster by cluster, so that what happens in one has no effect on another.
#pragma once

#include "ringlet/solver/coarse_space.h"
#include "ringlet/solver/settings.h"

#include <array>
#include <vector>

namespace ringlet {

// What the iteration has reached. Numbers of clusters stand at the first object of each.
struct IterationProgress {
    int iterations;
    const std::vector<double> &residual2; // per cluster: r · z
    const std::vector<double> &decrease;  // per cluster: b · d, twice what the solution so far takes off the energy [J]
    const std::vector<double> &rz;        // per object: r · z
};

// A cluster with joint motion, or with an inexact block, has converged when its error in the norm of energy is small. The
// estimate of that is the decrease of the energy in the last iterations (Strakoš and Tichý 2002). Of other clusters, which have
// few objects, the residual tells as much. An inexact block hardly counts in the energy of stiff strands, so
// its own residual has to be small too. It iterates once at least: the first iterate may have solved what pushes it.
class ConvergenceTest {
public:
    // `residual2` and `rz` are those of b, before the first iterate.
    ConvergenceTest(double tolerance, const Couplings &couplings, const CoarseSpace &coarse, const std::vector<int> &inexact,
                    const std::vector<double> &residual2, const std::vector<double> &rz);

    void add_decreases(const std::vector<double> &of_clusters); // in one iteration [J]

    // Per object, whether its cluster goes on. One that has converged stays so: while others go on, it is not measured.
    std::vector<unsigned char> unconverged(const IterationProgress &now);

private:
    double error2(int cluster) const;

    double tolerance_;
    const Couplings &couplings_;
    const std::vector<int> &inexact_;           // objects
    std::vector<unsigned char> by_error_;       // per cluster
    std::vector<unsigned char> goes_on_;        // per cluster
    std::vector<double> small_, small_inexact_; // residuals at which clusters and inexact objects have converged
    std::array<std::vector<double>, solver_settings::error_delay> decreases_; // of clusters, the last first [J]
};

} // namespace ringlet
