#include "ringlet/contact/path_boxes.h"

namespace ringlet {
namespace {

template <class Primitives> std::vector<float> radii(const CollisionMesh &mesh, const Primitives &primitives) {
    std::vector<float> all(primitives.size());
    for (size_t i = 0; i < all.size(); ++i) all[i] = float(mean_radius(mesh, primitives[i]));
    return all;
}

} // namespace

PathBoxes::PathBoxes(const CollisionMesh &mesh)
    : mesh_(mesh), edge_radii_(radii(mesh, mesh.edges)), vertex_radii_(mesh.radius.begin(), mesh.radius.end()),
      triangle_radii_(radii(mesh, mesh.triangles)), starts_(mesh.moves.size()), ends_(mesh.moves.size()),
      edges_(mesh.edges.size()), vertices_(mesh.moves.size()), triangles_(mesh.triangles.size()) {}

void PathBoxes::place(View<Vec3> points, const Vec3 &origin, std::vector<Eigen::Array4f> &places) {
#pragma omp parallel for schedule(static)
    for (int v = 0; v < int(points.size()); ++v) {
        const Vec3 from = points[v] - origin;
        places[v] = Eigen::Array4f(float(from[0]), float(from[1]), float(from[2]), 0.0f);
    }
}

float PathBoxes::rounding() const {
    constexpr float of_the_largest = 0x1p-20f;
    Eigen::Array4f largest = Eigen::Array4f::Zero();
    for (size_t v = 0; v < starts_.size(); ++v) largest = largest.max(starts_[v].abs()).max(ends_[v].abs());
    return of_the_largest * largest.maxCoeff();
}

template <class Counts> void PathBoxes::fit(const Counts &counts) {
    const auto around = [&](const auto &primitive, float radius) {
        MovingBox all = box(primitive[0]);
        for (size_t k = 1; k < primitive.size(); ++k) all.include(box(primitive[k]));
        all.widen(radius + wider_);
        return all;
    };
    const auto fit = [&](const auto &primitives, const std::vector<float> &radii, std::vector<MovingBox> &boxes) {
#pragma omp parallel for schedule(static)
        for (int i = 0; i < int(primitives.size()); ++i)
            if (counts(primitives[i])) boxes[i] = around(primitives[i], radii[i]);
    };
    fit(mesh_.edges, edge_radii_, edges_);
    if (triangles_.empty()) return;
    fit(mesh_.triangles, triangle_radii_, triangles_);
#pragma omp parallel for schedule(static)
    for (int v = 0; v < int(vertices_.size()); ++v)
        if (counts(std::array{v})) vertices_[v] = around(std::array{v}, vertex_radii_[v]);
}

void PathBoxes::fit(View<Vec3> start, View<Vec3> end, const Origin &origin, double margin) {
    origin_ = origin;
    still_ = false;
    place(start, origin.start, starts_), place(end, origin.end, ends_);
    wider_ = float(0.5 * margin) + rounding();
    fit([](const auto &) { return true; });
}

void PathBoxes::fit_within(View<Vec3> low, View<Vec3> high) {
    const Vec3 first = low.empty() ? Vec3(Vec3::Zero()) : low[0];
    origin_ = {first, first};
    still_ = true;
    place(low, first, starts_), place(high, first, ends_);
    wider_ = rounding();
    fit([](const auto &) { return true; });
}

void PathBoxes::fit_anew(View<Vec3> start_or_low, View<Vec3> end_or_high, View<unsigned char> changed) {
    place(start_or_low, origin_.start, starts_), place(end_or_high, origin_.end, ends_);
    wider_ = std::max(wider_, rounding());
    fit([&](const auto &primitive) { return any_of(changed, primitive); });
}

} // namespace ringlet
