#include "ringlet/geometry/sides.h"

#include "ringlet/math/lists.h"

#include <algorithm>

namespace ringlet {

// Lists keep the order of their items: a radix sort.
std::vector<Side> sides_by_edge(View<Triangle> triangles, View<int> number, int numbers) {
    const Lists<Side> by_high(numbers, int(triangles.size()), [&](int t, const auto &add) {
        for (int k = 0; k < 3; ++k) {
            const int from = triangles[t][k], to = triangles[t][(k + 1) % 3], a = number[from], b = number[to];
            add(std::max(a, b), Side{std::min(a, b), std::max(a, b), t, (k + 2) % 3, from, to, a < b});
        }
    });
    const std::vector<Side> &sides = by_high.items();
    return Lists<Side>(numbers, int(sides.size()), [&](int k, const auto &add) { add(sides[k].low, sides[k]); }).items();
}

} // namespace ringlet
