// Preconditioned conjugate gradients for A x = b, A symmetric positive definite: what tests judge preconditioners by.
//   apply(x, y)         y = A x
//   precondition(r, z)  z ≈ A⁻¹ r, symmetric positive definite
#pragma once

#include <Eigen/Core>
#include <cmath>

namespace ringlet {

struct ConjugateGradientSettings {
    double tolerance = 1e-3; // of ‖b − A x‖ / ‖b‖
    int iterations = 1000;   // at most
};

struct ConjugateGradientResult {
    int iterations = 0;
    double residual = 0; // ‖b − A x‖ / ‖b‖, recomputed at the end
    bool converged = true;
};

// Starts at x = 0. Stops early at a direction of non-positive curvature; x is then the last iterate, which is still a descent
// direction of ½ xᵀAx − bᵀx.
template <class Apply, class Precondition>
ConjugateGradientResult conjugate_gradient(const Apply &apply, const Precondition &precondition, const Eigen::VectorXd &b,
                                           Eigen::VectorXd &x, const ConjugateGradientSettings &settings = {}) {
    ConjugateGradientResult result;
    x.setZero(b.size());
    const double size = b.norm();
    if (size == 0) return result;

    Eigen::VectorXd r = b, z(b.size()), Ap(b.size());
    precondition(r, z);
    Eigen::VectorXd p = z;
    double rz = r.dot(z);
    while (result.iterations < settings.iterations && r.norm() > settings.tolerance * size) {
        apply(p, Ap);
        const double curvature = p.dot(Ap);
        if (!(curvature > 0)) break;
        const double alpha = rz / curvature;
        x += alpha * p;
        r -= alpha * Ap;
        precondition(r, z);
        const double next = r.dot(z);
        p = z + (next / rz) * p;
        rz = next;
        ++result.iterations;
    }
    apply(x, Ap);
    result.residual = (b - Ap).norm() / size;
    result.converged = result.residual <= 2 * settings.tolerance; // rounding separates the two residuals
    return result;
}

} // namespace ringlet
