// Incomplete Cholesky preconditioner A ≈ L Lᵀ in 3×3 blocks, where L has the pattern of the lower triangle of A (block IC(0):
// Meijerink and van der Vorst 1977). If a pivot fails, the factorisation starts again with a larger shift of the diagonal.
#pragma once

#include "ringlet/linear/block_matrix.h"

namespace ringlet {

class IncompleteCholesky {
public:
    // The matrix is symmetric and its diagonal blocks are positive definite.
    void factor(const BlockMatrix &matrix);

    // z = (L Lᵀ)⁻¹ r.
    void solve(const Eigen::VectorXd &r, Eigen::VectorXd &z) const;

    double shift() const { return shift_; } // relative shift of the diagonal; 0 if no pivot failed

private:
    bool try_factor(const BlockMatrix &matrix);

    double shift_ = 0;
    std::vector<int> starts_, columns_; // CSR pattern of the strictly lower triangle
    std::vector<Mat3> lower_;           // Lᵢₖ
    std::vector<Mat3> inverses_;        // Lᵢᵢ⁻¹
};

} // namespace ringlet
