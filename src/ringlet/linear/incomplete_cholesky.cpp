#include "ringlet/linear/incomplete_cholesky.h"

#include <Eigen/Cholesky>
#include <algorithm>

namespace ringlet {

void IncompleteCholesky::factor(const BlockMatrix &matrix) {
    starts_.assign(1, 0);
    columns_.clear();
    for (int i = 0; i < matrix.rows(); ++i) {
        for (int s = matrix.row_begin(i); matrix.column(s) < i; ++s) columns_.push_back(matrix.column(s));
        starts_.push_back(int(columns_.size()));
    }
    lower_.resize(columns_.size());
    inverses_.resize(matrix.rows());
    // A large enough shift makes every row diagonally dominant, and then no pivot fails.
    for (shift_ = 0; !try_factor(matrix) && shift_ < 1e6; shift_ = std::max(1e-3, 2 * shift_)) {
    }
}

bool IncompleteCholesky::try_factor(const BlockMatrix &matrix) {
    const double least = 1e-10; // smallest pivot, as a fraction of the diagonal entry; below is rounding
    for (int i = 0; i < matrix.rows(); ++i) {
        const Mat3 &whole = matrix.block(matrix.diagonal(i));
        Mat3 pivot = (1 + shift_) * whole;
        for (int a = starts_[i]; a < starts_[i + 1]; ++a) {
            const int k = columns_[a];
            Mat3 rest = matrix.block(matrix.row_begin(i) + a - starts_[i]);
            // Columns before k that rows i and k have in common.
            for (int b = starts_[i], c = starts_[k]; b < a && c < starts_[k + 1];) {
                if (columns_[b] == columns_[c])
                    rest.noalias() -= lower_[b++] * lower_[c++].transpose();
                else
                    ++(columns_[b] < columns_[c] ? b : c);
            }
            lower_[a].noalias() = rest * inverses_[k].transpose();
            pivot.noalias() -= lower_[a] * lower_[a].transpose();
        }
        const Eigen::LLT<Mat3> cholesky(pivot);
        if (cholesky.info() != Eigen::Success) return false;
        const Mat3 L = cholesky.matrixL();
        if (!(L.diagonal().array().square() > least * whole.diagonal().array()).all()) return false;
        inverses_[i] = L.triangularView<Eigen::Lower>().solve(Mat3::Identity());
    }
    return true;
}

void IncompleteCholesky::solve(const Eigen::VectorXd &r, Eigen::VectorXd &z) const {
    const int rows = int(inverses_.size());
    z.resize(r.size());
    for (int i = 0; i < rows; ++i) {
        Vec3 rest = r.segment<3>(3 * i);
        for (int a = starts_[i]; a < starts_[i + 1]; ++a) rest.noalias() -= lower_[a] * z.segment<3>(3 * columns_[a]);
        z.segment<3>(3 * i).noalias() = inverses_[i] * rest;
    }
    for (int i = rows - 1; i >= 0; --i) {
        const Vec3 solved = inverses_[i].transpose() * z.segment<3>(3 * i);
        z.segment<3>(3 * i) = solved;
        for (int a = starts_[i]; a < starts_[i + 1]; ++a)
            z.segment<3>(3 * columns_[a]).noalias() -= lower_[a].transpose() * solved;
    }
}

} // namespace ringlet
