// The way on which a scene goes in an iteration of Newton's method.
#pragma once

#include "ringlet/solver/scene_system.h"

namespace ringlet {

// A part s of its way takes each part of a scene from x to x + s · straight + s² · bend: in the triangle of x, x + straight and
// x + straight + bend.
struct SceneWay {
    AlignedVector straight; // as the linear system has it
    AlignedVector bend;     // what it changes at the end that edges of strands turn instead of getting longer
};

// The largest coordinate of each part's direction [m]; those of parts that are not active stay as they are in `reach`. A part
// whose direction is not finite, its system being too ill-conditioned to solve, stays: its direction becomes zero.
void measure(const SceneSystem &system, AlignedVector &direction, std::vector<double> &reach);

// Per part, how much of its direction from x is worth going.
std::vector<double> worth_going(const SceneSystem &system, const AlignedVector &x, const AlignedVector &direction);

// Every part goes only so much of its way.
void shorten(const SceneSystem &system, const std::vector<double> &parts, SceneWay &way);

// Bends the ways of strands, which are straight, from x.
void bend(const SceneSystem &system, const AlignedVector &x, SceneWay &way);

// These parts go straight.
void straighten(const SceneSystem &system, const std::vector<unsigned char> &parts, SceneWay &way);

// Of units with parts that have `changed`: where so much of their way leads from x.
void move(const SceneSystem &system, const AlignedVector &x, const std::vector<double> &step, const SceneWay &way,
          const std::vector<unsigned char> &changed, AlignedVector &to);

} // namespace ringlet
