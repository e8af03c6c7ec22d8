#include "ringlet/solver/linear_system.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>

namespace ringlet {
namespace {

double total(const std::vector<double> &values) { return std::accumulate(values.begin(), values.end(), 0.0); }

// Per cluster, the square of the energy norm of the error some iterations ago: what the energy has fallen by since (Strakoš and
// Tichý 2002). Infinite before that many iterations.
class ErrorEstimate {
public:
    explicit ErrorEstimate(int clusters) {
        falls_.fill(std::vector<double>(clusters, std::numeric_limits<double>::infinity()));
    }
    void add(int cluster, double fall) {
        for (size_t k = falls_.size() - 1; k > 0; --k) falls_[k][cluster] = falls_[k - 1][cluster];
        falls_[0][cluster] = fall;
    }
    double squared(int cluster) const {
        double sum = 0.0;
        for (const std::vector<double> &fall : falls_) sum += fall[cluster];
        return sum;
    }

private:
    std::array<std::vector<double>, solver_settings::error_delay> falls_;
};

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
    const std::vector<unsigned char> &active = objective_.blocks.active;
    const bool all = std::count(active.begin(), active.end(), 0) == 0;
    return wanted == System::direct && all ? wanted : System::conjugate_gradient;
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

// Clusters are independent systems, each with step lengths of its own, and each iterates until its own error is small, so that
// what happens in one has no effect on another. Where few objects leave no room for joint motion, the residual tells as much.
// An inexact block counts for little beside stiff strands: it iterates until its own residual is small too, and once at least,
// since what pushed it may have been solved in the first iterate.
LinearSystem::Result LinearSystem::conjugate_gradient(const LinearSettings &settings, AlignedVector &direction) {
    const BlockSet &blocks = objective_.blocks;
    const int objects = objective_.table.objects;
    const double tolerance2 = settings.tolerance * settings.tolerance;
    const std::vector<int> &cluster = objective_.couplings.clusters();
    const std::vector<double> alone = state_.rz;
    const double of_residual = std::pow(solver_settings::residual_share * settings.tolerance, 2);
    std::vector<double> small = of_clusters(state_.rz), small_of_inexact;
    for (double &of_cluster : small) of_cluster *= of_residual;
    std::vector<unsigned char> has_inexact(objects, 0); // clusters
    for (const int object : inexact_) {
        small_of_inexact.push_back(of_residual * state_.rz[object]);
        has_inexact[cluster[object]] = 1;
    }

    // Loosely solved, a small cluster is not worth more; it would keep all others waiting.
    const int small_cluster_iterations =
        settings.tolerance < solver_settings::loose ? settings.max_iterations : solver_settings::small_cluster_iterations;

    first_iterate(direction);
    std::vector<double> rho = of_clusters(state_.rz);
    ErrorEstimate error(objects);
    std::vector<unsigned char> busy(objects), busy_blocks(blocks.count(), 1);
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
        const std::vector<double> size = of_clusters(state_.bd);
        std::vector<unsigned char> goes_on(objects, 0); // clusters
        for (int c = 0; c < objects; ++c)
            goes_on[c] = coarse_.has_cluster(c) || has_inexact[c]
                             ? rho[c] > 0.0 && !(error.squared(c) <= tolerance2 * size[c])
                             : rho[c] > small[c] && result.iterations < small_cluster_iterations;
        for (size_t k = 0; k < inexact_.size(); ++k) {
            const int object = inexact_[k];
            const bool is_small = result.iterations > 0 && state_.rz[object] <= small_of_inexact[k];
            goes_on[cluster[object]] |= rho[cluster[object]] > 0.0 && !is_small;
        }
        busy_blocks.assign(blocks.count(), 0);
        for (int object = 0; object < objects; ++object) {
            busy[object] = goes_on[cluster[object]];
            if (busy[object]) busy_blocks[blocks.block_of(object)] = 1;
        }
        if (std::count(busy.begin(), busy.end(), 1) == 0 || result.iterations == settings.max_iterations) break;

        for_busy([&](int b) { iterations_[b]->search(); });
        std::vector<double> curvature = of_clusters(state_.pPp);
        objective_.couplings.multiply(state_.p, objective_.contact_values(), busy, curvature);
        std::vector<double> alpha(objects, 0.0), beta(objects, 0.0); // of clusters
        for (int c = 0; c < objects; ++c)
            if (busy[c] && cluster[c] == c) alpha[c] = curvature[c] > 0.0 ? rho[c] / curvature[c] : 0.0;
        for (int object = 0; object < objects; ++object) state_.alpha[object] = busy[object] ? alpha[cluster[object]] : 0.0;

        // Alternating directions reuse the factors that are still in the cache.
        for_busy([&](int b) { iterations_[b]->advance(blocks.of(b, direction)); }, result.iterations % 2 != 0);
        deflate(busy);
        const std::vector<double> next = of_clusters(state_.rz);
        for (int c = 0; c < objects; ++c)
            if (busy[c] && cluster[c] == c) {
                error.add(c, alpha[c] * rho[c]);
                beta[c] = next[c] / rho[c];
                rho[c] = alpha[c] > 0.0 ? next[c] : 0.0;
            }
        for (int object = 0; object < objects; ++object) state_.beta[object] = busy[object] ? beta[cluster[object]] : 0.0;
    }
    blocks.for_active([&](int b) { iterations_[b]->finish(blocks.of(b, direction)); });
    const double all = total(of_clusters(alone));
    result.residual = all > 0.0 ? std::sqrt(std::max(total(rho), 0.0) / all) : 0.0;
    return result;
}

// d = P⁻¹ b of exact blocks and 0 of others, corrected by the coarse space, with the residual that is left.
void LinearSystem::first_iterate(AlignedVector &direction) {
    const BlockSet &blocks = objective_.blocks;
    const int objects = objective_.table.objects;
    state_.resize(objects, objective_.couplings.count());
    const std::vector<unsigned char> all(objects, 1);
    const auto advance = [&](bool backwards) {
        std::vector<double> unused(objects, 0.0);
        objective_.couplings.multiply(state_.p, objective_.contact_values(), all, unused);
        blocks.for_active([&](int b) { iterations_[b]->advance(blocks.of(b, direction)); }, backwards);
    };
    blocks.for_active([&](int b) { iterations_[b]->first_iterate(blocks.of(b, direction)); });
    state_.alpha.assign(objects, 1.0);
    advance(true);
    if (coarse_.empty()) return;
    coarse_.project(
        [&](int point) { return iterations_[blocks.block_of(objective_.couplings.object(point))]->residual(point); });
    blocks.for_active([&](int b) { iterations_[b]->correct(); });
    advance(false);
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
