// Contact material: stiffness and friction of every vertex of the collision mesh.
#pragma once

#include <vector>

namespace ringlet {

struct ContactMaterial {
    std::vector<double> stiffness;      // per vertex, between strands [N/m]; infinite where the motion is prescribed
    std::vector<double> firm_stiffness; // per vertex, where a cloth or a body takes part [N/m]
    std::vector<int> material;          // per vertex: row of `friction`
    std::vector<double> friction;       // μ of each pair of materials, row-major, materials × materials
    int materials = 1;
    double stick_length = 0.0; // [m]

    double friction_of(int vertex, int other) const { return friction[material[vertex] * materials + material[other]]; }
};

} // namespace ringlet
