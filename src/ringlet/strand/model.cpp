#include "ringlet/strand/model.h"

#include "ringlet/rest/resolution.h"
#include "ringlet/rest/rest_shape.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <string>

namespace ringlet {
namespace {

// Per edge of a strand; the two end edges, which have one corner only, take those of their neighbours.
std::vector<ResolutionFactors> resolution_of(const StrandModel &model, int first, int end) {
    std::vector<ResolutionFactors> factors(end - first - 1);
    for (int i = first + 1; i + 2 < end; ++i)
        factors[i - first] = resolution_factors(0.5 * (model.rest_angle[i] + model.rest_angle[i + 1]), model.rest_dihedral[i]);
    if (factors.size() > 2) {
        factors.front() = factors[1];
        factors.back() = factors[factors.size() - 2];
    }
    return factors;
}

} // namespace

StrandModel make_strand_model(View<int> offsets, View<Vec3> rest, View<unsigned char> held, const StrandMaterial &material,
                              const StrandVariation &variation) {
    const int strands = int(offsets.size()) - 1;
    const size_t n = rest.size();
    if (strands < 0 || offsets.front() != 0 || offsets.back() != int(n) || held.size() != n)
        throw std::invalid_argument("strands: offsets, points and held do not fit together");
    for (const View<double> &factor : {variation.radius, variation.stretch, variation.bend, variation.twist, variation.damping})
        if (!factor.empty() && factor.size() != n) throw std::invalid_argument("strands: a variation does not fit the points");

    StrandModel model;
    model.offsets.assign(offsets.begin(), offsets.end());
    model.held.assign(held.begin(), held.end());
    RestShape shape = measure_rest_shape(offsets, rest);
    model.rest_length = std::move(shape.length);
    model.rest_angle = std::move(shape.angle);
    model.rest_dihedral = std::move(shape.dihedral);
    model.rest_normal = std::move(shape.normal);
    model.rest_tangent.assign(n, Vec3::Zero());
    model.mass_damping = material.mass_damping;
    model.stretch_stiffness.assign(n, 0.0);
    model.bend_stiffness.assign(n, 0.0);
    model.twist_stiffness.assign(n, 0.0);
    model.mass.assign(n, 0.0);
    model.drag.assign(n, 0.0);
    model.damping.assign(n, material.damping);

    const auto at = [](View<double> factor, int i) { return factor.empty() ? 1.0 : factor[i]; };
    const auto on_edge = [&at](View<double> factor, int i) { return 0.5 * (at(factor, i) + at(factor, i + 1)); };
    const auto area = [&](double factor) { return std::numbers::pi * std::pow(factor * material.radius, 2); };
    const auto bending = [&](double radius_factor, double bend_factor) { // EI [N m²]
        return bend_factor * material.bend_scale * material.youngs_modulus * std::pow(area(radius_factor), 2) /
               (4 * std::numbers::pi);
    };
    for (int s = 0; s < strands; ++s) {
        const int first = offsets[s], end = offsets[s + 1];
        const std::string name = "strands: strand " + std::to_string(s);
        if (end - first < 3) throw std::invalid_argument(name + " has fewer than 3 vertices");
        if (!held[first]) throw std::invalid_argument(name + " does not hold its root");
        std::vector<ResolutionFactors> factors(end - first - 1);
        if (material.correct_resolution) factors = resolution_of(model, first, end);
        for (int i = first; i + 1 < end; ++i) {
            const double length = model.rest_length[i];
            const ResolutionFactors &factor = factors[i - first];
            if (!(length > 0)) throw std::invalid_argument(name + " has an edge without length");
            model.rest_tangent[i] = (rest[i + 1] - rest[i]) / length;
            const double section = area(on_edge(variation.radius, i));
            model.stretch_stiffness[i] =
                material.stretch_scale * on_edge(variation.stretch, i) * material.youngs_modulus * section / length;
            for (const int vertex : {i, i + 1}) {
                model.mass[vertex] += 0.5 * material.density * section * length * factor.mass;
                model.drag[vertex] += 0.5 * material.drag * length;
            }
            model.damping[i] *= at(variation.damping, i);
            if (i == first) continue;
            const double EI = bending(at(variation.radius, i), at(variation.bend, i));
            model.bend_stiffness[i] =
                EI * 0.5 * (factors[i - first - 1].bend + factor.bend) / (0.5 * (model.rest_length[i - 1] + length));
            if (i + 2 == end) continue;
            const double most = material.limit_twist ? 1.0 : 1e300; // safeguard: twist never above bend
            const double ratio = std::clamp(material.twist_ratio * on_edge(variation.twist, i), 0.0, most);
            // An edge that is held is held to its middle, as the bend behind it has it: only half of it can twist.
            const double twisting_length = held[i] && held[i + 1] ? 0.5 * length : length;
            model.twist_stiffness[i] =
                ratio * factor.twist * bending(on_edge(variation.radius, i), on_edge(variation.bend, i)) / twisting_length;
        }
    }
    return model;
}

} // namespace ringlet
