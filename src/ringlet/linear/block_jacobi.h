// The simplest preconditioner of a block matrix: the inverses of its diagonal blocks.
#pragma once

#include "ringlet/linear/block_matrix.h"

#include <Eigen/LU>

namespace ringlet {

class BlockJacobi {
public:
    // Diagonal blocks must be positive definite.
    void factor(const BlockMatrix &matrix) {
        inverses_.resize(matrix.rows());
        for (int i = 0; i < matrix.rows(); ++i) inverses_[i] = matrix.block(matrix.diagonal(i)).inverse();
    }

    void solve(const Eigen::VectorXd &r, Eigen::VectorXd &z) const {
        z.resize(r.size());
        for (int i = 0; i < int(inverses_.size()); ++i) z.segment<3>(3 * i).noalias() = inverses_[i] * r.segment<3>(3 * i);
    }

private:
    std::vector<Mat3> inverses_;
};

} // namespace ringlet
