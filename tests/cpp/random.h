// Random numbers and vectors for the tests.
#pragma once

#include "ringlet/math/types.h"

#include <random>

namespace ringlet {

struct Random {
    std::mt19937 engine{7};
    double operator()(double low, double high) { return std::uniform_real_distribution<>(low, high)(engine); }
    Vec3 vector(double size) { return {(*this)(-size, size), (*this)(-size, size), (*this)(-size, size)}; }
};

} // namespace ringlet
