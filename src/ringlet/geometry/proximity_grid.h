// Grid of the cells within a distance of a mesh. It rejects far points without a closest-point query.
#pragma once

#include "ringlet/geometry/triangle_mesh.h"

#include <vector>

namespace ringlet {

class ProximityGrid {
public:
    ProximityGrid(const TriangleMesh &mesh, double distance);

    double distance() const { return distance_; }

    // Whether a place is in the box around the mesh.
    bool contains(const Vec3 &place) const {
        const Eigen::Array3d at = (place - low_).array() * per_length_;
        return (at >= 0.0).all() && (at < size_.cast<double>()).all();
    }

    // False only if the place is farther from the mesh than distance().
    bool may_be_near(const Vec3 &place) const {
        return contains(place) && near_[index(((place - low_).array() * per_length_).cast<int>())] != 0;
    }

private:
    size_t index(const Eigen::Array3i &cell) const {
        return (static_cast<size_t>(cell[0]) * size_[1] + cell[1]) * size_[2] + cell[2];
    }

    double distance_;
    Vec3 low_ = Vec3::Zero();
    double per_length_ = 1.0;
    Eigen::Array3i size_ = Eigen::Array3i::Zero();
    std::vector<unsigned char> near_;
};

} // namespace ringlet
