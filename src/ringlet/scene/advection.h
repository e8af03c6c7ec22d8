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

// Begins a step of the configuration, and advects it with a prescribed motion that starts there, without intersections. Strands
// are advected rigidly with their root or with the body that they are rooted in, cloths with their body or their pins. The
// motion that most have in common is the frame in which the step begins. What moves otherwise may have impacts, and is
// corrected step by step:
//   1. impact zones share one motion;
//   2. objects that still have an impact are advected through space, then the surfaces of bodies a little;
//   3. bodies that move affinely and carry nothing make half of their motion, a quarter, …, none, and wait with the rest;
//   4. what is left is truncated, bodies included.
// Returns the objects that are not where a rigid advection leads them.
std::vector<unsigned char> advect(const PrescribedMotion &motion, const Carriers &carriers, Configuration &configuration,
                                  SceneReport &report);

} // namespace ringlet
