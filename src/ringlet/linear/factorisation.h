// What a direct solver is made of: a factorisation of symmetric positive definite matrices of one pattern.
#pragma once

#include "ringlet/linear/sparse_matrix.h"

#include <cstdint>

namespace ringlet {

class Factorisation {
public:
    virtual ~Factorisation() = default;
    virtual bool factor(const SparseMatrix &matrix) = 0;               // false where the matrix is not positive definite
    virtual void solve(View<double> b, std::span<double> x) const = 0; // after factor() has succeeded
    virtual std::int64_t entries() const = 0;                          // of the triangular factor, for what it costs
};

} // namespace ringlet
