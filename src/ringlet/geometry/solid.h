// Signed distance to a triangle mesh, negative inside.
#pragma once

#include "ringlet/geometry/proximity_grid.h"
#include "ringlet/geometry/triangle_tree.h"

#include <memory>
#include <mutex>
#include <vector>

namespace ringlet {

struct SignedDistance {
    int triangle = -1;                 // of the closest point; -1: no point within the distance searched
    Vec3 closest = Vec3::Zero();       // closest point of the surface
    Vec3 normal = Vec3::Zero();        // outward pseudonormal there, of length 1
    Vec3 smooth_normal = Vec3::Zero(); // interpolated from the corners, continuous from triangle to triangle
    double distance = std::numeric_limits<double>::infinity(); // [m], negative inside
};

// The sign is that of the angle-weighted pseudonormal of the face, edge or corner that holds the closest point. It is exact on
// a closed mesh (Bærentzen and Aanæs, "Signed distance computation using the angle weighted pseudonormal", TVCG 11(3), 2005).
// Places whose closest point lies on the rim of an open mesh are outside.
class Solid {
public:
    explicit Solid(const TriangleMesh &mesh); // keeps a copy
    Solid(const Solid &) = delete;            // members borrow from one another
    Solid &operator=(const Solid &) = delete;

    // `hint`: a triangle that is probably near; it bounds the search.
    SignedDistance signed_distance(const Vec3 &place, double within = std::numeric_limits<double>::infinity(),
                                   int hint = -1) const;
    const TriangleMesh &mesh() const { return mesh_; }

    // The cells within a distance of the surface. The last grid is kept: curves are held out of one body again and again.
    std::shared_ptr<const ProximityGrid> cells_within(double distance) const;

private:
    // Pseudonormals of one triangle; edge k is opposite corner k.
    struct Normals {
        Vec3 face, edge[3];
        bool open_edge[3];
    };
    void find_edges();

    std::vector<Vec3> points_;
    std::vector<Triangle> triangles_;
    TriangleMesh mesh_;
    TriangleTree tree_;
    std::vector<Normals> normals_;
    std::vector<Vec3> corners_; // pseudonormals of the points
    std::vector<char> open_;    // whether a point is on the rim
    mutable std::mutex grid_in_use_;
    mutable std::shared_ptr<const ProximityGrid> grid_;
};

} // namespace ringlet
