#include "ringlet/geometry/sides.h"

#include "ringlet/math/lists.h"

#include <algorithm>

namespace ringlet {

// Lists keep the order of their items: a radix sort.
std::vector<Side> sides_by_edge(View<Triangle> triangles, View<int> number, int numbers) {
    const Lists<Side> by_high(numbers, [&](const auto &work) {
        for (int t = 0; t < int(triangles.size()); ++t)
            for (int k = 0; k < 3; ++k) {
                const int from = triangles[t][k], to = triangles[t][(k + 1) % 3], a = number[from], b = number[to];
                work(std::max(a, b), Side{std::min(a, b), std::max(a, b), t, (k + 2) % 3, from, to, a < b});
            }
    });
    return Lists<Side>(numbers,
                       [&](const auto &work) {
                           for (const Side &side : by_high.items()) work(side.low, side);
                       })
        .items();
}

} // namespace ringlet
