// Lists that are put together in parallel.
#pragma once

#include <algorithm>
#include <vector>

namespace ringlet {

// What of(i, list) adds to a list for i = 0 … count − 1, in this order for any number of threads.
template <class T, class Of> std::vector<T> collect(int count, const Of &of) {
    constexpr int chunk = 1024;
    const int chunks = (count + chunk - 1) / chunk;
    std::vector<std::vector<T>> found(chunks);
#pragma omp parallel for schedule(dynamic)
    for (int c = 0; c < chunks; ++c)
        for (int i = c * chunk; i < std::min(count, (c + 1) * chunk); ++i) of(i, found[c]);
    size_t size = 0;
    for (const auto &part : found) size += part.size();
    std::vector<T> all;
    all.reserve(size);
    for (const auto &part : found) all.insert(all.end(), part.begin(), part.end());
    return all;
}

} // namespace ringlet
