// Lists of varying length in one array, with the offset of each (compressed rows).
#pragma once

#include "ringlet/math/types.h"

#include <numeric>
#include <vector>

namespace ringlet {

template <class Item> class Lists {
public:
    Lists() : starts_(1, 0) {}
    // for_items(work) calls work(list, item) for every item. It is called twice and must keep its order.
    template <class ForItems> Lists(size_t lists, const ForItems &for_items) : starts_(lists + 1, 0) {
        for_items([&](int list, const Item &) { ++starts_[list + 1]; });
        std::partial_sum(starts_.begin(), starts_.end(), starts_.begin());
        items_.resize(starts_.back());
        std::vector<int> next(starts_.begin(), starts_.end() - 1);
        for_items([&](int list, const Item &item) { items_[next[list]++] = item; });
    }

    View<Item> of(int list) const { return {items_.data() + starts_[list], items_.data() + starts_[list + 1]}; }

    // Range of a list in items().
    int begin(int list) const { return starts_[list]; }
    int end(int list) const { return starts_[list + 1]; }
    const std::vector<Item> &items() const { return items_; }

private:
    std::vector<int> starts_;
    std::vector<Item> items_;
};

} // namespace ringlet
