// A preconditioner: A ≈ L Lᵀ in blocks, where L keeps the pattern of A's lower part (block IC(0)). Where a pivot fails, the
// diagonal is raised by a part of itself and the factor begun again.
#pragma once

#include "ringlet/linear/block_matrix.h"

namespace ringlet {

class IncompleteCholesky {
public:
    // The matrix is symmetric and its diagonal blocks are positive definite.
    void factor(const BlockMatrix &matrix);

    // z = (L Lᵀ)⁻¹ r.
    void solve(const Eigen::VectorXd &r, Eigen::VectorXd &z) const;

    double shift() const { return shift_; } // the part that was added to the diagonal, 0 at best

private:
    bool try_factor(const BlockMatrix &matrix);

    double shift_ = 0;
    std::vector<int> starts_, columns_; // of the blocks left of the diagonal, row by row
    std::vector<Mat3> lower_;           // Lᵢₖ
    std::vector<Mat3> inverses_;        // Lᵢᵢ⁻¹
};

} // namespace ringlet
