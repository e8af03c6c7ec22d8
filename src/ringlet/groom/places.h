// Places on curves that are lower over a body than they may be.
#pragma once

#include "ringlet/geometry/solid.h"

#include <algorithm>
#include <cmath>

namespace ringlet {

// What curves may do: how deep they may be in a body [m] up to that far from their root [m], and how near they may come to one
// another and to themselves [m].
struct Allowed {
    double root_depth = 0.0, root_length = 0.0, thickness = 0.0;
};

// Follows a curve, and remembers how far it is to the body from where that was last looked up: places nearer to there need not
// be looked up again.
class Sounding {
public:
    explicit Sounding(const Solid &body) : body_(body) {}

    // Whether a place may be lower than `most` [m]; then `above` tells.
    bool below(const Vec3 &place, double most, Above &above) {
        const double moved = (place - known_).norm();
        if (height_ - moved > most) return false;
        above = body_.above(place, height_ > 0.0 ? 1.001 * (height_ + moved) : std::numeric_limits<double>::infinity(), near_);
        near_ = above.triangle;
        known_ = place;
        height_ = near_ < 0 ? -std::numeric_limits<double>::infinity() : above.height;
        return height_ < most;
    }

private:
    const Solid &body_;
    Vec3 known_ = Vec3::Zero();
    double height_ = -std::numeric_limits<double>::infinity();
    int near_ = -1;
};

// Calls found(k, at, along, place, above) for places on a curve, its points and more between them but for the root: a part `at`
// of the way from point k to the next, `along` from the root [m], where the height is under floor(along) ≤ most [m].
template <class Floor, class Found>
void sound(View<Vec3> points, const Solid &body, double most, const Floor &floor, const Found &found) {
    constexpr double spacing = 5e-4; // [m]
    constexpr double most_pieces = 100.0;
    Sounding sounding(body);
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
