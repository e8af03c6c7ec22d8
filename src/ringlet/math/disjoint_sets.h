// Disjoint sets of numbers, each named by its smallest, so that the order of joining has no effect (Tarjan 1975).
#pragma once

#include <algorithm>
#include <numeric>
#include <vector>

namespace ringlet {

class DisjointSets {
public:
    explicit DisjointSets(int count = 0) : parent_(count) { std::iota(parent_.begin(), parent_.end(), 0); }

    int find(int x) {
        while (parent_[x] != x) x = parent_[x] = parent_[parent_[x]];
        return x;
    }

    void join(int a, int b) {
        a = find(a), b = find(b);
        parent_[std::max(a, b)] = std::min(a, b);
    }

private:
    std::vector<int> parent_;
};

} // namespace ringlet
