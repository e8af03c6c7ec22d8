// How many points move as one rigid body.
#pragma once

#include "ringlet/math/types.h"

#include <vector>

namespace ringlet {

// A rotation about a place that goes somewhere else.
struct RigidMotion {
    Mat3 turn = Mat3::Identity();
    Vec3 from = Vec3::Zero(), to = Vec3::Zero();

    Vec3 operator()(const Vec3 &point) const { return to + turn * (point - from); }
};

// That of the points `told`, by least squares (Kabsch 1976). Where they leave a rotation open, as about a line, it turns as
// little as may be. Of none: no motion.
RigidMotion mean_motion(const std::vector<int> &told, View<Vec3> start, View<Vec3> end);

// That of most of them: of the half that it is true of, again and again (least trimmed squares, Rousseeuw 1984).
RigidMotion common_motion(std::vector<int> told, View<Vec3> start, View<Vec3> end);

} // namespace ringlet
