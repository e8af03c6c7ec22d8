// Lists that are put together in parallel.
#pragma once

#include <algorithm>
#include <vector>

namespace ringlet {

// What of(begin, end, list) adds to a list for the parts of 0 … count − 1, in this order for any number of threads.
template <class T, class Of> std::vector<T> collect_parts(int count, const Of &of) {
    constexpr int part = 1024;
    const int parts = (count + part - 1) / part;
    std::vector<std::vector<T>> found(parts);
#pragma omp parallel for schedule(dynamic)
    for (int p = 0; p < parts; ++p) of(p * part, std::min(count, (p + 1) * part), found[p]);
    size_t size = 0;
    for (const auto &some : found) size += some.size();
    std::vector<T> all;
    all.reserve(size);
    for (const auto &some : found) all.insert(all.end(), some.begin(), some.end());
    return all;
}

// What of(i, list) adds for each of them.
template <class T, class Of> std::vector<T> collect(int count, const Of &of) {
    return collect_parts<T>(count, [&](int begin, int end, std::vector<T> &list) {
        for (int i = begin; i < end; ++i) of(i, list);
    });
}

} // namespace ringlet
