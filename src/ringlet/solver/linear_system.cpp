#include "ringlet/solver/linear_system.h"

#include "ringlet/linear/conjugate_gradient.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace ringlet {
namespace {

double total(const std::vector<double> &values) { return std::accumulate(values.begin(), values.end(), 0.0); }

} // namespace

LinearSystem::LinearSystem(Objective &objective) : objective_(objective), coupled_(objective) {
    for (int b = 0; b < objective.blocks.count(); ++b)
        if (!objective.blocks[b].is_exact())
            for (const BlockObject &object : objective.blocks[b].objects()) inexact_.push_back(object.number);
}

void LinearSystem::assemble(const AlignedVector &x, const LinearSettings &settings) {
    objective_.linearise_contacts(x);
    whole_.reset();
    if (settings.system == System::direct) {
        objective_.blocks.for_active([&](int b) { objective_.assemble(b, x); });
        whole_.emplace(objective_);
        return;
    }
    coupled_.begin();
    objective_.blocks.for_active([&](int b) { // all of a block while it is in the cache
        objective_.assemble(b, x);
        coupled_.begin_block(b);
    });
    coupled_.factor_coarse();
}

LinearSystem::Result LinearSystem::solve(const LinearSettings &settings, AlignedVector &direction) {
    direction.fill(0.0); // of blocks that are not active
    return whole_ ? factor(*whole_, direction) : conjugate_gradient(settings, direction);
}

LinearSystem::Result LinearSystem::factor(const AssembledMatrix &whole, AlignedVector &direction) {
    if (whole.size() == 0) return {};
    DirectSolver solver;
    solver.analyse(whole.pattern());
    if (!solver.factor(whole.triplets())) throw FactorisationError("scene: the matrix of a step is not positive definite");
    std::vector<double> solution(whole.size());
    const double residual = solver.solve(whole.right_hand_side(), solution);
    whole.set(solution, direction);
    return {0, residual};
}

LinearSystem::Result LinearSystem::conjugate_gradient(const LinearSettings &settings, AlignedVector &direction) {
    const std::vector<double> all = coupled_.of_clusters(coupled_.alone());
    ConvergenceTest test(settings.tolerance, objective_.couplings, coupled_.coarse(), inexact_, all, coupled_.alone());
    CoupledSystem::Residual r;
    CoupledSystem::Unknowns x;
    coupled_.first_iterate(r, x);
    std::vector<unsigned char> busy(all.size(), 1);
    const auto unconverged = [&](int iterations, const std::vector<double> &rz, const std::vector<double> &decreases) {
        if (iterations > 0) test.add_decreases(decreases);
        busy = iterations == settings.max_iterations
                   ? std::vector<unsigned char>(all.size(), 0)
                   : test.unconverged({iterations, rz, coupled_.work(x, busy), coupled_.products()});
        return busy;
    };
    const ConjugateGradientResult solved = ringlet::conjugate_gradient(coupled_, r, x, unconverged);
    coupled_.solution(x, direction);
    const double before = total(all), left = std::max(total(solved.residual2), 0.0);
    return {solved.iterations, before > 0.0 ? std::sqrt(left / before) : 0.0};
}

} // namespace ringlet
