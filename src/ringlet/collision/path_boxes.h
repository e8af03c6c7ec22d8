// Boxes around the primitives of a scene on their ways.
#pragma once

#include "ringlet/collision/collision_mesh.h"
#include "ringlet/collision/edges_apart.h"
#include "ringlet/collision/moving_box.h"

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

    // Puts pairs of edges of what stays in boxes side by side: edges_of(k) are those of number k.
    template <class EdgesOf> void put(EdgePairs &pairs, int count, const EdgesOf &edges_of) const {
        for_fours(count, edges_of, [&](const Four &four, int k) {
            put_side_by_side(four, &Way::start, pairs.low, k);
            put_side_by_side(four, &Way::end, pairs.high, k);
        });
        put_reach(pairs, count, edges_of);
    }

    // The same of pairs on their ways. Who knows that they touch at less than their radii together puts that, wider by lost().
    template <class EdgesOf> void put(EdgeWays &pairs, int count, const EdgesOf &edges_of) const {
        for_fours(count, edges_of, [&](const Four &four, int k) {
            put_side_by_side(four, &Way::start, pairs.at[0], k);
            put_side_by_side(four, &Way::end, pairs.at[1], k);
            put_side_by_side(four, &Way::via, pairs.at[2], k);
        });
        put_reach(pairs, count, edges_of);
    }
    float lost() const { return 2.0f * wider_; } // at most, of what is between two [m]

private:
    struct Way { // of a vertex, or the corners of what it stays in; side by side, since pairs ask for them in no order
        Eigen::Array4f start, end, via;
    };

    using Four = std::array<std::array<const Way *, 4>, 4>; // ends of four pairs of edges

    // Calls work with four pairs after four, and the number of the first; the last is there more than once if need be.
    template <class EdgesOf, class Work> void for_fours(int count, const EdgesOf &edges_of, const Work &work) const {
        for (int k = 0; k < count; k += 4) {
            Four four;
            for (int i = 0; i < 4; ++i) {
                const std::array<int, 2> edges = edges_of(std::min(k + i, count - 1));
                for (int end = 0; end < 4; ++end) four[end][i] = &ways_[mesh_.edges[edges[end / 2]][end % 2]];
            }
            work(four, k);
        }
    }

    template <class SideBySide, class EdgesOf> void put_reach(SideBySide &pairs, int count, const EdgesOf &edges_of) const {
        for (int k = 0; k < count; ++k) pairs.reach[k] = edge_radii_[edges_of(k)[0]] + edge_radii_[edges_of(k)[1]] + lost();
    }

    // Of four pairs where each end is, from column k on.
    template <int room>
    static void put_side_by_side(const Four &four, Eigen::Array4f Way::*place, float (&at)[4][3][room], int k) {
        float columns[4][4];
        for (int end = 0; end < 4; ++end) {
            const auto &[a, b, c, d] = four[end];
            transpose({a->*place, b->*place, c->*place, d->*place}, columns);
            for (int axis = 0; axis < 3; ++axis) std::memcpy(at[end][axis] + k, columns[axis], sizeof(columns[axis]));
        }
    }

    template <size_t N> MovingBox around(const std::array<int, N> &primitive, float radius) const {
        MovingBox all = box(primitive[0]);
        for (size_t k = 1; k < N; ++k) all.include(box(primitive[k]));
        all.widen(radius + wider_);
        return all;
    }
    MovingBox box(int vertex) const { // not widened yet
        const auto &[a, b, via] = ways_[vertex];
        if (still_) return {a, b, a, b};
        return {a, a, b.min(via), b.max(via)};
    }

    const CollisionMesh &mesh_;
    std::vector<float> edge_radii_, triangle_radii_;
    std::vector<int> all_; // vertices
    Origin origin_;
    std::vector<Way> ways_;
    float wider_ = 0.0f; // [m]
    bool still_ = false;
};

} // namespace ringlet
