// Factorisation of symmetric positive definite matrices of one pattern; the interface of the back ends of DirectSolver.
#pragma once

#include "ringlet/linear/sparse_matrix.h"

#include <cstdint>

namespace ringlet {

class Factorisation {
public:
    virtual ~Factorisation() = default;
    virtual bool factor(const SparseMatrix &matrix) = 0;               // false if the matrix is not positive definite
    virtual void solve(View<double> b, std::span<double> x) const = 0; // after factor() has succeeded
    virtual std::int64_t entries() const = 0;                          // nonzeros of the triangular factor
};

} // namespace ringlet
