#include "ringlet/solver/linear_system.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace ringlet {
namespace {

double total(const std::vector<double> &values) { return std::accumulate(values.begin(), values.end(), 0.0); }

} // namespace

LinearSystem::LinearSystem(Objective &objective) : objective_(objective), coarse_(objective) {
    for (int b = 0; b < objective.blocks.count(); ++b) {
        iterations_.push_back(BlockIteration::make(objective, b, state_, coarse_));
        if (objective.blocks[b].is_exact()) continue;
        for (const BlockObject &object : objective.blocks[b].objects()) inexact_.push_back(object.number);
    }
}

System LinearSystem::method(System wanted) const {
    if (wanted == System::banded && objective_.is_coupled())
        throw CoupledError("scene: the system 'banded' solves strands alone, but something couples them");
    // The matrix of blocks that are not active is not assembled.
    return wanted == System::direct && objective_.blocks.all_active() ? wanted : System::conjugate_gradient;
}

void LinearSystem::assemble(const AlignedVector &x, const LinearSettings &settings) {
    const System how = method(settings.system);
    state_.resize(objective_.table.objects, objective_.couplings.count());
    iterated_.resize(objective_.table.objects);
    for (int object = 0; object < objective_.table.objects; ++object) iterated_[object] = !objective_.is_alone(object);
    objective_.linearise_contacts(x);
    whole_.reset();
    if (how == System::direct) { // before the blocks are factored in place
        objective_.blocks.for_active([&](int b) { objective_.assemble(b, x); });
        whole_.emplace(objective_);
        coarse_.clear();
        objective_.blocks.for_active([&](int b) { iterations_[b]->start(); });
    } else {
        coarse_.find_forces();
        objective_.blocks.for_active([&](int b) { // all of a block while it is in the cache
            objective_.assemble(b, x);
            iterations_[b]->start();
            coarse_.find_responses(b);
        });
        coarse_.factor();
    }
}

LinearSystem::Result LinearSystem::solve(const LinearSettings &settings, AlignedVector &direction) {
    Result result;
    direction.fill(0.0); // of blocks that are not active
    if (whole_ && whole_->size() > 0 && solve_whole(*whole_, direction, result)) return result;
    return conjugate_gradient(settings, direction);
}

bool LinearSystem::solve_whole(const AssembledMatrix &whole, AlignedVector &direction, Result &result) {
    DirectSolver solver;
    solver.analyse(whole.pattern());
    if (!solver.factor(whole.triplets())) return false;
    std::vector<double> solution(whole.size());
    result.residual = solver.solve(whole.right_hand_side(), solution);
    whole.set(solution, direction);
    return true;
}

// Sums of the objects that conjugate gradients have something to do for, at the first object of each cluster.
std::vector<double> LinearSystem::of_clusters(const std::vector<double> &of_objects) const {
    std::vector<double> sums(of_objects.size(), 0.0);
    for (size_t object = 0; object < sums.size(); ++object)
        if (iterated_[object]) sums[objective_.couplings.clusters()[object]] += of_objects[object];
    return sums;
}

// Clusters are independent systems, each with step lengths of its own.
LinearSystem::Result LinearSystem::conjugate_gradient(const LinearSettings &settings, AlignedVector &direction) {
    const BlockSet &blocks = objective_.blocks;
    const int objects = objective_.table.objects;
    const std::vector<int> &cluster = objective_.couplings.clusters();
    const std::vector<double> alone = state_.rz, all = of_clusters(alone); // b · P⁻¹ b
    ConvergenceTest test(settings.tolerance, objective_.couplings, coarse_, inexact_, all, alone);

    first_iterate(direction);
    std::vector<double> rho = of_clusters(state_.rz);
    std::vector<unsigned char> busy_blocks(blocks.count(), 1);
    Result result;
    const auto for_busy = [&](const auto &work, bool backwards = false) {
        blocks.for_active(
            [&](int b) {
                if (busy_blocks[b]) work(b);
            },
            backwards);
    };
    for (;; ++result.iterations) {
        state_.bd = alone;
        for_busy([&](int b) { iterations_[b]->measure(blocks.of(b, direction)); });
        const std::vector<double> decrease = of_clusters(state_.bd);
        const std::vector<unsigned char> busy = test.unconverged({result.iterations, rho, decrease, state_.rz});
        if (std::count(busy.begin(), busy.end(), 1) == 0 || result.iterations == settings.max_iterations) break;
        busy_blocks = blocks.blocks_with(busy);

        for_busy([&](int b) { iterations_[b]->search(); });
        std::vector<double> curvature = of_clusters(state_.pPp);
        objective_.couplings.multiply(state_.p, objective_.contact_values(), busy, curvature);
        std::vector<double> alpha(objects, 0.0), beta(objects, 0.0); // of clusters
        for (int c = 0; c < objects; ++c)
            if (busy[c] && cluster[c] == c) alpha[c] = curvature[c] > 0.0 ? rho[c] / curvature[c] : 0.0;
        for (int object = 0; object < objects; ++object) state_.alpha[object] = busy[object] ? alpha[cluster[object]] : 0.0;

        // Alternating directions reuse the factors that are still in the cache.
        for_busy(
            [&](int b) {
                iterations_[b]->advance(blocks.of(b, direction));
                iterations_[b]->precondition();
            },
            result.iterations % 2 != 0);
        deflate(busy);
        const std::vector<double> next = of_clusters(state_.rz);
        for (int c = 0; c < objects; ++c)
            if (busy[c] && cluster[c] == c) {
                test.add_decrease(c, alpha[c] * rho[c]);
                beta[c] = next[c] / rho[c];
                rho[c] = alpha[c] > 0.0 ? next[c] : 0.0;
            }
        for (int object = 0; object < objects; ++object) state_.beta[object] = busy[object] ? beta[cluster[object]] : 0.0;
    }
    blocks.for_active([&](int b) { iterations_[b]->finish(blocks.of(b, direction)); });
    const double before = total(all);
    result.residual = before > 0.0 ? std::sqrt(std::max(total(rho), 0.0) / before) : 0.0;
    return result;
}

// d = P⁻¹ b of exact blocks and 0 of others, corrected by the coarse space, with the residual that is left.
void LinearSystem::first_iterate(AlignedVector &direction) {
    const BlockSet &blocks = objective_.blocks;
    const int objects = objective_.table.objects;
    state_.resize(objects, objective_.couplings.count());
    const std::vector<unsigned char> all(objects, 1);
    const auto advance = [&] {
        std::vector<double> unused(objects, 0.0);
        objective_.couplings.multiply(state_.p, objective_.contact_values(), all, unused);
        blocks.for_active([&](int b) { iterations_[b]->advance(blocks.of(b, direction)); });
    };
    blocks.for_active([&](int b) { iterations_[b]->first_iterate(blocks.of(b, direction)); });
    state_.alpha.assign(objects, 1.0);
    advance();
    if (!coarse_.empty()) {
        coarse_.project(
            [&](int point) { return iterations_[blocks.block_of(objective_.couplings.object(point))]->residual(point); });
        blocks.for_active([&](int b) { iterations_[b]->correct(); });
        advance();
    }
    blocks.for_active([&](int b) { iterations_[b]->precondition(); }, true); // the last factors are still in the cache
    deflate(all);
}

// Takes out of z what the coarse space has of it, so that the iteration does not return there (A-DEF2: Tang et al. 2009).
void LinearSystem::deflate(const std::vector<unsigned char> &busy) {
    if (coarse_.empty()) return;
    std::vector<double> unused(busy.size(), 0.0);
    objective_.couplings.multiply(state_.z, objective_.contact_values(), busy, unused);
    coarse_.project([&](int point) { return Vec3(-objective_.couplings.product(point)); });
    objective_.blocks.for_active([&](int b) { iterations_[b]->deflate(); });
}

} // namespace ringlet
