#include "ringlet/geometry/resample.h"

#include <algorithm>
#include <cmath>

namespace ringlet {

Cubic spline_piece(View<Vec3> points, int i) {
    const int last = static_cast<int>(points.size()) - 1;
    const Vec3 &p1 = points[i], &p2 = points[i + 1];
    // Parabolic extrapolation beyond the ends; a linear one would flatten the first and last span.
    const Vec3 p0 = i > 0 ? points[i - 1] : last > 1 ? Vec3(3.0 * p1 - 3.0 * p2 + points[2]) : Vec3(2.0 * p1 - p2);
    const Vec3 p3 = i + 2 <= last ? points[i + 2] : last > 1 ? Vec3(3.0 * p2 - 3.0 * p1 + points[i - 1]) : Vec3(2.0 * p2 - p1);
    return {p1, 0.5 * (p2 - p0), 0.5 * (2.0 * p0 - 5.0 * p1 + 4.0 * p2 - p3), 0.5 * (3.0 * (p1 - p2) + p3 - p0)};
}

Vec3 spline(View<Vec3> points, double at) {
    const int i = std::clamp(static_cast<int>(at), 0, static_cast<int>(points.size()) - 2);
    return spline_piece(points, i)(at - i);
}

void space_evenly(View<Vec3> fine, std::span<Vec3> result) {
    std::vector<double> along(fine.size(), 0.0);
    for (size_t i = 1; i < fine.size(); ++i) along[i] = along[i - 1] + (fine[i] - fine[i - 1]).norm();
    size_t i = 0;
    for (size_t k = 0; k < result.size(); ++k) {
        const double s = along.back() * static_cast<double>(k) / static_cast<double>(result.size() - 1);
        while (i + 2 < fine.size() && along[i + 1] < s) ++i;
        const double edge = along[i + 1] - along[i];
        result[k] = spline(fine, static_cast<double>(i) + (edge > 0.0 ? std::min(1.0, (s - along[i]) / edge) : 0.0));
    }
    result.front() = fine.front();
    result.back() = fine.back();
}

void resample(View<Vec3> points, std::span<Vec3> result) {
    const size_t fine_count = 4 * std::max(points.size(), result.size());
    std::vector<Vec3> fine(fine_count);
    const double last = static_cast<double>(points.size() - 1);
    for (size_t k = 0; k < fine_count; ++k)
        fine[k] = spline(points, last * static_cast<double>(k) / static_cast<double>(fine_count - 1));
    fine.back() = points.back();
    space_evenly(fine, result);
}

} // namespace ringlet
