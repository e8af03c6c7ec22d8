// Boxes around the primitives of a scene on their ways.
#pragma once

#include "ringlet/contact/collision_mesh.h"
#include "ringlet/contact/edges_apart.h"
#include "ringlet/contact/moving_box.h"

#include <vector>

namespace ringlet {

// Borrows the mesh, which must outlive it. Boxes are as wide as their primitives are thick, and wider by what may be lost in
// computing in single precision.
class PathBoxes {
public:
    explicit PathBoxes(const CollisionMesh &mesh);

    // Where places are told from: where the scene is and how fast it flies as a whole costs no precision if this is a vertex.
    struct Origin {
        Vec3 start, end;
    };

    // Everything goes straight from `start` to `end`: positions [m] of all vertices. Boxes are wider by `margin` [m], and hold
    // what goes to `via` as well, if that is given.
    void fit(View<Vec3> start, View<Vec3> end, const Origin &origin, double margin = 0.0, View<Vec3> via = {});
    // Vertices may be anywhere in boxes, from `low` to `high` [m].
    void fit_within(View<Vec3> low, View<Vec3> high);
    // Either of them again, where some `vertices` have changed: boxes of others stay as they are, or grow.
    void fit_anew(View<Vec3> start_or_low, View<Vec3> end_or_high, View<int> vertices, View<Vec3> via = {});

    const Origin &origin() const { return origin_; }
    bool still() const { return still_; } // boxes are the same at the end
    MovingBox of_edge(int i) const { return around(mesh_.edges[i], edge_radii_[i]); }
    MovingBox of_vertex(int v) const { return around(std::array{v}, float(mesh_.radius[v])); }
    MovingBox of_triangle(int i) const { return around(mesh_.triangles[i], triangle_radii_[i]); }

    // Calls work with the boxes of the two of a pair.
    template <class Pair, class Work> auto with_boxes(const Pair &pair, const Work &work) const {
        return pair.of_edges ? work(of_edge(pair.of[0]), of_edge(pair.of[1]))
                             : work(of_vertex(pair.of[0]), of_triangle(pair.of[1]));
    }

    // Puts a pair of edges of what stays in boxes as number `k` among others.
    void put(EdgePairs &pairs, int k, const std::array<int, 2> &edges) const {
        const auto &[a, b] = mesh_.edges[edges[0]];
        const auto &[c, d] = mesh_.edges[edges[1]];
        const int ends[4] = {a, b, c, d};
        for (int end = 0; end < 4; ++end)
            for (int axis = 0; axis < 3; ++axis) {
                pairs.low[end][axis][k] = starts_[ends[end]][axis];
                pairs.high[end][axis][k] = ends_[ends[end]][axis];
            }
        pairs.reach[k] = edge_radii_[edges[0]] + edge_radii_[edges[1]] + 2.0f * wider_;
    }

    // Puts a pair of edges on their ways as number `k` among others, that touch at `distance` [m].
    void put(EdgeWays &pairs, int k, const std::array<int, 2> &edges, double distance) const {
        const auto &[a, b] = mesh_.edges[edges[0]];
        const auto &[c, d] = mesh_.edges[edges[1]];
        const int ends[4] = {a, b, c, d};
        const std::vector<Eigen::Array4f> *places[3] = {&starts_, &ends_, bends_ ? &vias_ : &ends_};
        for (int place = 0; place < 3; ++place)
            for (int end = 0; end < 4; ++end)
                for (int axis = 0; axis < 3; ++axis) pairs.at[place][end][axis][k] = (*places[place])[ends[end]][axis];
        pairs.reach[k] = float(distance) + 2.0f * wider_;
    }

private:
    template <size_t N> MovingBox around(const std::array<int, N> &primitive, float radius) const {
        MovingBox all = box(primitive[0]);
        for (size_t k = 1; k < N; ++k) all.include(box(primitive[k]));
        all.widen(radius + wider_);
        return all;
    }
    MovingBox box(int vertex) const { // not widened yet
        const Eigen::Array4f &a = starts_[vertex], &b = ends_[vertex];
        if (still_) return {a, b, a, b};
        if (!bends_) return {a, a, b, b};
        return {a, a, b.min(vias_[vertex]), b.max(vias_[vertex])};
    }

    const CollisionMesh &mesh_;
    std::vector<float> edge_radii_, triangle_radii_;
    std::vector<int> all_; // vertices
    Origin origin_;
    std::vector<Eigen::Array4f> starts_, ends_; // of the ways, or the corners of what vertices stay in
    std::vector<Eigen::Array4f> vias_;
    float wider_ = 0.0f; // [m]
    bool still_ = false, bends_ = false;
};

} // namespace ringlet
