// A system of conjugate gradients whose unknowns are one Eigen vector, for tests of the method and of preconditioners.
//   apply(x, y)         y = A x
//   precondition(r, z)  z ≈ A⁻¹ r, symmetric positive definite
#pragma once

#include "ringlet/linear/conjugate_gradient.h"

#include <Eigen/Core>

namespace ringlet {

template <class Apply, class Precondition> class PlainSystem {
public:
    using Unknowns = Eigen::VectorXd;
    using Residual = Eigen::VectorXd;
    using Numbers = std::vector<double>;
    using Mask = std::vector<unsigned char>;

    // `ends`: the first unknown behind each cluster.
    PlainSystem(Apply apply, Precondition precondition, std::vector<int> ends)
        : apply_(apply), precondition_(precondition), ends_(std::move(ends)) {}

    size_t clusters() const { return ends_.size(); }
    Numbers extend(const Unknowns &z, const Numbers &beta, Unknowns &p, Residual &Ap, const Mask &busy) const {
        for_clusters(busy, [&](size_t c, auto of) { p(of) = z(of) + beta[c] * p(of); });
        apply_(p, Ap);
        return products(p, Ap);
    }
    Numbers advance(const Numbers &alpha, const Unknowns &p, const Residual &Ap, Unknowns &x, Residual &r, Unknowns &z,
                    const Mask &busy) const {
        for_clusters(busy, [&](size_t c, auto of) { x(of) += alpha[c] * p(of), r(of) -= alpha[c] * Ap(of); });
        precondition_(r, z);
        return products(r, z);
    }

private:
    template <class Work> void for_clusters(const Mask &busy, const Work &work) const {
        for (size_t c = 0; c < ends_.size(); ++c)
            if (const int first = c > 0 ? ends_[c - 1] : 0; busy[c]) work(c, Eigen::seq(first, ends_[c] - 1));
    }
    Numbers products(const Eigen::VectorXd &a, const Eigen::VectorXd &b) const {
        Numbers sums(clusters());
        for_clusters(Mask(clusters(), 1), [&](size_t c, auto of) { sums[c] = a(of).dot(b(of)); });
        return sums;
    }

    Apply apply_;
    Precondition precondition_;
    std::vector<int> ends_;
};

// Solves A x = b from x = 0 until r · z has fallen by the square of the tolerance in each cluster, or for `most` iterations.
template <class Apply, class Precondition>
int solve_plainly(const Apply &apply, const Precondition &precondition, const Eigen::VectorXd &b, Eigen::VectorXd &x,
                  double tolerance, int most = 5000, std::vector<int> ends = {}) {
    PlainSystem system(apply, precondition, ends.empty() ? std::vector<int>{int(b.size())} : ends);
    Eigen::VectorXd r = b;
    x.setZero(b.size());
    std::vector<double> first;
    const auto unconverged = [&](int iterations, const std::vector<double> &rz, const std::vector<double> &) {
        if (iterations == 0) first = rz;
        std::vector<unsigned char> busy(rz.size());
        for (size_t c = 0; c < rz.size(); ++c) busy[c] = iterations < most && rz[c] > tolerance * tolerance * first[c];
        return busy;
    };
    return conjugate_gradient(system, r, x, unconverged).iterations;
}

} // namespace ringlet
