// Rigid motion that best fits the motion of a set of points.
#pragma once

#include "ringlet/math/types.h"

#include <vector>

namespace ringlet {

// x ↦ to + turn (x − from).
struct RigidMotion {
    Mat3 rotation = Mat3::Identity();
    Vec3 from = Vec3::Zero(), to = Vec3::Zero();

    Vec3 operator()(const Vec3 &point) const { return to + rotation * (point - from); }
};

// Least-squares fit to `vertices` (Kabsch 1976). A rotation that they leave undetermined, as about a line, is as small as
// possible. Without vertices the motion is the identity.
RigidMotion fit_rigid_motion(const std::vector<int> &vertices, View<Vec3> start, View<Vec3> end);

// Robust fit by least trimmed squares (Rousseeuw 1984): each round fits the half with the smallest residuals again.
RigidMotion fit_rigid_motion_robust(std::vector<int> vertices, View<Vec3> start, View<Vec3> end);

} // namespace ringlet
