#include "ringlet/geometry/centre_line.h"

#include <algorithm>
#include <vector>

namespace ringlet {
namespace {

// Means over 2 half + 1 points, of which the outer two have half a weight, so that they span 2 half spacings.
void means(View<Vec3> points, int half, std::span<Vec3> result) {
    const int n = static_cast<int>(points.size());
    std::vector<Vec3> sum(n + 1, Vec3::Zero()); // of the first points, from the root
    for (int i = 0; i < n; ++i) sum[i + 1] = sum[i] + (points[i] - points[0]);
    const auto total = [&](int begin, int end) { return Vec3(sum[end] - sum[begin]); };
    for (int i = half; i + half < n; ++i)
        result[i] = points[0] + (total(i - half, i + half) + total(i - half + 1, i + half + 1)) / (4.0 * half);
    const int first = half, last = n - 1 - half, over = std::min(half, last - first);
    const Vec3 start = (result[first + over] - result[first]) / over, end = (result[last] - result[last - over]) / over;
    for (int i = 0; i < first; ++i) result[i] = result[first] - (first - i) * start;
    for (int i = last + 1; i < n; ++i) result[i] = result[last] + (i - last) * end;
}

} // namespace

void centre_line(View<Vec3> points, int window, std::span<Vec3> result) {
    const int n = static_cast<int>(points.size()), half = std::min((window + 1) / 2, n / 3);
    if (window < 2 || half < 1) {
        std::ranges::copy(points, result.begin());
        return;
    }
    std::vector<Vec3> once(points.size());
    means(points, half, once);
    means(once, half, result);
}

} // namespace ringlet
