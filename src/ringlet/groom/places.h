// Places on curves that are lower over a body than they may be.
#pragma once

#include "ringlet/geometry/near_cells.h"
#include "ringlet/geometry/solid.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace ringlet {

constexpr double stride = 3e-3; // [m] of places that are looked at along a curve: none gets deeper in unseen
constexpr double band = 2e-3;   // [m] no less far from a surface it is looked up how far: more than half a stride

// What curves may do: how deep they may be in a body [m] up to that far from their root [m], and how near they may come to one
// another and to themselves [m].
struct Allowed {
    double root_depth = 0.0, root_length = 0.0, thickness = 0.0;
};

// Follows a curve from place to place, no farther apart than twice the distance of the cells. What is outside and comes near no
// surface stays outside, and places near to one whose height is known need not be looked up.
class Sounding {
public:
    Sounding(const Solid &body, const NearCells &cells) : body_(body), cells_(cells) {}

    // Whether a place is lower than `most` [m], which is no more than the distance of the cells; then `above` tells.
    bool below(const Vec3 &place, double most, Above &above) {
        constexpr double infinite = std::numeric_limits<double>::infinity();
        const bool outside = height_ >= 0.0;
        if (outside && !cells_.may_be_near(place)) return false;
        if (height_ - (place - known_).norm() > most) return false;
        const double reach = outside ? 2.0 * cells_.distance() : infinite;
        above = body_.above(place, reach, outside ? near_ : -1);
        near_ = above.triangle;
        known_ = place;
        height_ = near_ >= 0 ? above.height : outside ? reach : -infinite; // a place that is not finite is near nothing
        return near_ >= 0 && height_ < most;
    }

private:
    const Solid &body_;
    const NearCells &cells_;
    Vec3 known_ = Vec3::Zero();
    double height_ = -std::numeric_limits<double>::infinity();
    int near_ = -1;
};

// Calls found(k, at, along, place, above) for places on a curve, its points and more between them but for the root: a part `at`
// of the way from point k to the next, `along` from the root [m], where the height is under floor(along) ≤ most [m].
template <class Floor, class Found>
void sound(View<Vec3> points, const Solid &body, const NearCells &cells, double most, const Floor &floor, const Found &found) {
    constexpr double spacing = 5e-4; // [m]
    constexpr double most_pieces = 100.0;
    Sounding sounding(body, cells);
    double run = 0.0;
    for (size_t k = 0; k + 1 < points.size(); ++k) {
        const Vec3 edge = points[k + 1] - points[k];
        const double length = edge.norm();
        const int pieces = static_cast<int>(std::clamp(std::ceil(length / spacing), 1.0, most_pieces));
        for (int i = 1; i <= pieces; ++i) {
            const double at = static_cast<double>(i) / pieces, along = run + at * length;
            const Vec3 place = points[k] + at * edge;
            Above above;
            if (sounding.below(place, most, above) && above.height < floor(along)) found(k, at, along, place, above);
        }
        run += length;
    }
}

} // namespace ringlet
