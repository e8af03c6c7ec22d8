#include "ringlet/linear/direct.h"

#include "ringlet/linear/pardiso.h"
#include "ringlet/linear/simplicial.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace ringlet {

DirectSolver::DirectSolver(DirectMethod method) : method_(method) {
    if (method == DirectMethod::pardiso && !pardiso_available())
        throw std::runtime_error("direct solver: pardiso is not there; install it with pip install 'ringlet[direct]'");
    if (method == DirectMethod::automatic) method_ = pardiso_available() ? DirectMethod::pardiso : DirectMethod::builtin;
}

void DirectSolver::analyse(std::shared_ptr<const SparsePattern> pattern) {
    factorisation_ = method_ == DirectMethod::pardiso ? make_pardiso(*pattern) : make_simplicial(*pattern);
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
