// The rigid motion of a head.
#pragma once

#include "ringlet/math/types.h"

namespace ringlet {

// x ↦ R x + t, from the pose in which hair was groomed.
struct Pose {
    Mat3 rotation = Mat3::Identity();
    Vec3 shift = Vec3::Zero(); // [m]

    Vec3 to_world(const Vec3 &groomed) const { return rotation * groomed + shift; }
    Vec3 to_groom(const Vec3 &world) const { return rotation.transpose() * (world - shift); }
};

} // namespace ringlet
