// A triangle mesh as a solid: how deep inside or how high above it a place is.
#pragma once

#include "ringlet/geometry/triangle_tree.h"

#include <vector>

namespace ringlet {

struct Above {
    int triangle = -1;          // of the nearest place; -1: nothing within the distance asked for
    Vec3 foot = Vec3::Zero();   // that place
    Vec3 normal = Vec3::Zero(); // outward there, of length 1: the pseudonormal
    Vec3 smooth = Vec3::Zero(); // the same, interpolated from the corners: it changes from triangle to triangle without a jump
    double height = std::numeric_limits<double>::infinity(); // [m], negative inside
};

// Whether a place is inside is told by the angle-weighted pseudonormal of the face, edge or corner that it is nearest to
// (Bærentzen and Aanæs, "Signed distance computation using the angle weighted pseudonormal", TVCG 11(3), 2005), which never
// errs on a closed mesh. Beyond the rim of an open one nothing is inside.
class Solid {
public:
    explicit Solid(const TriangleMesh &mesh); // keeps a copy
    Solid(const Solid &) = delete;            // what it holds borrows from itself
    Solid &operator=(const Solid &) = delete;

    // `near`: a triangle that may be the nearest, to begin with.
    Above above(const Vec3 &place, double within = std::numeric_limits<double>::infinity(), int near = -1) const;
    const TriangleMesh &mesh() const { return mesh_; }

private:
    // Of one triangle. Those of edges are opposite each corner.
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
    std::vector<Vec3> corners_; // normals of the points
    std::vector<char> open_;    // whether a point is on the rim
};

} // namespace ringlet
