// Memory layout of a symmetric banded matrix.
#pragma once

#include <cstddef>

namespace ringlet {

// Lower triangle, column by column. The degrees of freedom of a vertex are a block. The first column of a block has `band` rows
// from the diagonal on, and the others end in the same row.
struct BandLayout {
    int block, band;

    constexpr int rows(int column) const { return band - column % block; }
    constexpr size_t begin(int column) const { // index of the diagonal entry of a column
        const int in_block = column % block;
        return size_t(column / block) * (block * band - before(block)) + in_block * band - before(in_block);
    }

private:
    static constexpr int before(int columns) { return columns * (columns - 1) / 2; } // entries that these columns lack
};

} // namespace ringlet
