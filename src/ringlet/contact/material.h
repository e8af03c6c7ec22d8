// Contact material: stiffness and friction of every vertex of the collision mesh, and the stiffness of pairs.
#pragma once

#include "ringlet/contact/stencil.h"

#include <algorithm>
#include <limits>
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

// The stiffness of a pair [N/m]: the lower one of its two primitives. A prescribed vertex of an edge has the stiffness of the
// free one, which would otherwise be pushed without bound.
inline double pair_stiffness(const CollisionMesh &mesh, const Stencil &stencil, const ContactMaterial &material) {
    const bool of_strands = std::max(stencil.vertex[0], stencil.vertex[3]) < int(mesh.along_curve.size());
    const std::vector<double> &stiffness = of_strands ? material.stiffness : material.firm_stiffness;
    const auto of_side = [&](int begin, int end) {
        double softest = std::numeric_limits<double>::infinity(), compliance = 0.0;
        for (int i = begin; i < end; ++i) softest = std::min(softest, stiffness[stencil.vertex[i]]);
        for (int i = begin; i < end; ++i) {
            const double own = stiffness[stencil.vertex[i]];
            compliance += std::abs(stencil.weight[i]) / (std::isfinite(own) ? own : softest);
        }
        return 1.0 / compliance;
    };
    return std::min(of_side(0, stencil.first), of_side(stencil.first, 4));
}

} // namespace ringlet
