// Where the numbers of a banded matrix stand.
#pragma once

#include <cstddef>

namespace ringlet {

// The lower half, column by column. Unknowns come in blocks, those of a vertex; a block's first column has `band` rows from its
// own on, and the others end in the same row.
struct BandLayout {
    int block, band;

    constexpr int rows(int column) const { return band - column % block; }
    constexpr size_t begin(int column) const { // of the numbers of a column, the first being on the diagonal
        const int in_block = column % block;
        return size_t(column / block) * (block * band - before(block)) + in_block * band - before(in_block);
    }

private:
    static constexpr int before(int columns) { return columns * (columns - 1) / 2; } // numbers that as many columns spare
};

} // namespace ringlet
