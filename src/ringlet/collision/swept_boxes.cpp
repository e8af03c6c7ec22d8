#include "ringlet/collision/swept_boxes.h"

#include "ringlet/math/parallel.h"

#include <numeric>

namespace ringlet {
namespace {

template <class Primitives> std::vector<float> radii(const CollisionMesh &mesh, const Primitives &primitives) {
    std::vector<float> all(primitives.size());
    for (size_t i = 0; i < all.size(); ++i) all[i] = float(mean_radius(mesh, primitives[i]));
    return all;
}

} // namespace

SweptBoxes::SweptBoxes(const CollisionMesh &mesh)
    : mesh_(mesh), edge_radii_(radii(mesh, mesh.edges)), triangle_radii_(radii(mesh, mesh.triangles)), all_(mesh.moves.size()),
      paths_(mesh.moves.size()) {
    std::iota(all_.begin(), all_.end(), 0);
}

void SweptBoxes::refit(const Move &move, View<int> vertices) {
    const auto relative = [](const Vec3 &point, const Vec3 &origin) {
        const Vec3 from = point - origin;
        return Eigen::Array4f(float(from[0]), float(from[1]), float(from[2]), 0.0f);
    };
    constexpr int range = 1024;
    std::vector<float> largest((vertices.size() + range - 1) / range);
    parallel_for(int(largest.size()), [&](int r) {
        Eigen::Array4f here = Eigen::Array4f::Zero();
        for (const int v : vertices.subspan(r * range).first(std::min(range, int(vertices.size()) - r * range))) {
            Path &path = paths_[v];
            path.start = relative(move.start[v], origin_.start);
            path.end = relative(move.end[v], origin_.end);
            path.apex = move.apex.empty() ? path.end : relative(move.apex[v], origin_.end);
            here = here.max(path.start.abs()).max(path.end.abs()).max(path.apex.abs());
        }
        largest[r] = here.maxCoeff();
    });
    for (const float coordinate : largest) inflation_ = std::max(inflation_, bvh_settings::coordinate_rounding * coordinate);
}

void SweptBoxes::fit(const Move &move, const Origin &origin, double margin) {
    origin_ = origin;
    static_ = false;
    inflation_ = 0.0f;
    refit(move, all_);
    inflation_ += float(0.5 * margin);
}

void SweptBoxes::fit_static(View<Vec3> low, View<Vec3> high) {
    const Vec3 first = low.empty() ? Vec3(Vec3::Zero()) : low[0];
    origin_ = {first, first};
    static_ = true;
    inflation_ = 0.0f;
    refit({low, high}, all_);
}

} // namespace ringlet
