// Swept AABBs of all primitives of a mesh on a move.
#pragma once

#include "ringlet/collision/mesh.h"
#include "ringlet/collision/separating_axis.h"
#include "ringlet/geometry/swept_box.h"

#include <vector>

namespace ringlet {

// A move of all vertices, straight from `start` to `end` [m]. With an apex a vertex may follow a curved path instead, inside
// the triangle of start, end and apex.
struct Move {
    View<Vec3> start, end;
    View<Vec3> apex = {};
};

// Boxes are inflated by the radii of their primitives and by the rounding of single precision. Borrows the mesh, which must
// outlive it.
class SweptBoxes {
public:
    explicit SweptBoxes(const CollisionMesh &mesh);

    // Coordinates are relative to these points. A vertex of the scene as origin keeps them precise wherever the scene is and
    // however fast it moves as a whole.
    struct Origin {
        Vec3 start, end;
    };

    // Boxes of a move, inflated by half of `margin` [m].
    void fit(const Move &move, const Origin &origin, double margin = 0.0);
    // Static boxes: each vertex may be anywhere between `low` and `high` [m].
    void fit_static(View<Vec3> low, View<Vec3> high);
    // Updates some vertices of a move, or of static boxes as {low, high}. Boxes of others stay, or grow.
    void refit(const Move &move, View<int> vertices);

    const Origin &origin() const { return origin_; }
    bool is_static() const { return static_; }
    SweptBox of_edge(int i) const { return union_of(mesh_.edges[i], edge_radii_[i]); }
    SweptBox of_vertex(int v) const { return union_of(std::array{v}, float(mesh_.radius[v])); }
    SweptBox of_triangle(int i) const { return union_of(mesh_.triangles[i], triangle_radii_[i]); }

    // Calls work with the boxes of both primitives.
    template <class Pair, class Work> auto with_boxes(const Pair &pair, const Work &work) const {
        const auto [i, j] = pair.primitive;
        return pair.edge_edge ? work(of_edge(i), of_edge(j)) : work(of_vertex(i), of_triangle(j));
    }

    // Gathers the ends of `count` pairs of edges for separating-axis culling: edges_of(k) are the edges of pair k, which are to
    // be culled beyond the sum of their radii.
    template <class EdgesOf> void gather(BoxedEdgePairs &pairs, int count, const EdgesOf &edges_of) const {
        for_fours(count, edges_of, [&](const Four &four, int k) {
            gather_corner(four, &Path::start, pairs.low, k);
            gather_corner(four, &Path::end, pairs.high, k);
        });
        set_reach(pairs, count, edges_of);
    }
    template <class EdgesOf> void gather(MovingEdgePairs &pairs, int count, const EdgesOf &edges_of) const {
        for_fours(count, edges_of, [&](const Four &four, int k) {
            gather_corner(four, &Path::start, pairs.at[0], k);
            gather_corner(four, &Path::end, pairs.at[1], k);
            gather_corner(four, &Path::apex, pairs.at[2], k);
        });
        set_reach(pairs, count, edges_of);
    }
    float rounding() const { return 2.0f * inflation_; } // largest error of a distance [m]

private:
    // Of a vertex, or the corners of a static box, stored together since pairs access them in random order.
    struct Path {
        Eigen::Array4f start, end, apex;
    };

    using Four = std::array<std::array<const Path *, 4>, 4>; // ends of four pairs of edges

    // Calls work with four pairs at a time and the number of the first; the last pair pads the last four.
    template <class EdgesOf, class Work> void for_fours(int count, const EdgesOf &edges_of, const Work &work) const {
        for (int k = 0; k < count; k += 4) {
            Four four;
            for (int i = 0; i < 4; ++i) {
                const std::array<int, 2> edges = edges_of(std::min(k + i, count - 1));
                for (int end = 0; end < 4; ++end) four[end][i] = &paths_[mesh_.edges[edges[end / 2]][end % 2]];
            }
            work(four, k);
        }
    }

    template <class Pairs, class EdgesOf> void set_reach(Pairs &pairs, int count, const EdgesOf &edges_of) const {
        for (int k = 0; k < count; ++k) pairs.reach[k] = edge_radii_[edges_of(k)[0]] + edge_radii_[edges_of(k)[1]] + rounding();
    }

    // From column k on.
    template <int room>
    static void gather_corner(const Four &four, Eigen::Array4f Path::*corner, float (&at)[4][3][room], int k) {
        float columns[4][4];
        for (int end = 0; end < 4; ++end) {
            const auto &[a, b, c, d] = four[end];
            transpose({a->*corner, b->*corner, c->*corner, d->*corner}, columns);
            for (int axis = 0; axis < 3; ++axis) std::memcpy(at[end][axis] + k, columns[axis], sizeof(columns[axis]));
        }
    }

    template <size_t N> SweptBox union_of(const std::array<int, N> &primitive, float radius) const {
        SweptBox all = box(primitive[0]);
        for (size_t k = 1; k < N; ++k) all.include(box(primitive[k]));
        all.inflate(radius + inflation_);
        return all;
    }
    SweptBox box(int vertex) const {
        const auto &[a, b, apex] = paths_[vertex];
        if (static_) return {a, b, a, b};
        return {a, a, b.min(apex), b.max(apex)};
    }

    const CollisionMesh &mesh_;
    std::vector<float> edge_radii_, triangle_radii_;
    std::vector<int> all_; // vertices
    Origin origin_;
    std::vector<Path> paths_;
    float inflation_ = 0.0f; // [m]
    bool static_ = false;
};

} // namespace ringlet
