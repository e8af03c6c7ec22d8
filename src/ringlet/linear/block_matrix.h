// Symmetric sparse matrix of 3×3 blocks with a fixed sparsity pattern: the pairs of vertices that share an energy term.
// Assembly adds into slots, whose numbers are looked up once.
#pragma once

#include "ringlet/math/types.h"

#include <array>
#include <vector>

namespace ringlet {

// Scalar CSR matrix with ascending columns, for solvers without blocks.
struct ScalarRows {
    std::vector<int> starts, columns;
    std::vector<double> values;
};

class BlockMatrix {
public:
    BlockMatrix() = default;

    // The pattern has all diagonal blocks, and for each pair a block and its transpose. Pairs may repeat.
    BlockMatrix(int rows, View<std::array<int, 2>> pairs);

    int rows() const { return int(starts_.size()) - 1; }

    // Slots of a row are consecutive, columns ascending.
    int row_begin(int row) const { return starts_[row]; }
    int row_end(int row) const { return starts_[row + 1]; }
    int column(int slot) const { return columns_[slot]; }
    int diagonal(int row) const { return diagonals_[row]; }
    int slot(int row, int column) const; // −1: not in the pattern

    // A block and its transpose are two slots; assembly fills both.
    Mat3 &block(int slot) { return blocks_[slot]; }
    const Mat3 &block(int slot) const { return blocks_[slot]; }
    void set_zero();

    // y = A x, row by row, so that the result is the same bits for any number of threads.
    void multiply(const Eigen::VectorXd &x, Eigen::VectorXd &y) const;

    ScalarRows scalar_rows() const;

private:
    std::vector<int> starts_{0}, columns_, diagonals_;
    std::vector<Mat3> blocks_;
};

} // namespace ringlet
