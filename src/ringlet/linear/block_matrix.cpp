#include "ringlet/linear/block_matrix.h"

#include "ringlet/math/parallel.h"

#include <algorithm>

namespace ringlet {

BlockMatrix::BlockMatrix(int rows, View<std::array<int, 2>> pairs) {
    std::vector<std::vector<int>> neighbours(rows);
    for (int i = 0; i < rows; ++i) neighbours[i].push_back(i);
    for (const auto &[a, b] : pairs) {
        neighbours[a].push_back(b);
        neighbours[b].push_back(a);
    }
    for (int i = 0; i < rows; ++i) {
        std::vector<int> &row = neighbours[i];
        std::sort(row.begin(), row.end());
        row.erase(std::unique(row.begin(), row.end()), row.end());
        columns_.insert(columns_.end(), row.begin(), row.end());
        starts_.push_back(int(columns_.size()));
    }
    blocks_.assign(columns_.size(), Mat3::Zero());
    for (int i = 0; i < rows; ++i) diagonals_.push_back(slot(i, i));
}

int BlockMatrix::slot(int row, int column) const {
    const auto begin = columns_.begin() + starts_[row], end = columns_.begin() + starts_[row + 1];
    const auto found = std::lower_bound(begin, end, column);
    return found != end && *found == column ? int(found - columns_.begin()) : -1;
}

void BlockMatrix::set_zero() { std::fill(blocks_.begin(), blocks_.end(), Mat3::Zero()); }

void BlockMatrix::multiply(const Eigen::VectorXd &x, Eigen::VectorXd &y) const {
    y.resize(x.size());
    const int least_parallel_rows = 2000; // below, starting threads takes longer than they save
    parallel_for(rows(), least_parallel_rows, [&](int i) {
        Vec3 sum = Vec3::Zero();
        for (int s = starts_[i]; s < starts_[i + 1]; ++s) sum.noalias() += blocks_[s] * x.segment<3>(3 * columns_[s]);
        y.segment<3>(3 * i) = sum;
    });
}

ScalarRows BlockMatrix::scalar_rows() const {
    ScalarRows result{{0}, {}, {}};
    for (int i = 0; i < rows(); ++i)
        for (int r = 0; r < 3; ++r) {
            for (int s = starts_[i]; s < starts_[i + 1]; ++s)
                for (int c = 0; c < 3; ++c) {
                    result.columns.push_back(3 * columns_[s] + c);
                    result.values.push_back(blocks_[s](r, c));
                }
            result.starts.push_back(int(result.columns.size()));
        }
    return result;
}

} // namespace ringlet
