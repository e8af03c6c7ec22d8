// Initial penetration: vertices of strands that begin inside a body, and how they come out.
#pragma once

#include "ringlet/collision/mesh.h"
#include "ringlet/solver/objective.h"

#include <utility>
#include <vector>

namespace ringlet {

// Such vertices are exempt from contact with the body and drawn out gently; once outside they are in contact like any other.
class InitialPenetration {
public:
    // The vertices and triangles of a body in the collision mesh, counter-clockwise from outside, and its object.
    struct Body {
        int first, count, object;
        std::vector<Triangle> triangles; // indices counted from `first`
    };

    void add(int vertex, const Body &body, CollisionMesh &mesh);
    int count() const { return int(vertices_.size()); } // of those still inside

    // Ends the exemption of vertices that are outside: they, and the edges to their neighbours, at the contact distance. The
    // others get a spring of their stiffness [N/m] to a height that rises by `length` a step, at most to the contact distance.
    std::vector<RecoverySpring> recover(CollisionMesh &mesh, View<Vec3> positions, View<double> stiffness, double length);

    // What a step remembers: the vertices with the heights over the surface that they are to have reached [m].
    std::vector<std::pair<int, double>> heights() const;
    void recall(const std::vector<std::pair<int, double>> &heights, CollisionMesh &mesh); // others are outside

private:
    struct Vertex {
        int vertex, body; // index into bodies_
        double height;    // that it is to have reached by now [m]
    };
    template <class Outside> void end_exemptions(const Outside &outside, CollisionMesh &mesh); // where outside(index) holds
    std::vector<Body> bodies_;
    std::vector<Vertex> vertices_;
};

} // namespace ringlet
