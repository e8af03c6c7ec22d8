// A symmetric sparse matrix of 3×3 blocks whose pattern is fixed: made once from the pairs of vertices that meet in an energy.
// Blocks have slots that are looked up once, so that assembling is adding into an array.
#pragma once

#include "ringlet/math/types.h"

#include <array>
#include <vector>

namespace ringlet {

// Rows of scalars, columns ascending in each: for solvers that know no blocks.
struct ScalarRows {
    std::vector<int> starts, columns;
    std::vector<double> values;
};

class BlockMatrix {
public:
    BlockMatrix() = default;

    // Every row has its diagonal block; each pair gives a block and its mirror image. Pairs may repeat.
    BlockMatrix(int rows, View<std::array<int, 2>> pairs);

    int rows() const { return int(starts_.size()) - 1; }

    // Slots of a row are consecutive, columns ascending.
    int row_begin(int row) const { return starts_[row]; }
    int row_end(int row) const { return starts_[row + 1]; }
    int column(int slot) const { return columns_[slot]; }
    int diagonal(int row) const { return diagonals_[row]; }
    int slot(int row, int column) const; // −1 where the pattern has none

    // A block and its mirror image are two slots: who fills the matrix fills both.
    Mat3 &block(int slot) { return blocks_[slot]; }
    const Mat3 &block(int slot) const { return blocks_[slot]; }
    void set_zero();

    // y = A x, a row at a time: the same bits for any number of threads.
    void multiply(const Eigen::VectorXd &x, Eigen::VectorXd &y) const;

    ScalarRows scalar_rows() const;

private:
    std::vector<int> starts_{0}, columns_, diagonals_;
    std::vector<Mat3> blocks_;
};

} // namespace ringlet
