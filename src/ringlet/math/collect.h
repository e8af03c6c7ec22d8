// Lists that are filled in parallel, in the same order for any number of threads.
#pragma once

#include <algorithm>
#include <vector>

namespace ringlet {

// Concatenates what fill(begin, end, list) appends for consecutive ranges of 0 … count − 1.
template <class T, class Fill> std::vector<T> collect_ranges(int count, const Fill &fill) {
    constexpr int range = 1024;
    const int ranges = (count + range - 1) / range;
    std::vector<std::vector<T>> lists(ranges);
#pragma omp parallel for schedule(dynamic) if (ranges > 1)
    for (int r = 0; r < ranges; ++r) fill(r * range, std::min(count, (r + 1) * range), lists[r]);
    size_t size = 0;
    for (const auto &list : lists) size += list.size();
    std::vector<T> all;
    all.reserve(size);
    for (const auto &list : lists) all.insert(all.end(), list.begin(), list.end());
    return all;
}

// Concatenates what fill(i, list) appends for each i.
template <class T, class Fill> std::vector<T> collect(int count, const Fill &fill) {
    return collect_ranges<T>(count, [&](int begin, int end, std::vector<T> &list) {
        for (int i = begin; i < end; ++i) fill(i, list);
    });
}

} // namespace ringlet
