#include "ringlet/linear/sparse_matrix.h"

#include <algorithm>
#include <numeric>
#include <stdexcept>

namespace ringlet {

SparsePattern::SparsePattern(int rows, int block, View<int> i, View<int> j)
    : block_(block), starts_(size_t(rows) + 1, 0), slots_(i.size()) {
    if (rows < 1 || block < 1 || i.size() != j.size()) throw std::invalid_argument("sparse pattern: sizes do not fit");

    // Blocks are sorted by row · rows + column. A diagonal block for every row comes first.
    std::vector<std::int64_t> places(rows + i.size());
    for (int row = 0; row < rows; ++row) places[row] = std::int64_t(row) * rows + row;
    for (size_t k = 0; k < i.size(); ++k) {
        if (std::min(i[k], j[k]) < 0 || std::max(i[k], j[k]) >= rows)
            throw std::invalid_argument("sparse pattern: a triplet is outside the matrix");
        slots_[k].transposed = i[k] > j[k];
        const int row = slots_[k].transposed ? j[k] : i[k], column = slots_[k].transposed ? i[k] : j[k];
        places[rows + k] = std::int64_t(row) * rows + column;
    }
    std::vector<size_t> order(places.size());
    std::iota(order.begin(), order.end(), size_t(0));
    std::sort(order.begin(), order.end(), [&](size_t a, size_t b) { return places[a] < places[b]; });

    std::int64_t last = -1;
    for (const size_t at : order) {
        if (places[at] != last) {
            last = places[at];
            columns_.push_back(int(last % rows));
            ++starts_[last / rows + 1];
        }
        if (at >= size_t(rows)) slots_[at - rows].block = int(columns_.size()) - 1;
    }
    std::partial_sum(starts_.begin(), starts_.end(), starts_.begin());
}

SparseMatrix::SparseMatrix(std::shared_ptr<const SparsePattern> pattern)
    : pattern_(std::move(pattern)), values_(pattern_->values(), 0.0) {}

void SparseMatrix::assemble(View<double> triplets) {
    const int block = pattern_->block();
    const size_t square = pattern_->square();
    if (triplets.size() != pattern_->slots().size() * square)
        throw std::invalid_argument("sparse matrix: triplets do not fit the pattern");
    std::fill(values_.begin(), values_.end(), 0.0);
    const double *from = triplets.data();
    for (const SparsePattern::Slot slot : pattern_->slots()) {
        double *to = values_.data() + slot.block * square;
        for (int r = 0; r < block; ++r)
            for (int c = 0; c < block; ++c) to[r * block + c] += from[slot.transposed ? c * block + r : r * block + c];
        from += square;
    }
}

template <class Visit> void SparseMatrix::for_each(const Visit &visit) const {
    const int block = pattern_->block();
    const double *value = values_.data();
    for (int row = 0; row < pattern_->rows(); ++row)
        for (int at = pattern_->starts()[row]; at < pattern_->starts()[row + 1]; ++at) {
            const int column = pattern_->columns()[at];
            for (int r = row * block; r < (row + 1) * block; ++r)
                for (int c = column * block; c < (column + 1) * block; ++c, ++value) {
                    visit(r, c, *value);
                    if (row != column) visit(c, r, *value);
                }
        }
}

void SparseMatrix::multiply(View<double> x, std::span<double> y) const {
    std::fill(y.begin(), y.end(), 0.0);
    for_each([&](int r, int c, double value) { y[r] += value * x[c]; });
}

Eigen::MatrixXd SparseMatrix::dense() const {
    Eigen::MatrixXd whole = Eigen::MatrixXd::Zero(pattern_->size(), pattern_->size());
    for_each([&](int r, int c, double value) { whole(r, c) = value; });
    return whole;
}

} // namespace ringlet
