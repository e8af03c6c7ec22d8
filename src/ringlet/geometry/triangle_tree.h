// The triangles of a mesh in a BVH, for closest-point and box queries.
#pragma once

#include "ringlet/geometry/bvh.h"
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
    TriangleTree(const TriangleMesh &mesh, std::vector<int> triangles); // over these triangles
    explicit TriangleTree(const TriangleMesh &mesh);                    // over all triangles

    // Closest point within `within` [m] of p; of triangles at the same distance the first.
    SurfacePoint closest(const Vec3 &p, double within = std::numeric_limits<double>::infinity()) const;
    // Appends to `found` the triangles whose AABBs overlap the box.
    void overlapping(const Vec3 &low, const Vec3 &high, std::vector<int> &found) const;
    const TriangleMesh &mesh() const { return mesh_; }

private:
    std::array<Vec3, 2> bounds(int triangle) const;

    TriangleMesh mesh_;
    std::vector<int> triangles_;
    Bvh tree_;
};

} // namespace ringlet
