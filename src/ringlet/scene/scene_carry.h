// The first move of a step: what is kinematic goes where it is told, and everything along with it.
#pragma once

#include "ringlet/solver/scene_vertices.h"

namespace ringlet {

struct SceneCarry {
    const SceneVertices &all;
    View<Vec3> start; // where vertices are
    View<Vec3> given; // where those that are kinematic go

    // Where a point ends that goes along with a kinematic vertex.
    Vec3 carried(int vertex, const Vec3 &point) const;

    // The bodies that move rigidly: for each a vertex that says how, else −1.
    std::vector<int> rigid_bodies() const;
};

// What a step's parts go along with.
struct SceneCarriers {
    View<int> of_strands; // the body that each strand is rooted in; −1: none. May be empty
    View<int> of_cloths;  // the body that each cloth is pinned to or lies on; −1: none
    Vec3 drift;           // of all cloths where nothing is kinematic [m]
};

// Says in `to` where the vertices of parts are once they have gone along: a strand with its root, or the body that it is rooted
// in, a cloth with the body that it is pinned to or lies on, else with its held vertices as one, else with the mean of all that
// is kinematic. Returns for each vertex the body that it goes along with as one, or beyond these a number of its strand's own
// where that does; −1: none.
std::vector<int> carry_rigidly(const SceneCarry &carry, View<int> offsets, const SceneCarriers &carriers,
                               std::vector<Vec3> &to);

// The same where bodies part or close in, so that what goes along rigidly with one is in the way of another: space goes along
// with all that is kinematic, patches of bodies as rigidly as they can and what is between them as the nearest do (Shepard
// 1968), and parts with it. That is continuous: as long as bodies do not come much nearer to one another, nothing meets.
void carry_with_space(const SceneCarry &carry, std::vector<Vec3> &to);

} // namespace ringlet
