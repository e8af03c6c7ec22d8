// A symmetric sparse matrix of square blocks. One triangle is kept, row by row (block CSR), with every diagonal block and
// sorted columns; where blocks stand is a pattern that many matrices can share.
#pragma once

#include "ringlet/math/types.h"

#include <memory>
#include <vector>

namespace ringlet {

enum class Half { upper, lower };

// Made of triplets (i, j) of block rows and columns, either way round and as often as wanted. An off-diagonal triplet stands
// for its mirror image too.
class SparsePattern {
public:
    // Throws std::invalid_argument where a triplet is outside the matrix.
    SparsePattern(int rows, int block, View<int> i, View<int> j, Half half = Half::upper);

    int rows() const { return int(starts_.size()) - 1; }         // of blocks
    int block() const { return block_; }                         // rows of one block: 1, 3 or 4
    int size() const { return rows() * block_; }                 // unknowns
    size_t values() const { return columns_.size() * square(); } // numbers that a matrix keeps
    size_t square() const { return size_t(block_) * block_; }
    Half half() const { return half_; }
    const std::vector<int> &starts() const { return starts_; }   // of each block row in columns; rows + 1
    const std::vector<int> &columns() const { return columns_; } // of each block

    // Where the triplets of the pattern go: the block's number, and whether it is kept transposed.
    struct Slot {
        int block;
        bool transposed;
    };
    const std::vector<Slot> &slots() const { return slots_; }

private:
    int block_;
    Half half_;
    std::vector<int> starts_, columns_;
    std::vector<Slot> slots_;
};

class SparseMatrix {
public:
    explicit SparseMatrix(std::shared_ptr<const SparsePattern> pattern);

    // Sums the blocks of the pattern's triplets, in their order: block × block numbers each, row by row.
    void assemble(View<double> triplets);

    const SparsePattern &pattern() const { return *pattern_; }
    View<double> values() const { return values_; } // block by block, each row by row

    void multiply(View<double> x, std::span<double> y) const; // y = A x
    Eigen::MatrixXd dense() const;

private:
    // visit(r, c, value) for every number of the whole matrix, both triangles.
    template <class Visit> void for_each(const Visit &visit) const;

    std::shared_ptr<const SparsePattern> pattern_;
    std::vector<double> values_;
};

} // namespace ringlet
