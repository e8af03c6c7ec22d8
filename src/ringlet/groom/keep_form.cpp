#include "ringlet/groom/keep_form.h"

#include <algorithm>
#include <vector>

namespace ringlet {
namespace {

constexpr double collapsed = 0.1; // fraction of its length below which an edge counts as lost

std::vector<double> arc_lengths(View<Vec3> points) {
    std::vector<double> along(points.size(), 0.0);
    for (size_t k = 1; k < points.size(); ++k) along[k] = along[k - 1] + (points[k] - points[k - 1]).norm();
    return along;
}

} // namespace

void keep_form(View<Vec3> before, double largest_stretch, std::span<Vec3> points) {
    const std::vector<double> wanted = arc_lengths(before), along = arc_lengths(points);
    const double stretch = along.back() / wanted.back();
    if (!(stretch * largest_stretch > 1.0 && stretch < largest_stretch)) { // also one that is not finite
        std::copy(before.begin(), before.end(), points.begin());
        return;
    }
    bool lost = false;
    for (size_t k = 1; k < points.size(); ++k) lost |= along[k] - along[k - 1] < collapsed * (wanted[k] - wanted[k - 1]);
    if (!lost) return;
    const std::vector<Vec3> result(points.begin(), points.end());
    for (size_t k = 1, j = 1; k + 1 < points.size(); ++k) {
        const double at = stretch * wanted[k];
        while (along[j] < at && j + 1 < result.size()) ++j;
        const double edge = along[j] - along[j - 1], t = edge > 0.0 ? (at - along[j - 1]) / edge : 1.0;
        points[k] = result[j - 1] + std::clamp(t, 0.0, 1.0) * (result[j] - result[j - 1]);
    }
}

} // namespace ringlet
