// Copies of long arrays, which threads make together: new memory is slow until it is touched.
#pragma once

#include "ringlet/math/aligned.h"
#include "ringlet/math/parallel.h"

#include <algorithm>
#include <vector>

namespace ringlet {

template <class T> void parallel_copy_n(const T *from, size_t count, T *to) {
    constexpr size_t range = 1 << 14;
    parallel_for(int((count + range - 1) / range), [&](int r) {
        const size_t begin = size_t(r) * range;
        std::copy_n(from + begin, std::min(range, count - begin), to + begin);
    });
}

template <class T> void parallel_copy(const std::vector<T> &from, std::vector<T> &to) {
    to.resize(from.size());
    parallel_copy_n(from.data(), from.size(), to.data());
}

template <class T> std::vector<T> parallel_copy(const std::vector<T> &from) {
    std::vector<T> same;
    parallel_copy(from, same);
    return same;
}

inline AlignedVector parallel_copy(const AlignedVector &from) {
    AlignedVector same = AlignedVector::unset(from.size());
    parallel_copy_n(from.data(), from.size(), same.data());
    return same;
}

} // namespace ringlet
