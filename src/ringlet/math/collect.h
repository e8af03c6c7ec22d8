// Lists that are filled in parallel, in the same order for any number of threads.
#pragma once

#include "ringlet/math/parallel.h"

#include <algorithm>
#include <vector>

namespace ringlet {

// Replaces `all` by what fill(begin, end, list) appends for consecutive ranges of 0 … count − 1. Its memory stays, which
// costs less than new memory.
template <class T, class Fill>
void collect_ranges_into(std::vector<T> &all, int count, const Fill &fill, LoopSite site = LoopSite::here()) {
    constexpr int range = 1024;
    const int ranges = (count + range - 1) / range;
    if (ranges <= 1) {
        all.clear();
        return fill(0, count, all);
    }
    std::vector<std::vector<T>> lists(ranges);
    parallel_chunks(ranges, 1, [&](int r) { fill(r * range, std::min(count, (r + 1) * range), lists[r]); }, site);
    std::vector<size_t> begins(1, 0);
    for (const std::vector<T> &list : lists) begins.push_back(begins.back() + list.size());
    all.resize(begins.back());
    parallel_for(ranges, [&](int r) { std::copy(lists[r].begin(), lists[r].end(), all.begin() + ptrdiff_t(begins[r])); }, site);
}

template <class T, class Fill> std::vector<T> collect_ranges(int count, const Fill &fill, LoopSite site = LoopSite::here()) {
    std::vector<T> all;
    collect_ranges_into(all, count, fill, site);
    return all;
}

// The same with what fill(i, list) appends for each i.
template <class T, class Fill>
void collect_into(std::vector<T> &all, int count, const Fill &fill, LoopSite site = LoopSite::here()) {
    collect_ranges_into(
        all, count,
        [&](int begin, int end, std::vector<T> &list) {
            for (int i = begin; i < end; ++i) fill(i, list);
        },
        site);
}

template <class T, class Fill> std::vector<T> collect(int count, const Fill &fill, LoopSite site = LoopSite::here()) {
    std::vector<T> all;
    collect_into(all, count, fill, site);
    return all;
}

} // namespace ringlet
