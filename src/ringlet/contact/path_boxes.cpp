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

void PathBoxes::fit_anew(View<Vec3> start_or_low, View<Vec3> end_or_high, View<unsigned char> changed) {
    constexpr float lost = 0x1p-20f; // of the largest coordinate, in single precision
    const auto place = [](const Vec3 &point, const Vec3 &origin) {
        const Vec3 from = point - origin;
        return Eigen::Array4f(float(from[0]), float(from[1]), float(from[2]), 0.0f);
    };
    Eigen::Array4f largest = Eigen::Array4f::Zero();
#pragma omp parallel
    {
        Eigen::Array4f here = Eigen::Array4f::Zero();
#pragma omp for schedule(static) nowait
        for (int v = 0; v < int(changed.size()); ++v) {
            if (!changed[v]) continue;
            starts_[v] = place(start_or_low[v], origin_.start);
            ends_[v] = place(end_or_high[v], origin_.end);
            here = here.max(starts_[v].abs()).max(ends_[v].abs());
        }
#pragma omp critical
        largest = largest.max(here);
    }
    wider_ = std::max(wider_, lost * largest.maxCoeff());
}

void PathBoxes::fit(View<Vec3> start, View<Vec3> end, const Origin &origin, double margin) {
    origin_ = origin;
    still_ = false;
    wider_ = 0.0f;
    fit_anew(start, end, std::vector<unsigned char>(start.size(), 1));
    wider_ += float(0.5 * margin);
}

void PathBoxes::fit_within(View<Vec3> low, View<Vec3> high) {
    const Vec3 first = low.empty() ? Vec3(Vec3::Zero()) : low[0];
    origin_ = {first, first};
    still_ = true;
    wider_ = 0.0f;
    fit_anew(low, high, std::vector<unsigned char>(low.size(), 1));
}

} // namespace ringlet
