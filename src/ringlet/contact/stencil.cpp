#include "ringlet/contact/stencil.h"

#include <algorithm>
#include <limits>

namespace ringlet {

Stencil stencil(const CollisionMesh &mesh, const ContactPair &pair, const ClosestPoints &closest) {
    Stencil stencil{{}, closest.weights, pair.edge_edge ? 2 : 1};
    with_vertices(mesh, pair, [&](const auto &a, const auto &b) {
        std::copy(b.begin(), b.end(), std::copy(a.begin(), a.end(), stencil.vertex.begin()));
    });
    return stencil;
}

double pair_stiffness(const CollisionMesh &mesh, const Stencil &stencil, const ContactMaterial &material) {
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
