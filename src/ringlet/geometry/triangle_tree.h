// BVH of the triangles of a mesh, for closest-point and box queries.
#pragma once

#include "ringlet/geometry/triangle_mesh.h"

#include <limits>
#include <vector>

namespace ringlet {

struct SurfacePoint {
    int triangle = -1; // -1: no point within the distance searched
    Vec3 barycentric = Vec3::Zero();
    Vec3 position = Vec3::Zero();
    double distance = std::numeric_limits<double>::infinity();
};

// Closest point of one triangle to p.
SurfacePoint closest_point(const TriangleMesh &mesh, int triangle, const Vec3 &p);

// Borrows the mesh, which must outlive it.
class TriangleTree {
public:
    TriangleTree(const TriangleMesh &mesh, View<int> triangles); // over these triangles
    explicit TriangleTree(const TriangleMesh &mesh);             // over all triangles

    // Closest point within `within` [m] of p; the first triangle in the order of the tree wins a tie.
    SurfacePoint closest(const Vec3 &p, double within = std::numeric_limits<double>::infinity()) const;
    // Appends to `found` the triangles whose AABBs overlap the box.
    void overlapping(const Vec3 &low, const Vec3 &high, std::vector<int> &found) const;
    const TriangleMesh &mesh() const { return mesh_; }

private:
    struct Node {
        Vec3 low, high;
        int begin, count; // leaf: triangles order_[begin, begin + count); inner (count 0): children next to it and at begin
    };
    struct Sphere { // encloses a triangle
        Vec3 centre;
        double radius;
    };
    void build();
    int build(int begin, int end);

    TriangleMesh mesh_;
    std::vector<int> order_;
    std::vector<Sphere> spheres_; // in this order
    std::vector<Node> nodes_;
};

} // namespace ringlet
