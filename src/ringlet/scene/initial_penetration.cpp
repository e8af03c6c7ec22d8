#include "ringlet/scene/initial_penetration.h"

#include "ringlet/geometry/triangle_tree.h"
#include "ringlet/math/parallel.h"
#include "ringlet/scene/settings.h"

#include <algorithm>
#include <limits>
#include <memory>
#include <unordered_map>

namespace ringlet {
namespace {

// A body in place, with the height of points over its surface.
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
        double least = std::numeric_limits<double>::infinity();
        Vec3 unused;
        for (int k = 0; k <= scene_settings::height_samples; ++k)
            least = std::min(least, height(from + (to - from) * (double(k) / scene_settings::height_samples), unused));
        return least;
    }
};

} // namespace

void InitialPenetration::add(int vertex, const Body &body, CollisionMesh &mesh) {
    const auto known_already = [&](const Vertex &v) { return v.vertex == vertex; };
    if (!mesh.moves[vertex] || std::any_of(vertices_.begin(), vertices_.end(), known_already)) return;
    auto known = std::find_if(bodies_.begin(), bodies_.end(), [&](const Body &b) { return b.object == body.object; });
    if (known == bodies_.end()) known = bodies_.insert(known, body);
    vertices_.push_back({vertex, int(known - bodies_.begin()), -std::numeric_limits<double>::infinity()});
    mesh.anchor[vertex] = body.object;
}

std::vector<RecoverySpring> InitialPenetration::recover(CollisionMesh &mesh, View<Vec3> positions, View<double> stiffness,
                                                        double length) {
    if (vertices_.empty()) return {};
    std::vector<std::unique_ptr<Surface>> surfaces(bodies_.size());
    for (size_t b = 0; b < bodies_.size(); ++b)
        surfaces[b] = std::make_unique<Surface>(
            TriangleMesh{positions.subspan(bodies_[b].first, bodies_[b].count), View<Triangle>(bodies_[b].triangles)});
    std::vector<unsigned char> outside(vertices_.size(), 0);
    std::vector<RecoverySpring> springs(vertices_.size());
    parallel_chunks(int(vertices_.size()), 16, [&](int k) {
        const int v = vertices_[k].vertex;
        const Body &body = bodies_[vertices_[k].body];
        const Surface &surface = *surfaces[vertices_[k].body];
        const double radii = mesh.radius[v] + mesh.radius[body.first];
        const double touching =
            std::clamp(collision::yield_fraction * yield(mesh, std::array{v}), collision::least_d_hat_fraction * radii, radii);
        Vec3 outward = Vec3::Zero();
        const double height = surface.height(positions[v], outward);
        if (height >= scene_settings::recovered_height * touching) {
            const CollisionObject &strand = mesh.objects[mesh.object[v]];
            double least = height;
            for (const int next : {v - 1, v + 1})
                if (next >= strand.first && next < strand.end)
                    least = std::min(least, surface.least_height(positions[v], positions[next]));
            outside[k] = least >= scene_settings::separate_height * touching;
        }
        double &height_wanted = vertices_[k].height;
        height_wanted = std::min(std::max(height_wanted, height) + length, touching);
        springs[k] = {v, outward, outward.dot(positions[v]) + height_wanted - height, stiffness[v]};
    });
    end_exemptions([&](size_t k) { return outside[k] != 0; }, mesh);
    size_t k = 0;
    std::erase_if(springs, [&](const RecoverySpring &) { return outside[k++] != 0; });
    return springs;
}

template <class Outside> void InitialPenetration::end_exemptions(const Outside &outside, CollisionMesh &mesh) {
    for (size_t k = 0; k < vertices_.size(); ++k)
        if (outside(k)) mesh.anchor[vertices_[k].vertex] = -1;
    size_t k = 0;
    std::erase_if(vertices_, [&](const Vertex &) { return outside(k++); });
}

std::vector<std::pair<int, double>> InitialPenetration::heights() const {
    std::vector<std::pair<int, double>> heights;
    heights.reserve(vertices_.size());
    for (const Vertex &v : vertices_) heights.emplace_back(v.vertex, v.height);
    return heights;
}

void InitialPenetration::recall(const std::vector<std::pair<int, double>> &heights, CollisionMesh &mesh) {
    const std::unordered_map<int, double> known(heights.begin(), heights.end());
    end_exemptions([&](size_t k) { return !known.contains(vertices_[k].vertex); }, mesh);
    for (Vertex &v : vertices_) v.height = known.at(v.vertex);
}

} // namespace ringlet
