// A prescribed motion: where the bodies, roots and pins of a scene go in a step, and the map of space that they make.
#pragma once

#include "ringlet/geometry/rigid_motion.h"
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

// The map of space that a prescribed motion makes: between bodies, what is near one moves along with it.
// Patches of bodies, and of the pins of cloths, move as rigidly as they can, and the space between them by inverse-distance
// weights (Shepard 1968). The map is continuous: as long as bodies do not come much closer to one another, nothing meets on it,
// even where what follows one body rigidly would run into another.
class SpaceMap {
public:
    explicit SpaceMap(const PrescribedMotion &motion);

    Vec3 operator()(const Vec3 &point) const;

private:
    struct Patch {
        std::vector<int> vertices;
        RigidMotion motion; // from their middle
    };
    std::vector<Patch> patches_;
};

} // namespace ringlet
