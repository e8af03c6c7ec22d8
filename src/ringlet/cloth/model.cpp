#include "ringlet/cloth/model.h"

#include "ringlet/energy/cloth/hinge.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <stdexcept>
#include <string>
#include <utility>

namespace ringlet {
namespace {

// Interior edges, in the order in which the triangles close them. Where more than two triangles share an edge, the first is
// hinged to each of the others.
std::vector<std::array<int, 4>> find_hinges(View<Triangle> triangles) {
    std::vector<std::array<int, 4>> hinges;
    std::map<std::pair<int, int>, int> first_apex;
    for (const Triangle &t : triangles)
        for (int k = 0; k < 3; ++k) {
            const auto [a, b] = std::minmax(t[k], t[(k + 1) % 3]);
            const int apex = t[(k + 2) % 3];
            const auto [first, is_new] = first_apex.try_emplace({a, b}, apex);
            if (!is_new) hinges.push_back({first->second, a, b, apex});
        }
    return hinges;
}

void check_sizes(View<Triangle> triangles, size_t vertices, View<Vec3> warp, View<unsigned char> held,
                 View<double> attachment) {
    if (warp.size() != triangles.size()) throw std::invalid_argument("cloth: there is not one warp direction per triangle");
    if (held.size() != vertices) throw std::invalid_argument("cloth: held does not fit the points");
    if (!attachment.empty() && attachment.size() != vertices)
        throw std::invalid_argument("cloth: attachment does not fit the points");
    for (size_t t = 0; t < triangles.size(); ++t)
        if (triangles[t].minCoeff() < 0 || triangles[t].maxCoeff() >= int(vertices))
            throw std::invalid_argument("cloth: triangle " + std::to_string(t) + " names a vertex that does not exist");
}

} // namespace

ClothModel make_cloth_model(View<Triangle> triangles, View<Vec3> rest, View<Vec3> warp, View<unsigned char> held,
                            View<double> attachment, const ClothMaterial &material) {
    const size_t n = rest.size();
    check_sizes(triangles, n, warp, held, attachment);

    ClothModel model;
    model.rest.assign(rest.begin(), rest.end());
    model.triangles.assign(triangles.begin(), triangles.end());
    model.held.assign(held.begin(), held.end());
    model.attachment.assign(n, 0.0);
    std::copy(attachment.begin(), attachment.end(), model.attachment.begin());
    model.mass.assign(n, 0.0);
    model.drag.assign(n, 0.0);
    model.stiffness = {material.stretch_warp, material.stretch_weft, material.shear};
    model.damping = material.damping;
    model.mass_damping = material.mass_damping;
    model.thickness = material.thickness;

    for (size_t k = 0; k < triangles.size(); ++k) {
        const Triangle &t = triangles[k];
        const Vec3 corners[3] = {rest[t[0]], rest[t[1]], rest[t[2]]};
        const MembraneRest measured = measure_membrane(corners, warp[k]);
        if (!(measured.area > 0)) throw std::invalid_argument("cloth: triangle " + std::to_string(k) + " has no area");
        model.membrane.push_back(measured);
        for (const int vertex : t) {
            model.mass[vertex] += material.density * measured.area / 3;
            model.drag[vertex] += material.drag * measured.area / 3;
        }
    }
    for (size_t i = 0; i < n; ++i)
        if (!held[i] && model.mass[i] == 0)
            throw std::invalid_argument("cloth: vertex " + std::to_string(i) + " is free and belongs to no triangle");

    model.hinges = find_hinges(triangles);
    for (const auto &h : model.hinges) {
        const Vec3 corners[4] = {rest[h[0]], rest[h[1]], rest[h[2]], rest[h[3]]};
        model.rest_angle.push_back(hinge_angle(corners));
        model.hinge_stiffness.push_back(hinge_stiffness(corners, material.bend));
    }
    model.given_rest = model.rest;
    model.given_membrane = model.membrane;
    return model;
}

void scale_rest(ClothModel &model, double scale) {
    if (!(scale > 0) || !std::isfinite(scale))
        throw std::invalid_argument("cloth: the scale of its rest shape must be above 0");
    for (size_t v = 0; v < model.rest.size(); ++v) model.rest[v] = scale * model.given_rest[v];
    for (size_t t = 0; t < model.membrane.size(); ++t) {
        const MembraneRest &given = model.given_membrane[t];
        model.membrane[t] = {given.warp / scale, given.weft / scale, given.area * scale * scale};
    }
}

} // namespace ringlet
