// A prescribed motion: where the bodies, roots and pins of a scene go in a step.
#pragma once

#include "ringlet/scene/vertices.h"

namespace ringlet {

// All vertices where they are, and where those end that are prescribed. A lagging one is not where the step before
// led it.
struct PrescribedMotion {
    const SceneVertices &vertices;
    View<Vec3> start, led, target; // [m]

    bool is_behind(int vertex) const { return start[vertex] != led[vertex]; }

    // Where a point ends that moves along with a prescribed vertex, from where that was led to.
    Vec3 carry(int vertex, const Vec3 &point) const;

    // Whether the prescribed vertices of a range move along with another prescribed vertex.
    bool follow(int begin, int end, int leader) const;

    // For each body a vertex that gives its rigid motion; −1: it deforms.
    std::vector<int> rigid_bodies() const;

    // Whether a body moves by an affine map, such as a rotation or what lies between two of its poses.
    bool moves_affinely(int body) const;
};

} // namespace ringlet
