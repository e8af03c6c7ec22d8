#include "ringlet/solver/linear_system.h"

#include "ringlet/linear/conjugate_gradient.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace ringlet {
namespace {

// When conjugate gradients stop, cluster by cluster, so that what happens in one has no effect on another.

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

double total(const std::vector<double> &values) { return std::accumulate(values.begin(), values.end(), 0.0); }

} // namespace

AssembledMatrix::AssembledMatrix(const Objective &objective) : objective_(objective) {
    const BlockSet &blocks = objective.blocks;
    for (int b = 0; b < blocks.count(); ++b) block_ = std::max(block_, blocks[b].dofs());
    const std::vector<unsigned char> active = blocks.blocks_with(blocks.active_objects());
    for (int b = 0; b < blocks.count(); ++b) {
        if (active[b]) {
            blocks[b].add_to(*this);
            continue;
        }
        for (const BlockObject &object : blocks[b].objects())
            for (int v = object.first; v < object.end; ++v) {
                double *const unit = add_block(v, v);
                for (int k = 0; k < block_; ++k) unit[k * block_ + k] = 1.0;
            }
    }
    for (const Couplings::Coupling &coupling : objective.couplings.all())
        add_couplings(objective.contacts.stencil_of(coupling.pair), objective.pair_values()[coupling.pair].hessian);
}

double *AssembledMatrix::add_block(int row, int column) {
    i_.push_back(row);
    j_.push_back(column);
    values_.resize(values_.size() + size_t(block_) * block_, 0.0);
    return values_.data() + values_.size() - size_t(block_) * block_;
}

// What a pair force does from side to side; the rest is in the blocks.
void AssembledMatrix::add_couplings(const Stencil &pair, const Mat3 &hessian) {
    const auto &moves = objective_.table.mesh.moves;
    for (int i = 0; i < pair.first; ++i)
        for (int j = pair.first; j < 4; ++j) {
            if (!moves[pair.vertex[i]] || !moves[pair.vertex[j]] || pair.weight[i] * pair.weight[j] == 0.0) continue;
            double *block = add_block(pair.vertex[i], pair.vertex[j]);
            for (int r = 0; r < 3; ++r)
                for (int k = 0; k < 3; ++k) block[r * block_ + k] = pair.weight[i] * pair.weight[j] * hessian(r, k);
        }
}

std::shared_ptr<const SparsePattern> AssembledMatrix::pattern() const {
    return std::make_shared<const SparsePattern>(vertices(), block_, i_, j_);
}

// work(row of the matrix, entry of the blocks' vectors, block).
template <class Work> void AssembledMatrix::for_unknowns(const Work &work) const {
    const BlockSet &blocks = objective_.blocks;
    for (int v = 0; v < vertices(); ++v) {
        const auto [first, stride] = blocks.slot(v);
        const int block = blocks.block_of(objective_.table.object_of(v));
        for (int k = 0; k < blocks.dofs(v); ++k) work(v * block_ + k, size_t(first) + size_t(k) * stride, block);
    }
}

std::vector<double> AssembledMatrix::right_hand_side() const {
    const BlockSet &blocks = objective_.blocks;
    std::vector<double> b(size(), 0.0);
    const std::vector<unsigned char> active = blocks.blocks_with(blocks.active_objects());
    for_unknowns([&](int row, size_t i, int block) {
        if (active[block]) b[row] = -blocks[block].gradient()[i - blocks.begin(block)];
    });
    return b;
}

void AssembledMatrix::set(View<double> solution, AlignedVector &direction) const {
    for_unknowns([&](int row, size_t i, int) { direction[i] = solution[row]; });
}

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
    const auto unconverged = [&](int iterations, const std::vector<double> &rz, const std::vector<double> &decreases) {
        if (iterations > 0) test.add_decreases(decreases);
        if (iterations == settings.max_iterations) return std::vector<unsigned char>(all.size(), 0);
        return test.unconverged({iterations, rz, coupled_.work(), coupled_.products()});
    };
    const ConjugateGradientResult solved = ringlet::conjugate_gradient(coupled_, r, x, unconverged);
    coupled_.solution(x, direction);
    const double before = total(all), left = std::max(total(solved.residual2), 0.0);
    return {solved.iterations, before > 0.0 ? std::sqrt(left / before) : 0.0};
}

} // namespace ringlet
