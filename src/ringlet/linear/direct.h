// Direct solver for sparse symmetric positive definite systems A x = b: exact and robust, for small or ill-conditioned ones.
#pragma once

#include "ringlet/linear/sparse_matrix.h"

#include <cstdint>
#include <memory>
#include <string>

namespace ringlet {

// Factorisation of matrices of one pattern: Eigen's, or one that is hooked in (pardiso.cpp).
class Factorisation {
public:
    virtual ~Factorisation() = default;
    virtual bool factor(const SparseMatrix &matrix) = 0;               // false if the matrix is not positive definite
    virtual void solve(View<double> b, std::span<double> x) const = 0; // after factor() has succeeded
    virtual std::int64_t entries() const = 0;                          // nonzeros of the triangular factor
};

enum class DirectMethod { automatic, builtin, pardiso }; // automatic: PARDISO if its library is found

class DirectSolver {
public:
    // Throws std::runtime_error of one line if PARDISO is requested and not available.
    explicit DirectSolver(DirectMethod method = DirectMethod::automatic);

    DirectMethod method() const { return method_; } // in use, never automatic

    // Symbolic factorisation: fill-reducing order and fill-in, once for all matrices of a pattern (of the upper triangle).
    void analyse(std::shared_ptr<const SparsePattern> pattern);

    // Numeric factorisation of the values, in the order of the pattern. False if not positive definite or not finite.
    bool factor(View<double> triplets);

    // Solves after a factor() that returned true, with iterative refinement while that helps. Returns the relative residual
    // ‖b − A x‖ / ‖b‖. A residual above rounding means that A is too ill-conditioned for the last digits of x.
    double solve(View<double> b, std::span<double> x) const;

    std::int64_t entries() const { return factorisation_->entries(); } // nonzeros of the triangular factor

private:
    DirectMethod method_;
    std::unique_ptr<SparseMatrix> matrix_;
    std::unique_ptr<Factorisation> factorisation_;
};

// Factorisation by PARDISO of Intel's MKL: supernodal and parallel, many times faster than the built-in one for strands in
// contact. Ringlet is neither built nor shipped with it; the library is opened at run time, when it is first requested.

// Opens libmkl_rt at this path, or by its name if the path is empty. Returns whether PARDISO can be used; once it can, later
// calls have no effect.
bool open_pardiso(const std::string &path = {});
bool pardiso_available(); // open_pardiso() by name

// Requires pardiso_available().
std::unique_ptr<Factorisation> make_pardiso(const SparsePattern &pattern);

} // namespace ringlet
