// Advection: the first move of a step, in which prescribed vertices arrive and everything moves along with them.
#pragma once

#include "ringlet/scene/vertices.h"
#include "ringlet/solver/configuration.h"

namespace ringlet {

// What the objects of a scene are advected by.
struct Carriers {
    View<int> of_strands; // the body that each strand is rooted in; −1: none. May be empty
    View<int> of_cloths;  // the body that each cloth is pinned to or lies on; −1: none
    Vec3 drift;           // of all cloths where nothing is prescribed [m]
};

// A prescribed motion: all vertices where they are, and where those end that are prescribed.
struct PrescribedMotion {
    const SceneVertices &vertices;
    View<Vec3> start, target;

    // Where a point ends that moves along with a prescribed vertex.
    Vec3 carry(int vertex, const Vec3 &point) const;

    // For each body a vertex that gives its rigid motion; −1: it deforms.
    std::vector<int> rigid_bodies() const;
};

// Advects rigidly: a strand with its root, or with the body that it is rooted in; a cloth with its body, else with the mean
// motion of its prescribed vertices, else with that of all. Sets the ends of dynamic vertices. Returns for each vertex the body
// that it moves along with as one, or beyond these a number of its strand's own where that moves rigidly; −1: none.
std::vector<int> advect_rigidly(const PrescribedMotion &motion, View<int> offsets, const Carriers &carriers,
                                std::vector<Vec3> &end);

// Advects through space: patches of bodies move as rigidly as they can, and the space between them by inverse-distance weights
// (Shepard 1968). The map is continuous: as long as bodies do not come much closer to one another, nothing meets, even where
// what follows one body rigidly would run into another.
void advect_with_space(const PrescribedMotion &motion, std::vector<Vec3> &end);

struct Advected {
    double fraction; // of the step, below 1 where bodies leave no way out
    bool rigidly;    // every strand with its root
};

// Moves the configuration along with the prescribed vertices of `target`, through nothing: rigidly where that leaves a way,
// else through space, and no farther than bodies can move at once.
Advected advect(const SceneVertices &vertices, View<Vec3> target, View<int> offsets, const Carriers &carriers,
                Configuration &configuration, SceneReport &report);

} // namespace ringlet
