// Grid of the cells within a distance of a mesh. It rejects far points without a closest-point query: with queries of the tree
// alone, which look as far as pays, a groom after a slider takes 18 % more instructions.
#pragma once

#include "ringlet/geometry/triangle_mesh.h"

#include <vector>

namespace ringlet {

class ProximityGrid {
public:
    ProximityGrid(const TriangleMesh &mesh, double distance);

    double distance() const { return distance_; }

    // Whether a place is in the box around the mesh.
    bool contains(const Vec3 &place) const { return is_inside(in_cells(place)); }

    // False only if the place is farther from the mesh than distance().
    bool may_be_near(const Vec3 &place) const {
        const Eigen::Array3d at = in_cells(place);
        return is_inside(at) && near_[index(at.cast<int>())] != 0;
    }

private:
    Eigen::Array3d in_cells(const Vec3 &place) const { return (place - low_).array() * per_length_; }
    bool is_inside(const Eigen::Array3d &at) const { return (at >= 0.0).all() && (at < size_.cast<double>()).all(); }
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
