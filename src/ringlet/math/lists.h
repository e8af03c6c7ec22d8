// Lists of varying length in one array, with the offset of each (compressed rows).
#pragma once

#include "ringlet/math/parallel.h"
#include "ringlet/math/types.h"

#include <algorithm>
#include <array>
#include <memory>
#include <numeric>
#include <utility>
#include <vector>

namespace ringlet {

template <class Item> class Lists {
public:
    Lists() : starts_(1, 0) {}
    // each(k, add) calls add(list, item) for what k = 0 … count − 1 has to add. It is called twice; lists keep that order.
    template <class Each> Lists(size_t lists, int count, const Each &each) : Lists(lists, count, each, size_t(count)) {}

    // The same where the items are about `size`.
    template <class Each> Lists(size_t lists, int count, const Each &each, size_t size) : starts_(lists + 1, 0) {
        if (size >= worth_threads) {
            sort_in_parallel(int(lists), count, each);
            return;
        }
        for (int k = 0; k < count; ++k) each(k, [&](int list, const Item &) { ++starts_[list + 1]; });
        std::partial_sum(starts_.begin(), starts_.end(), starts_.begin());
        items_.resize(starts_.back());
        std::vector<int> next(starts_.begin(), starts_.end() - 1);
        for (int k = 0; k < count; ++k) each(k, [&](int list, const Item &item) { items_[next[list]++] = item; });
    }

    View<Item> of(int list) const { return {items_.data() + starts_[list], items_.data() + starts_[list + 1]}; }

    // Range of a list in items().
    int begin(int list) const { return starts_[list]; }
    int end(int list) const { return starts_[list + 1]; }
    const std::vector<Item> &items() const { return items_; }

private:
    static constexpr size_t worth_threads = 1 << 16;
    static constexpr int parts = 64;

    // A radix sort of two passes: of ranges of k into bins of consecutive lists, then within bins. Both are parallel, since no
    // part writes where another does.
    template <class Each> void sort_in_parallel(int lists, int count, const Each &each) {
        const int lists_of_bin = lists / parts + 1;
        const auto for_range = [&](int range, const auto &add) {
            const int end = int(int64_t(count) * (range + 1) / parts);
            for (int k = int(int64_t(count) * range / parts); k < end; ++k) each(k, add);
        };
        using Places = std::array<int, parts>;
        std::vector<Places> places(parts); // of the first entry of each range in each bin
        parallel_for(parts, [&](int range) {
            Places sizes{};
            for_range(range, [&](int list, const Item &) { ++sizes[list / lists_of_bin]; });
            places[range] = sizes;
        });
        int total = 0;
        std::array<int, parts + 1> begins;
        for (int bin = 0; bin < parts; ++bin) {
            begins[bin] = total;
            for (Places &of : places) total += std::exchange(of[bin], total);
        }
        begins[parts] = total;
        struct Entry {
            int list;
            Item item;
        };
        const std::unique_ptr<Entry[]> entries(new Entry[total]); // not set to 0
        items_.resize(total);
        parallel_for(parts, [&](int range) {
            Places next = places[range];
            for_range(range, [&](int list, const Item &item) { entries[next[list / lists_of_bin]++] = {list, item}; });
        });
        parallel_for(parts, [&](int bin) {
            const int first = bin * lists_of_bin, last = std::min(first + lists_of_bin, lists);
            if (first >= last) return;
            std::vector<int> next(last - first + 1, 0);
            for (int e = begins[bin]; e < begins[bin + 1]; ++e) ++next[entries[e].list - first + 1];
            next[0] = begins[bin];
            std::partial_sum(next.begin(), next.end(), next.begin());
            std::copy(next.begin() + 1, next.end(), starts_.begin() + first + 1);
            for (int e = begins[bin]; e < begins[bin + 1]; ++e) items_[next[entries[e].list - first]++] = entries[e].item;
        });
    }

    std::vector<int> starts_;
    std::vector<Item> items_;
};

} // namespace ringlet
