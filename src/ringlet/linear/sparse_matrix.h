// Symmetric sparse matrix of square blocks. It stores the upper triangle in block CSR, with all diagonal blocks and sorted
// columns. Matrices can share a sparsity pattern.
#pragma once

#include "ringlet/math/types.h"

#include <memory>
#include <vector>

namespace ringlet {

// Sparsity pattern of triplets (i, j) of block rows and columns, in any order; they may repeat. An off-diagonal triplet also
// stands for its transpose.
class SparsePattern {
public:
    // Throws std::invalid_argument if a triplet is outside the matrix.
    SparsePattern(int rows, int block, View<int> i, View<int> j);

    int rows() const { return int(starts_.size()) - 1; }         // of blocks
    int block() const { return block_; }                         // rows of one block: 1, 3 or 4
    int size() const { return rows() * block_; }                 // scalar rows
    size_t values() const { return columns_.size() * square(); } // stored scalars of a matrix
    size_t square() const { return size_t(block_) * block_; }
    const std::vector<int> &starts() const { return starts_; }   // of each block row in columns; rows + 1
    const std::vector<int> &columns() const { return columns_; } // of each block

    // Block that each triplet is added to, and whether it is transposed first.
    struct Slot {
        int block;
        bool transposed;
    };
    const std::vector<Slot> &slots() const { return slots_; }

private:
    int block_;
    std::vector<int> starts_, columns_;
    std::vector<Slot> slots_;
};

class SparseMatrix {
public:
    explicit SparseMatrix(std::shared_ptr<const SparsePattern> pattern);

    // Sums the values of the triplets, in the order of the pattern: block × block scalars each, row by row.
    void assemble(View<double> triplets);

    const SparsePattern &pattern() const { return *pattern_; }
    View<double> values() const { return values_; } // block by block, each row by row

    void multiply(View<double> x, std::span<double> y) const; // y = A x
    Eigen::MatrixXd dense() const;

private:
    // Calls visit(r, c, value) for every scalar of both triangles.
    template <class Visit> void for_each(const Visit &visit) const;

    std::shared_ptr<const SparsePattern> pattern_;
    std::vector<double> values_;
};

} // namespace ringlet
