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

// The material with its variation along a strand. Factors of an edge are the mean of those of its two vertices.
struct VariedMaterial {
    const StrandMaterial &material;
    const StrandVariation &variation;

    static double at(View<double> factor, int vertex) { return factor.empty() ? 1.0 : factor[vertex]; }
    static double on_edge(View<double> factor, int edge) { return 0.5 * (at(factor, edge) + at(factor, edge + 1)); }

    double area(double radius_factor) const { return std::numbers::pi * std::pow(radius_factor * material.radius, 2); } // [m²]
    double bending(double radius_factor, double bend_factor) const { // EI [N m²]
        return bend_factor * material.bend_scale * material.youngs_modulus * std::pow(area(radius_factor), 2) /
               (4 * std::numbers::pi);
    }
    double area_of_edge(int i) const { return area(on_edge(variation.radius, i)); }
    double stretching_of_edge(int i) const { // EA [N]
        return material.stretch_scale * on_edge(variation.stretch, i) * material.youngs_modulus * area_of_edge(i);
    }
    double bending_of_vertex(int i) const { return bending(at(variation.radius, i), at(variation.bend, i)); }
    double bending_of_edge(int i) const { return bending(on_edge(variation.radius, i), on_edge(variation.bend, i)); }
    double twist_ratio_of_edge(int i) const {                   // c = GJ / EI
        const double most = material.limit_twist ? 1.0 : 1e300; // safeguard: twist is never stiffer than bend
        return std::clamp(material.twist_ratio * on_edge(variation.twist, i), 0.0, most);
    }
};

// One per edge of the strand; the two end edges, which have one corner only, take those of their neighbours.
std::vector<ResolutionFactors> corrections_of(const StrandModel &model, int first, int end) {
    std::vector<ResolutionFactors> factors(end - first - 1);
    for (int i = first + 1; i + 2 < end; ++i)
        factors[i - first] = resolution_factors(0.5 * (model.rest_angle[i] + model.rest_angle[i + 1]), model.rest_dihedral[i]);
    if (factors.size() > 2) {
        factors.front() = factors[1];
        factors.back() = factors[factors.size() - 2];
    }
    return factors;
}

void check_sizes(View<int> offsets, size_t n, View<unsigned char> held, const StrandVariation &variation) {
    if (offsets.empty() || offsets.front() != 0 || offsets.back() != int(n) || held.size() != n)
        throw std::invalid_argument("strands: offsets, points and held do not fit together");
    for (const View<double> &factor :
         {variation.radius, variation.stretch, variation.bend, variation.twist, variation.damping, variation.drag})
        if (!factor.empty() && factor.size() != n) throw std::invalid_argument("strands: a variation does not fit the points");
}

void check_strand(const StrandModel &model, int strand) {
    const int first = model.offsets[strand], end = model.offsets[strand + 1];
    const std::string name = "strands: strand " + std::to_string(strand);
    if (end - first < 3) throw std::invalid_argument(name + " has fewer than 3 vertices");
    if (!model.held[first]) throw std::invalid_argument(name + " does not hold its root");
    for (int i = first; i + 1 < end; ++i)
        if (!(model.rest_length[i] > 0)) throw std::invalid_argument(name + " has an edge without length");
}

// Rest shape and zero coefficients.
StrandModel rest_model(View<int> offsets, View<Vec3> rest, View<unsigned char> held) {
    const size_t n = rest.size();
    StrandModel model;
    model.offsets.assign(offsets.begin(), offsets.end());
    model.held.assign(held.begin(), held.end());
    for (const auto column : StrandModel::columns) (model.*column).assign(n, 0.0);
    RestShape shape = measure_rest_shape(offsets, rest);
    model.rest_length = std::move(shape.length);
    model.rest_angle = std::move(shape.angle);
    model.rest_dihedral = std::move(shape.dihedral);
    model.rest_normal = std::move(shape.normal);
    model.rest_tangent.assign(n, Vec3::Zero());
    return model;
}

// Coefficients of one strand, with corrections of its resolution per edge.
void set_coefficients(StrandModel &model, int strand, const VariedMaterial &varied,
                      const std::vector<ResolutionFactors> &corrections) {
    const StrandMaterial &material = varied.material;
    const int first = model.offsets[strand], end = model.offsets[strand + 1];
    for (int i = first; i + 1 < end; ++i) {
        const double length = model.rest_length[i];
        const ResolutionFactors &correction = corrections[i - first];
        for (const int vertex : {i, i + 1}) {
            model.mass[vertex] += 0.5 * material.density * varied.area_of_edge(i) * length * correction.mass;
            model.drag[vertex] += 0.5 * material.drag * varied.on_edge(varied.variation.drag, i) * length;
        }
        model.damping[i] = material.damping * varied.at(varied.variation.damping, i);
        model.stretch_stiffness[i] = varied.stretching_of_edge(i) / length;
        if (i == first) continue;
        model.bend_stiffness[i] = varied.bending_of_vertex(i) * 0.5 * (corrections[i - first - 1].bend + correction.bend) /
                                  (0.5 * (model.rest_length[i - 1] + length));
        if (i + 2 == end) continue;
        // A held edge is held up to its middle, where the bend behind it begins: only half of it twists.
        const double twisting_length = model.held[i] && model.held[i + 1] ? 0.5 * length : length;
        model.twist_stiffness[i] =
            varied.twist_ratio_of_edge(i) * correction.twist * varied.bending_of_edge(i) / twisting_length;
    }
    model.damping[end - 1] = material.damping;
}

} // namespace

StrandModel make_strand_model(View<int> offsets, View<Vec3> rest, View<unsigned char> held, const StrandMaterial &material,
                              const StrandVariation &variation) {
    check_sizes(offsets, rest.size(), held, variation);
    StrandModel model = rest_model(offsets, rest, held);
    model.mass_damping = material.mass_damping;
    for (int s = 0; s < model.strand_count(); ++s) {
        check_strand(model, s);
        const int first = model.offsets[s], end = model.offsets[s + 1];
        for (int i = first; i + 1 < end; ++i) model.rest_tangent[i] = (rest[i + 1] - rest[i]) / model.rest_length[i];
        set_coefficients(model, s, {material, variation},
                         material.correct_resolution ? corrections_of(model, first, end)
                                                     : std::vector<ResolutionFactors>(end - first - 1));
    }
    return model;
}

} // namespace ringlet
