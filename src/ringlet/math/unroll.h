// Loops over constants.
#pragma once

#include <utility>

#ifndef RINGLET_SIMD
#define RINGLET_SIMD baseline
#endif

namespace ringlet::RINGLET_SIMD {

// Calls work(from), work(from + 1) … work(to − 1), each with its number as a constant: indices of registers and addresses are
// known to the compiler.
template <int from, int to, class Work> [[gnu::always_inline]] inline void unroll(const Work &work) {
    [&]<int... k>(std::integer_sequence<int, k...>) [[gnu::always_inline]] {
        (work(std::integral_constant<int, from + k>{}), ...);
    }(std::make_integer_sequence<int, to - from>{});
}

} // namespace ringlet::RINGLET_SIMD
