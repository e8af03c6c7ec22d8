#include "ringlet/linear/direct.h"

#include <Eigen/OrderingMethods>
#include <Eigen/SparseCholesky>
#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace ringlet {
namespace {

// Built-in: Eigen's simplicial L D Lᵀ. The minimum-degree ordering is that of the graph of blocks, which is nine or sixteen
// times smaller than the graph of scalars and gives no more fill-in.
using FactorIndex = std::int64_t; // a factor can have more entries than an int counts
using Sparse = Eigen::SparseMatrix<double, Eigen::ColMajor, FactorIndex>;
using Permutation = Eigen::PermutationMatrix<Eigen::Dynamic, Eigen::Dynamic, FactorIndex>;

// Calls visit(row, column, number) for every stored block.
template <class Visit> void for_each_block(const SparsePattern &pattern, const Visit &visit) {
    for (int row = 0; row < pattern.rows(); ++row)
        for (int at = pattern.starts()[row]; at < pattern.starts()[row + 1]; ++at) visit(row, pattern.columns()[at], at);
}

// Fill-reducing permutation of the block rows.
Permutation order_blocks(const SparsePattern &pattern) {
    std::vector<Eigen::Triplet<double, FactorIndex>> graph;
    graph.reserve(pattern.columns().size());
    for_each_block(pattern,
                   [&](int row, int column, int) { graph.emplace_back(std::max(row, column), std::min(row, column), 1.0); });
    Sparse lower(pattern.rows(), pattern.rows());
    lower.setFromTriplets(graph.begin(), graph.end());
    Permutation from;
    Eigen::AMDOrdering<FactorIndex>()(lower.selfadjointView<Eigen::Lower>(), from);
    return from.inverse();
}

class Simplicial final : public Factorisation {
public:
    explicit Simplicial(const SparsePattern &pattern) : to_(pattern.size()), lower_(pattern.size(), pattern.size()) {
        const int block = pattern.block();
        const Permutation blocks_to = order_blocks(pattern);
        for (int i = 0; i < pattern.size(); ++i) to_.indices()[i] = blocks_to.indices()[i / block] * block + i % block;

        // Reordered lower triangle, with the number of each value in place of the value.
        std::vector<Eigen::Triplet<double, FactorIndex>> numbers;
        numbers.reserve(pattern.values());
        for_each_block(pattern, [&](int row, int column, int at) {
            for (int r = 0; r < block; ++r)
                for (int c = 0; c < (row == column ? r + 1 : block); ++c) {
                    const FactorIndex i = to_.indices()[row * block + r], j = to_.indices()[column * block + c];
                    numbers.emplace_back(std::max(i, j), std::min(i, j), double(at * pattern.square() + r * block + c));
                }
        });
        lower_.setFromTriplets(numbers.begin(), numbers.end());
        source_.assign(lower_.valuePtr(), lower_.valuePtr() + lower_.nonZeros());
        ldlt_.analyzePattern(lower_);
    }

    bool factor(const SparseMatrix &matrix) override {
        for (size_t k = 0; k < source_.size(); ++k) lower_.valuePtr()[k] = matrix.values()[source_[k]];
        ldlt_.factorize(lower_);
        return ldlt_.info() == Eigen::Success && (ldlt_.vectorD().array() > 0).all();
    }

    void solve(View<double> b, std::span<double> x) const override {
        const Eigen::Map<const Eigen::VectorXd> right(b.data(), b.size());
        Eigen::Map<Eigen::VectorXd>(x.data(), x.size()) = to_.inverse() * ldlt_.solve(to_ * right);
    }

    std::int64_t entries() const override { return ldlt_.matrixL().nestedExpression().nonZeros() + lower_.rows(); }

private:
    Permutation to_; // of the scalars
    Sparse lower_;
    std::vector<FactorIndex> source_; // number of the value of each entry of lower_
    Eigen::SimplicialLDLT<Sparse, Eigen::Lower, Eigen::NaturalOrdering<FactorIndex>> ldlt_;
};

} // namespace

DirectSolver::DirectSolver(DirectMethod method) : method_(method) {
    if (method == DirectMethod::pardiso && !pardiso_available())
        throw std::runtime_error("direct solver: pardiso is not there; install it with pip install 'ringlet[direct]'");
    if (method == DirectMethod::automatic) method_ = pardiso_available() ? DirectMethod::pardiso : DirectMethod::builtin;
}

void DirectSolver::analyse(std::shared_ptr<const SparsePattern> pattern) {
    if (method_ == DirectMethod::pardiso)
        factorisation_ = make_pardiso(*pattern);
    else
        factorisation_ = std::make_unique<Simplicial>(*pattern);
    matrix_ = std::make_unique<SparseMatrix>(std::move(pattern));
}

bool DirectSolver::factor(View<double> triplets) {
    matrix_->assemble(triplets);
    const View<double> values = matrix_->values();
    const bool finite = std::all_of(values.begin(), values.end(), [](double value) { return std::isfinite(value); });
    return finite && factorisation_->factor(*matrix_);
}

double DirectSolver::solve(View<double> b, std::span<double> x) const {
    const size_t n = b.size();
    std::vector<double> residual(n), change(n);
    const auto measure = [&] { // computes the residual of x; returns its norm
        matrix_->multiply(x, residual);
        double square = 0;
        for (size_t i = 0; i < n; ++i) {
            residual[i] = b[i] - residual[i];
            square += residual[i] * residual[i];
        }
        return std::sqrt(square);
    };

    const int max_refinements = 3;
    std::fill(x.begin(), x.end(), 0.0);
    const double size = measure();
    if (size == 0) return 0;
    factorisation_->solve(b, x);
    double left = measure();
    for (int k = 0; k < max_refinements && left > 0; ++k) {
        factorisation_->solve(residual, change);
        for (size_t i = 0; i < n; ++i) x[i] += change[i];
        const double now = measure();
        if (!(now < left)) { // the rest is rounding
            for (size_t i = 0; i < n; ++i) x[i] -= change[i];
            break;
        }
        const bool enough = now > 0.5 * left;
        left = now;
        if (enough) break;
    }
    return left / size;
}

} // namespace ringlet
