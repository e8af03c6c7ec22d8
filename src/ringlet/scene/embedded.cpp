#include "ringlet/scene/embedded.h"

#include "ringlet/geometry/triangle_tree.h"

#include <algorithm>
#include <limits>
#include <memory>
#include <unordered_map>

namespace ringlet {
namespace {

// A body as it stands, with the height of any point over its surface.
struct Surface {
    std::vector<Vec3> normals;
    TriangleTree tree;

    explicit Surface(const TriangleMesh &mesh) : normals(vertex_normals(mesh)), tree(mesh) {}

    double height(const Vec3 &point, Vec3 &outward) const {
        const SurfacePoint near = tree.closest(point);
        if (near.triangle < 0) return 0.0;
        outward = smooth_normal(tree.mesh(), normals, near.triangle, near.barycentric);
        return (point - near.position).dot(outward) < 0.0 ? -near.distance : near.distance;
    }

    double least_height(const Vec3 &from, const Vec3 &to) const { // on the segment, by samples
        constexpr int samples = 8;
        double least = std::numeric_limits<double>::infinity();
        Vec3 unused;
        for (int k = 0; k <= samples; ++k) least = std::min(least, height(from + (to - from) * (double(k) / samples), unused));
        return least;
    }
};

} // namespace

void Embedded::add(int vertex, const Body &body, CollisionMesh &mesh) {
    const auto same = [&](const Vertex &v) { return v.vertex == vertex; };
    if (!mesh.moves[vertex] || std::any_of(vertices_.begin(), vertices_.end(), same)) return;
    auto known = std::find_if(bodies_.begin(), bodies_.end(), [&](const Body &b) { return b.object == body.object; });
    if (known == bodies_.end()) known = bodies_.insert(known, body);
    vertices_.push_back({vertex, int(known - bodies_.begin()), -std::numeric_limits<double>::infinity()});
    mesh.anchor[vertex] = body.object;
}

std::vector<Lift> Embedded::push_out(CollisionMesh &mesh, View<Vec3> positions, View<int> offsets, View<double> stiffness,
                                     double way) {
    constexpr double nearly = 0.9; // as high as they touch: what resists keeps them a little below
    if (vertices_.empty()) return {};
    std::vector<std::unique_ptr<Surface>> surfaces(bodies_.size());
    for (size_t b = 0; b < bodies_.size(); ++b)
        surfaces[b] = std::make_unique<Surface>(
            TriangleMesh{positions.subspan(bodies_[b].first, bodies_[b].count), View<Triangle>(bodies_[b].triangles)});
    std::vector<unsigned char> out(vertices_.size(), 0);
    std::vector<Lift> lifts(vertices_.size());
#pragma omp parallel for schedule(dynamic, 16)
    for (int k = 0; k < int(vertices_.size()); ++k) {
        const int v = vertices_[k].vertex;
        const Body &body = bodies_[vertices_[k].body];
        const Surface &surface = *surfaces[vertices_[k].body];
        const double touching = mesh.radius[v] + mesh.radius[body.first];
        Vec3 outward = Vec3::Zero();
        const double height = surface.height(positions[v], outward);
        if (height >= nearly * touching) {
            const int strand = mesh.object[v];
            double least = height;
            for (const int next : {v - 1, v + 1})
                if (next >= offsets[strand] && next < offsets[strand + 1])
                    least = std::min(least, surface.least_height(positions[v], positions[next]));
            out[k] = least >= 0.5 * touching;
        }
        double &wanted = vertices_[k].height;
        wanted = std::min(std::max(wanted, height) + way, touching);
        lifts[k] = {v, outward, outward.dot(positions[v]) + wanted - height, stiffness[v]};
    }
    let_go([&](size_t k) { return out[k] != 0; }, mesh);
    size_t k = 0;
    std::erase_if(lifts, [&](const Lift &) { return out[k++] != 0; });
    return lifts;
}

template <class Out> void Embedded::let_go(const Out &out, CollisionMesh &mesh) {
    for (size_t k = 0; k < vertices_.size(); ++k)
        if (out(k)) mesh.anchor[vertices_[k].vertex] = -1;
    size_t k = 0;
    std::erase_if(vertices_, [&](const Vertex &) { return out(k++); });
}

std::vector<std::pair<int, double>> Embedded::heights() const {
    std::vector<std::pair<int, double>> heights;
    heights.reserve(vertices_.size());
    for (const Vertex &v : vertices_) heights.emplace_back(v.vertex, v.height);
    return heights;
}

void Embedded::recall(const std::vector<std::pair<int, double>> &heights, CollisionMesh &mesh) {
    const std::unordered_map<int, double> known(heights.begin(), heights.end());
    let_go([&](size_t k) { return !known.contains(vertices_[k].vertex); }, mesh);
    for (Vertex &v : vertices_) v.height = known.at(v.vertex);
}

} // namespace ringlet
