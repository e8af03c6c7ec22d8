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
    : mesh_(mesh), edge_radii_(radii(mesh, mesh.edges)), triangle_radii_(radii(mesh, mesh.triangles)),
      starts_(mesh.moves.size()), ends_(mesh.moves.size()) {}

void PathBoxes::place(View<Vec3> points, const Vec3 &origin, std::vector<Eigen::Array4f> &places) {
#pragma omp parallel for schedule(static)
    for (int v = 0; v < int(points.size()); ++v) {
        const Vec3 from = points[v] - origin;
        places[v] = Eigen::Array4f(float(from[0]), float(from[1]), float(from[2]), 0.0f);
    }
}

void PathBoxes::fit_anew(View<Vec3> start_or_low, View<Vec3> end_or_high) {
    constexpr float lost = 0x1p-20f; // of the largest coordinate, in single precision
    place(start_or_low, origin_.start, starts_), place(end_or_high, origin_.end, ends_);
    Eigen::Array4f largest = Eigen::Array4f::Zero();
    for (size_t v = 0; v < starts_.size(); ++v) largest = largest.max(starts_[v].abs()).max(ends_[v].abs());
    wider_ = std::max(wider_, lost * largest.maxCoeff());
}

void PathBoxes::fit(View<Vec3> start, View<Vec3> end, const Origin &origin, double margin) {
    origin_ = origin;
    still_ = false;
    wider_ = 0.0f;
    fit_anew(start, end);
    wider_ += float(0.5 * margin);
}

void PathBoxes::fit_within(View<Vec3> low, View<Vec3> high) {
    const Vec3 first = low.empty() ? Vec3(Vec3::Zero()) : low[0];
    origin_ = {first, first};
    still_ = true;
    wider_ = 0.0f;
    fit_anew(low, high);
}

} // namespace ringlet
