// Advection: the first move of a step, in which prescribed vertices arrive and everything moves along with them.
#pragma once

#include "ringlet/scene/prescribed_motion.h"
#include "ringlet/solver/configuration.h"

namespace ringlet {

// What the objects of a scene are advected by.
struct Carriers {
    View<int> of_strands; // the body that each strand is rooted in; −1: none. May be empty
    View<int> of_cloths;  // the body that each cloth is pinned to or lies on; −1: none
    View<int> pinned;     // the body that each cloth is pinned to; −1: none
    Vec3 drift;           // of all cloths where nothing is prescribed [m]
};

// Advects rigidly: a strand with its root, or with the body that it is rooted in; a cloth with its body, else with the mean
// motion of its prescribed vertices, else with that of all. Sets the ends of dynamic vertices. Returns for each vertex the body
// that it moves along with as one, or beyond these a number of its strand's own where that moves rigidly; −1: none.
std::vector<int> advect_rigidly(const PrescribedMotion &motion, View<int> offsets, const Carriers &carriers,
                                std::vector<Vec3> &end);

// Advects the configuration with a prescribed motion that starts there, without intersections. Only what has an impact is
// corrected, step by step:
//   1. objects are advected rigidly, and impact zones share one motion;
//   2. objects that still have an impact are advected through space, then the surfaces of bodies a little;
//   3. bodies that move affinely and carry nothing make half of their motion, a quarter, …, none, and wait with the rest;
//   4. what is left is truncated, bodies included.
// Returns the objects that are not where a rigid advection leads them.
std::vector<unsigned char> advect(const PrescribedMotion &motion, View<int> offsets, const Carriers &carriers,
                                  Configuration &configuration, SceneReport &report);

} // namespace ringlet
