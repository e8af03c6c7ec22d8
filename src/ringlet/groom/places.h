// Search for places on curves whose signed distance to a body is too small.
#pragma once

#include "ringlet/geometry/proximity_grid.h"
#include "ringlet/geometry/solid.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace ringlet {

constexpr double largest_spacing = 3e-3; // [m] largest spacing of samples along a curve
constexpr double least_probe_distance =
    2e-3; // [m] least distance of the proximity grid; above half the spacing, so that no sample is missed

// Tolerances of a groom [m].
struct Allowed {
    double root_depth = 0.0;  // depth in a body
    double root_length = 0.0; // up to this arc length from the root
    double thickness = 0.0;   // least distance of two curves, and of a curve from itself
};

// Signed distances at consecutive samples of a curve, whose spacing is at most twice the distance of the grid. A curve that is
// outside stays outside until a sample is near the surface; so does one whose root is beyond the box around the body. A sample
// close to one of known distance needs no query.
class SurfaceProbe {
public:
    SurfaceProbe(const Solid &body, const ProximityGrid &grid, const Vec3 &root) : body_(body), grid_(grid), known_(root) {
        if (root.allFinite() && !grid.contains(root)) distance_ = 0.0;
    }

    // Whether the signed distance of a place is below `most` [m], at most the distance of the grid; then `above` holds it.
    bool below(const Vec3 &place, double most, SignedDistance &above) {
        constexpr double infinite = std::numeric_limits<double>::infinity();
        const bool outside = distance_ >= 0.0;
        if (outside && !grid_.may_be_near(place)) return false;
        if (distance_ - (place - known_).norm() > most) return false;
        const double reach = outside ? 2.0 * grid_.distance() : infinite;
        above = body_.signed_distance(place, reach, outside ? near_ : -1);
        near_ = above.triangle;
        known_ = place;
        distance_ = near_ >= 0 ? above.distance : outside ? reach : -infinite; // a place that is not finite counts as outside
        return near_ >= 0 && distance_ < most;
    }

private:
    const Solid &body_;
    const ProximityGrid &grid_;
    Vec3 known_; // a place, and a lower bound on its distance
    double distance_ = -std::numeric_limits<double>::infinity();
    int near_ = -1;
};

// Calls found(k, at, along, place, above) for each sample of a curve whose signed distance is below floor(along) ≤ most [m].
// The sample lies at the fraction `at` between points k and k + 1, at the arc length `along` from the root [m]. All points but
// the root are samples, with more between them.
template <class Floor, class Found>
void find_below(View<Vec3> points, const Solid &body, const ProximityGrid &grid, double most, const Floor &floor,
                const Found &found) {
    constexpr double spacing = 5e-4; // [m]
    constexpr double max_pieces = 100.0;
    SurfaceProbe probe(body, grid, points[0]);
    double length_before = 0.0;
    for (size_t k = 0; k + 1 < points.size(); ++k) {
        const Vec3 edge = points[k + 1] - points[k];
        const double length = edge.norm();
        const int pieces = static_cast<int>(std::clamp(std::ceil(length / spacing), 1.0, max_pieces));
        for (int i = 1; i <= pieces; ++i) {
            const double at = static_cast<double>(i) / pieces, along = length_before + at * length;
            const Vec3 place = points[k] + at * edge;
            SignedDistance above;
            if (probe.below(place, most, above) && above.distance < floor(along)) found(k, at, along, place, above);
        }
        length_before += length;
    }
}

} // namespace ringlet
