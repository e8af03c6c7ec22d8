// The sides of triangles, edge by edge.
#pragma once

#include "ringlet/math/types.h"

#include <vector>

namespace ringlet {

// A side of a triangle, from one point to the next. Points at one place may have one number.
struct Side {
    int low, high;          // numbers of both ends
    int triangle, opposite; // opposite corner, 0 to 2
    int from, to;           // points
    bool rises;             // from low to high
};

// All sides in the order of their numbers and triangles. `number` has those of points, which are below `numbers`.
std::vector<Side> sides_by_edge(View<Triangle> triangles, View<int> number, int numbers);

// Calls work(sides) with those of each edge.
template <class Work> void for_edges(View<Side> sides, const Work &work) {
    for (size_t first = 0, last; first < sides.size(); first = last) {
        for (last = first + 1;
             last < sides.size() && sides[last].low == sides[first].low && sides[last].high == sides[first].high;)
            ++last;
        work(sides.subspan(first, last - first));
    }
}

} // namespace ringlet
