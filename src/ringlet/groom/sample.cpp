#include "ringlet/groom/sample.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <queue>
#include <unordered_map>

namespace ringlet {
namespace {

// Hash grid of points; the neighbours of a point are in the 27 cubes around it.
class Grid {
public:
    Grid(View<Vec3> points, double cell) : points_(points), cell_(cell) {
        for (int i = 0; i < static_cast<int>(points.size()); ++i) cells_[key(cube(points[i]))].push_back(i);
    }

    template <class Visit> void near(int i, Visit visit) const {
        const Eigen::Vector3i centre = cube(points_[i]);
        for (int x = -1; x <= 1; ++x)
            for (int y = -1; y <= 1; ++y)
                for (int z = -1; z <= 1; ++z)
                    if (const auto found = cells_.find(key(centre + Eigen::Vector3i(x, y, z))); found != cells_.end())
                        for (const int j : found->second)
                            if (j != i) visit(j);
    }

private:
    Eigen::Vector3i cube(const Vec3 &p) const { return (p / cell_).array().floor().cast<int>(); }
    static std::uint64_t key(const Eigen::Vector3i &c) {
        return (static_cast<std::uint64_t>(c[0] & 0x1fffff) << 42) | (static_cast<std::uint64_t>(c[1] & 0x1fffff) << 21) |
               static_cast<std::uint64_t>(c[2] & 0x1fffff);
    }
    View<Vec3> points_;
    double cell_;
    std::unordered_map<std::uint64_t, std::vector<int>> cells_;
};

} // namespace

std::vector<int> thin_out(View<Vec3> candidates, double area, int count) {
    const int total = static_cast<int>(candidates.size());
    const double reach =
        2.0 * std::sqrt(area / (2.0 * std::sqrt(3.0) * std::max(count, 1))); // twice the radius of a perfect packing
    const Grid grid(candidates, reach);
    const auto crowding = [&](int i, int j) {
        const double distance = (candidates[i] - candidates[j]).norm();
        const double closeness = distance < reach ? 1.0 - distance / reach : 0.0;
        const double squared = closeness * closeness, fourth = squared * squared;
        return fourth * fourth;
    };

    std::vector<double> weight(total, 0.0);
    for (int i = 0; i < total; ++i) grid.near(i, [&](int j) { weight[i] += crowding(i, j); });
    // Weights only decrease, so an outdated entry returns to the queue with its present weight.
    std::priority_queue<std::pair<double, int>> queue;
    for (int i = 0; i < total; ++i) queue.emplace(weight[i], i);
    std::vector<char> gone(total, 0);
    for (int left = total; left > count;) {
        const double value = queue.top().first;
        const int i = queue.top().second;
        queue.pop();
        if (value > weight[i]) {
            queue.emplace(weight[i], i);
            continue;
        }
        gone[i] = 1;
        --left;
        grid.near(i, [&](int j) {
            if (!gone[j]) weight[j] -= crowding(i, j);
        });
    }
    std::vector<int> kept;
    for (int i = 0; i < total; ++i)
        if (!gone[i]) kept.push_back(i);
    return kept;
}

} // namespace ringlet
