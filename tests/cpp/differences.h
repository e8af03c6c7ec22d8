// Gradients by central differences, and random vectors to evaluate them at.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <random>

namespace ringlet {

inline Eigen::VectorXd differences(const std::function<double(const Eigen::VectorXd &)> &f, Eigen::VectorXd x, double h) {
    Eigen::VectorXd g(x.size());
    for (int k = 0; k < x.size(); ++k) {
        const double at = x[k];
        x[k] = at + h;
        const double up = f(x);
        x[k] = at - h;
        g[k] = (up - f(x)) / (2 * h);
        x[k] = at;
    }
    return g;
}

inline Eigen::VectorXd random_vector(int size, std::mt19937 &random) {
    std::normal_distribution<double> normal;
    Eigen::VectorXd x(size);
    for (int k = 0; k < size; ++k) x[k] = normal(random);
    return x;
}

} // namespace ringlet
