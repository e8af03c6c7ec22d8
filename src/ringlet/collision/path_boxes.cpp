#include "ringlet/collision/path_boxes.h"

#include <numeric>

namespace ringlet {
namespace {

template <class Primitives> std::vector<float> radii(const CollisionMesh &mesh, const Primitives &primitives) {
    std::vector<float> all(primitives.size());
    for (size_t i = 0; i < all.size(); ++i) all[i] = float(mean_radius(mesh, primitives[i]));
    return all;
}

} // namespace

PathBoxes::PathBoxes(const CollisionMesh &mesh)
    : mesh_(mesh), edge_radii_(radii(mesh, mesh.edges)), triangle_radii_(radii(mesh, mesh.triangles)), all_(mesh.moves.size()),
      ways_(mesh.moves.size()) {
    std::iota(all_.begin(), all_.end(), 0);
}

void PathBoxes::fit_anew(View<Vec3> start_or_low, View<Vec3> end_or_high, View<int> vertices, View<Vec3> via) {
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
        for (int k = 0; k < int(vertices.size()); ++k) {
            const int v = vertices[k];
            Way &way = ways_[v];
            way.start = place(start_or_low[v], origin_.start);
            way.end = place(end_or_high[v], origin_.end);
            way.via = via.empty() ? way.end : place(via[v], origin_.end);
            here = here.max(way.start.abs()).max(way.end.abs()).max(way.via.abs());
        }
#pragma omp critical
        largest = largest.max(here);
    }
    wider_ = std::max(wider_, lost * largest.maxCoeff());
}

void PathBoxes::fit(View<Vec3> start, View<Vec3> end, const Origin &origin, double margin, View<Vec3> via) {
    origin_ = origin;
    still_ = false;
    wider_ = 0.0f;
    fit_anew(start, end, all_, via);
    wider_ += float(0.5 * margin);
}

void PathBoxes::fit_within(View<Vec3> low, View<Vec3> high) {
    const Vec3 first = low.empty() ? Vec3(Vec3::Zero()) : low[0];
    origin_ = {first, first};
    still_ = true;
    wider_ = 0.0f;
    fit_anew(low, high, all_);
}

} // namespace ringlet
