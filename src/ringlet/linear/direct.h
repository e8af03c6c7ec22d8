// Solves A x = b by factoring the whole of a sparse symmetric positive definite A: exact and robust, for small or hard systems.
#pragma once

#include "ringlet/linear/factorisation.h"

#include <memory>

namespace ringlet {

enum class DirectMethod { automatic, builtin, pardiso }; // automatic: PARDISO where its library is found

class DirectSolver {
public:
    // Throws std::runtime_error of one line where PARDISO is asked for by name and is not there.
    explicit DirectSolver(DirectMethod method = DirectMethod::automatic);

    DirectMethod method() const { return method_; } // in use, never automatic

    // Orders the unknowns and finds where the factor fills in: once for all matrices of a pattern (of the upper triangle).
    void analyse(std::shared_ptr<const SparsePattern> pattern);

    // Takes the values of the matrix, in the pattern's order. False where it is not positive definite (or not finite).
    bool factor(View<double> triplets);

    // After a factor() that returned true. Returns the relative residual ‖b − A x‖ / ‖b‖, measured, after improving x by it as
    // long as that helps: above rounding it says that A is too badly conditioned for x to be trusted to the last digits.
    double solve(View<double> b, std::span<double> x) const;

    std::int64_t entries() const { return factorisation_->entries(); } // of the triangular factor

private:
    DirectMethod method_;
    std::shared_ptr<const SparsePattern> pattern_;
    std::unique_ptr<SparseMatrix> matrix_;
    std::unique_ptr<Factorisation> factorisation_;
};

} // namespace ringlet
