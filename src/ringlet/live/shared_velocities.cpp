#include "ringlet/live/shared_velocities.h"

#include <algorithm>
#include <stdexcept>

namespace ringlet {
namespace {

constexpr double most_corners = 1 << 22; // a box of hair has some thousands

} // namespace

VelocityGrid::VelocityGrid(const Vec3 &low, const Vec3 &high, double cell)
    : grid_(low, high, cell, most_corners), corners_(grid_.size()) {}

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
        const std::optional<UniformGrid::Place> &place = places_[i] = grid_.locate(groomed);
        const Vec3 of_head = (positions[i] - from.to_world(groomed)) / dt;
        relative_[i] = held[i] ? Vec3::Zero() : Vec3(to.rotation.transpose() * (velocities[i] - of_head));
        if (!place) continue;
        grid_.for_corners(*place, [&](size_t corner, double weight, const Vec3 &) {
            corners_[corner].mass += weight * masses[i];
            corners_[corner].velocity += weight * masses[i] * relative_[i];
        });
    }
    for (Corner &corner : corners_)
        if (corner.mass > 0) corner.velocity /= corner.mass;
    for (size_t i = 0; i < n; ++i) {
        const std::optional<UniformGrid::Place> &place = places_[i];
        if (held[i] || !place) continue;
        Vec3 mean = Vec3::Zero();
        grid_.for_corners(*place,
                          [&](size_t corner, double weight, const Vec3 &) { mean += weight * corners_[corner].velocity; });
        velocities[i] += to.rotation * (sharing.share * (sharing.keep * mean - relative_[i]));
    }
}

} // namespace ringlet
