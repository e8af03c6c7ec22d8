// Vertices that begin inside a body: excused from contact with it, pushed out gently, guarded once they are out.
#pragma once

#include "ringlet/collision/mesh.h"
#include "ringlet/solver/lift.h"

#include <utility>
#include <vector>

namespace ringlet {

class Embedded {
public:
    // A body's vertices and triangles (of the collision mesh, counter-clockwise seen from outside), and its object number.
    struct Body {
        int first, count, object;
        std::vector<Triangle> triangles; // indices counted from `first`
    };

    void add(int vertex, const Body &body, CollisionMesh &mesh);
    int count() const { return int(vertices_.size()); }

    // What it remembers of each of them from step to step: the height over the surface where it is to be by now [m].
    std::vector<std::pair<int, double>> heights() const;
    void recall(const std::vector<std::pair<int, double>> &heights, CollisionMesh &mesh); // those that are not named are out

    // Lets go of those that are out by now: they and the edges to their neighbours at the contact distance. The others are to
    // be lifted, as hard as their `stiffness` [N/m] says, to a height that rises by `way` a step, at most to where they touch.
    // Vertices of one strand follow one another; `offsets` are their ranges.
    std::vector<Lift> push_out(CollisionMesh &mesh, View<Vec3> positions, View<int> offsets, View<double> stiffness,
                               double way);

private:
    struct Vertex {
        int vertex, body; // index into bodies_
        double height;    // over the surface, where it is to be by now; rises from step to step [m]
    };
    template <class Out> void let_go(const Out &out, CollisionMesh &mesh); // of those for which out(index) holds
    std::vector<Body> bodies_;
    std::vector<Vertex> vertices_;
};

} // namespace ringlet
