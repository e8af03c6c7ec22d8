// Many lists in one array, one behind the other.
#pragma once

#include "ringlet/math/types.h"

#include <numeric>
#include <vector>

namespace ringlet {

template <class Item> class Lists {
public:
    Lists() : starts_(1, 0) {}
    // for_items(work) calls work(which list, item) for all there are, each time in the same order, in which they are listed.
    template <class ForItems> Lists(size_t lists, const ForItems &for_items) : starts_(lists + 1, 0) {
        for_items([&](int list, const Item &) { ++starts_[list + 1]; });
        std::partial_sum(starts_.begin(), starts_.end(), starts_.begin());
        items_.resize(starts_.back());
        std::vector<int> next(starts_.begin(), starts_.end() - 1);
        for_items([&](int list, const Item &item) { items_[next[list]++] = item; });
    }

    View<Item> of(int list) const { return {items_.data() + starts_[list], items_.data() + starts_[list + 1]}; }

    // Of all items, numbered through, those of a list.
    int begin(int list) const { return starts_[list]; }
    int end(int list) const { return starts_[list + 1]; }
    const std::vector<Item> &items() const { return items_; }

private:
    std::vector<int> starts_;
    std::vector<Item> items_;
};

} // namespace ringlet
