#include "ringlet/geometry/near_segments.h"

#include "ringlet/geometry/distance.h"
#include "ringlet/geometry/overlaps.h"

#include <algorithm>

namespace ringlet {

std::vector<std::array<int, 2>> near_segments(const CurveView &curves, View<double> radius, double along) {
    const View<Vec3> &p = curves.points;
    std::vector<int> segments, curve(p.size());
    std::vector<double> arc_length(p.size(), 0.0); // from the root to each point [m]
    for (int i = 0; i < curves.count(); ++i)
        for (int k = curves.offsets[i]; k < curves.offsets[i + 1]; ++k) {
            curve[k] = i;
            if (k == curves.offsets[i]) continue;
            arc_length[k] = arc_length[k - 1] + (p[k] - p[k - 1]).norm();
            if (p[k - 1].allFinite() && p[k].allFinite()) segments.push_back(k - 1);
        }
    Bvh tree;
    tree.fit(static_cast<int>(segments.size()), [&](int i) {
        const Vec3 &a = p[segments[i]], &b = p[segments[i] + 1], half = Vec3::Constant(radius[segments[i]]);
        return SweptBox::around(a.cwiseMin(b) - half, a.cwiseMax(b) + half);
    });
    std::vector<std::array<int, 2>> result;
    if (tree.empty()) return result;

    const std::vector<NodePair> starts = split(tree, tree, true);
#pragma omp parallel
    {
        std::vector<std::array<int, 2>> found;
        Traversal here = traversal(tree, tree, true);
#pragma omp for schedule(dynamic, 1) nowait
        for (size_t task = 0; task < starts.size(); ++task)
            descend(here, starts[task], [&] {
                for (int n = 0; n < here.found; ++n) {
                    const int i = segments[tree.primitive(here.boxes[n].of[0])];
                    const int j = segments[tree.primitive(here.boxes[n].of[1])];
                    const int a = std::min(i, j), b = std::max(i, j);
                    const double touching = radius[a] + radius[b];
                    if (curve[a] == curve[b] && (b - a < 2 || arc_length[b] - arc_length[a + 1] <= along * touching)) continue;
                    if (closest_edge_edge(p[a], p[a + 1], p[b], p[b + 1]).distance2 < touching * touching)
                        found.push_back({a, b});
                }
            });
#pragma omp critical
        result.insert(result.end(), found.begin(), found.end());
    }
    std::sort(result.begin(), result.end());
    return result;
}

} // namespace ringlet
