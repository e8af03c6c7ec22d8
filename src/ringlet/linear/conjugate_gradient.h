// Preconditioned conjugate gradients for A x = b, A symmetric positive definite (Hestenes and Stiefel 1952; Saad 2003,
// algorithm 9.1). Where A consists of clusters that nothing couples, each has step lengths of its own and rests once it has
// converged.
#pragma once

#include <algorithm>
#include <vector>

namespace ringlet {

struct ConjugateGradientResult {
    int iterations;
    std::vector<double> residual2; // r · z of each cluster
};

// Improves x, whose residual b − A x is r. A System has Unknowns and Residuals, and numbers of each of its clusters():
//   extend(z, b, p, Ap, busy)        p = z + b p, Ap = A p; returns p · A p
//   advance(a, p, Ap, x, r, z, busy) x += a p, r −= a A p, z ≈ A⁻¹ r, symmetric positive definite; returns r · z
// unconverged(iterations, r · z, decreases) returns which clusters are busy; the decreases are those of xᵀA x − 2 bᵀx in the
// last iteration. Where the curvature p · A p is not positive, a cluster keeps its x, and its r · z becomes 0.
template <class System, class Unconverged>
ConjugateGradientResult conjugate_gradient(System &system, typename System::Residual &r, typename System::Unknowns &x,
                                           const Unconverged &unconverged) {
    const size_t clusters = system.clusters();
    std::vector<unsigned char> busy(clusters, 1);
    typename System::Residual Ap = r;
    typename System::Unknowns z = x, p = x;
    std::vector<double> alpha(clusters, 0.0), beta(clusters, 0.0), decrease(clusters, 0.0);
    std::vector<double> rz = system.advance(alpha, p, Ap, x, r, z, busy);
    for (int iterations = 0;; ++iterations) {
        busy = unconverged(iterations, rz, decrease);
        if (std::count(busy.begin(), busy.end(), 1) == 0) return {iterations, rz};
        const std::vector<double> curvature = system.extend(z, beta, p, Ap, busy);
        for (size_t c = 0; c < clusters; ++c) alpha[c] = busy[c] && curvature[c] > 0.0 ? rz[c] / curvature[c] : 0.0;
        const std::vector<double> next = system.advance(alpha, p, Ap, x, r, z, busy);
        for (size_t c = 0; c < clusters; ++c) {
            decrease[c] = alpha[c] * rz[c];
            beta[c] = busy[c] && rz[c] > 0.0 ? next[c] / rz[c] : 0.0;
            if (busy[c]) rz[c] = alpha[c] > 0.0 ? next[c] : 0.0;
        }
    }
}

} // namespace ringlet
