#include "ringlet/geometry/resample.h"

#include <algorithm>
#include <cmath>

namespace ringlet {

namespace {

// The uniform Catmull–Rom spline through a finely sampled curve, between its points i and i + 1.
Vec3 catmull_rom(View<Vec3> points, size_t i, double t) {
    const size_t last = points.size() - 1;
    const Vec3 &p1 = points[i], &p2 = points[i + 1];
    // Parabolic extrapolation beyond the ends; a linear one would flatten the first and last span.
    const Vec3 p0 = i > 0 ? points[i - 1] : last > 1 ? Vec3(3.0 * p1 - 3.0 * p2 + points[2]) : Vec3(2.0 * p1 - p2);
    const Vec3 p3 = i + 2 <= last ? points[i + 2] : last > 1 ? Vec3(3.0 * p2 - 3.0 * p1 + points[i - 1]) : Vec3(2.0 * p2 - p1);
    return Cubic{p1, 0.5 * (p2 - p0), 0.5 * (2.0 * p0 - 5.0 * p1 + 4.0 * p2 - p3), 0.5 * (3.0 * (p1 - p2) + p3 - p0)}(t);
}

// Chords between points. One that is shorter than a thousandth of their mean counts as that, so that points may coincide.
std::vector<double> chords(View<Vec3> points) {
    std::vector<double> result(points.size() - 1);
    double total = 0.0;
    for (size_t i = 0; i < result.size(); ++i) total += result[i] = (points[i + 1] - points[i]).norm();
    const double least = std::max(1e-3 * total / static_cast<double>(result.size()), 1e-12);
    for (double &chord : result) chord = std::max(chord, least);
    return result;
}

// Derivatives by the chord length at the points, for which second derivatives are continuous, and constant in the two end spans
// (Thomas algorithm).
std::vector<Vec3> slopes(View<Vec3> points, View<double> chord) {
    const size_t last = points.size() - 1;
    const auto secant = [&](size_t i) { return Vec3((points[i + 1] - points[i]) / chord[i]); };
    if (last == 1) return {secant(0), secant(0)};
    std::vector<Vec3> slope(points.size());
    std::vector<double> above(points.size());
    above[0] = 1.0, slope[0] = 2.0 * secant(0);
    for (size_t i = 1; i < last; ++i) {
        const double before = chord[i - 1], after = chord[i], diagonal = 2.0 * (before + after) - after * above[i - 1];
        above[i] = before / diagonal;
        slope[i] = (3.0 * (after * secant(i - 1) + before * secant(i)) - after * slope[i - 1]) / diagonal;
    }
    slope[last] = (2.0 * secant(last - 1) - slope[last - 1]) / (1.0 - above[last - 1]);
    for (size_t i = last; i-- > 0;) slope[i] -= above[i] * slope[i + 1];
    return slope;
}

} // namespace

std::vector<Cubic> spline(View<Vec3> points) {
    const std::vector<double> chord = chords(points);
    const std::vector<Vec3> slope = slopes(points, chord);
    std::vector<Cubic> pieces(chord.size());
    for (size_t i = 0; i < pieces.size(); ++i) {
        const Vec3 edge = points[i + 1] - points[i], start = chord[i] * slope[i], end = chord[i] * slope[i + 1];
        pieces[i] = {points[i], start, 3.0 * edge - 2.0 * start - end, start + end - 2.0 * edge};
    }
    return pieces;
}

void on_spline(View<Vec3> points, View<double> along, std::span<Vec3> result) {
    const std::vector<Cubic> pieces = spline(points);
    std::vector<double> run(points.size(), 0.0);
    for (size_t i = 1; i < run.size(); ++i) run[i] = run[i - 1] + (points[i] - points[i - 1]).norm();
    for (size_t k = 0; k < result.size(); ++k) {
        const auto after = std::upper_bound(run.begin() + 1, run.end() - 1, along[k]);
        const size_t i = static_cast<size_t>(after - run.begin()) - 1;
        const double edge = run[i + 1] - run[i], t = edge > 0.0 ? (along[k] - run[i]) / edge : 0.0;
        const double end = std::clamp(t, 0.0, 1.0);
        const Cubic &piece = pieces[i];
        const Vec3 slope = piece.c1 + end * (2.0 * piece.c2 + 3.0 * end * piece.c3);
        result[k] = piece(end) + (t - end) * slope;
    }
}

void space_evenly(View<Vec3> fine, std::span<Vec3> result) {
    std::vector<double> along(fine.size(), 0.0);
    for (size_t i = 1; i < fine.size(); ++i) along[i] = along[i - 1] + (fine[i] - fine[i - 1]).norm();
    size_t i = 0;
    for (size_t k = 0; k < result.size(); ++k) {
        const double s = along.back() * static_cast<double>(k) / static_cast<double>(result.size() - 1);
        while (i + 2 < fine.size() && along[i + 1] < s) ++i;
        const double edge = along[i + 1] - along[i];
        result[k] = catmull_rom(fine, i, edge > 0.0 ? std::min(1.0, (s - along[i]) / edge) : 0.0);
    }
    result.front() = fine.front();
    result.back() = fine.back();
}

void resample(View<Vec3> points, std::span<Vec3> result) {
    double length = 0.0; // of the chords
    for (size_t i = 1; i < points.size(); ++i) length += (points[i] - points[i - 1]).norm();
    std::vector<Vec3> fine(4 * std::max(points.size(), result.size()));
    std::vector<double> along(fine.size());
    for (size_t k = 0; k < along.size(); ++k)
        along[k] = length * static_cast<double>(k) / static_cast<double>(along.size() - 1);
    on_spline(points, along, fine);
    fine.back() = points.back();
    space_evenly(fine, result);
}

} // namespace ringlet
