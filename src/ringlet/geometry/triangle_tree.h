// The closest point of a triangle mesh, by a hierarchy of boxes.
#pragma once

#include "ringlet/geometry/triangle_mesh.h"

#include <limits>
#include <vector>

namespace ringlet {

struct SurfacePoint {
    int triangle = -1; // -1: nothing within the distance asked for
    Vec3 barycentric = Vec3::Zero();
    Vec3 position = Vec3::Zero();
    double distance = std::numeric_limits<double>::infinity();
};

// The point of one triangle nearest to p.
SurfacePoint closest_point(const TriangleMesh &mesh, int triangle, const Vec3 &p);

// Borrows the mesh, which must outlive it.
class TriangleTree {
public:
    TriangleTree(const TriangleMesh &mesh, View<int> triangles); // searches these triangles only
    explicit TriangleTree(const TriangleMesh &mesh);             // searches all

    // The nearest point within `within` of p; the first triangle in the tree's order wins a tie.
    SurfacePoint closest(const Vec3 &p, double within = std::numeric_limits<double>::infinity()) const;
    // Adds to `found` the triangles of which the boxes meet this one.
    void overlapping(const Vec3 &low, const Vec3 &high, std::vector<int> &found) const;
    const TriangleMesh &mesh() const { return mesh_; }

private:
    struct Node {
        Vec3 low, high;
        int begin, count; // leaf: triangles order_[begin, begin + count); inner (count 0): children next to it and at begin
    };
    int build(int begin, int end);

    TriangleMesh mesh_;
    std::vector<int> order_;
    std::vector<Node> nodes_;
};

} // namespace ringlet
