#include "ringlet/live/shared_velocities.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace ringlet {
namespace {

constexpr double most_corners = 1 << 22; // a box of hair has some thousands

} // namespace

VelocityGrid::VelocityGrid(const Vec3 &low, const Vec3 &high, double cell) : low_(low), cell_(cell) {
    double corners = 1;
    for (int k = 0; k < 3; ++k) {
        const double cells = std::ceil((high[k] - low[k]) / cell);
        corners *= cells + 1;
        if (!(cells >= 1 && corners <= most_corners)) throw std::invalid_argument("velocity grid: too many cells, or none");
        count_[k] = int(cells) + 1;
    }
    corners_.resize(size_t(corners));
}

VelocityGrid::Place VelocityGrid::locate(const Vec3 &groomed) const {
    Place place{0, (groomed - low_) / cell_};
    for (int k = 0; k < 3; ++k) {
        const double cell = std::floor(place.within[k]);
        if (!(cell >= 0 && cell < count_[k] - 1)) return {-1, {}};
        place.corner = place.corner * count_[k] + int(cell);
        place.within[k] -= cell;
    }
    return place;
}

template <class Work> void VelocityGrid::for_corners(const Place &place, const Work &work) const {
    const int stride[3] = {count_[1] * count_[2], count_[2], 1};
    for (int which = 0; which < 8; ++which) {
        double weight = 1;
        int corner = place.corner;
        for (int k = 0; k < 3; ++k) {
            const bool upper = which >> k & 1;
            weight *= upper ? place.within[k] : 1 - place.within[k];
            corner += upper * stride[k];
        }
        work(corner, weight);
    }
}

void VelocityGrid::share(View<Vec3> positions, View<double> masses, View<unsigned char> held, const Pose &from, const Pose &to,
                         double dt, const Sharing &sharing, std::span<Vec3> velocities) {
    const size_t n = positions.size();
    if (masses.size() != n || held.size() != n || velocities.size() != n)
        throw std::invalid_argument("velocity grid: arrays do not fit one another");
    std::fill(corners_.begin(), corners_.end(), Corner{0, Vec3::Zero()});
    places_.resize(n);
    relative_.resize(n);
    for (size_t i = 0; i < n; ++i) {
        const Vec3 groomed = to.to_groom(positions[i]);
        places_[i] = locate(groomed);
        const Vec3 of_head = (positions[i] - from.to_world(groomed)) / dt;
        relative_[i] = held[i] ? Vec3::Zero() : Vec3(to.rotation.transpose() * (velocities[i] - of_head));
        if (places_[i].corner < 0) continue;
        for_corners(places_[i], [&](int corner, double weight) {
            corners_[corner].mass += weight * masses[i];
            corners_[corner].velocity += weight * masses[i] * relative_[i];
        });
    }
    for (Corner &corner : corners_)
        if (corner.mass > 0) corner.velocity /= corner.mass;
    for (size_t i = 0; i < n; ++i) {
        if (held[i] || places_[i].corner < 0) continue;
        Vec3 mean = Vec3::Zero();
        for_corners(places_[i], [&](int corner, double weight) { mean += weight * corners_[corner].velocity; });
        velocities[i] += to.rotation * (sharing.share * (sharing.keep * mean - relative_[i]));
    }
}

} // namespace ringlet
