// The candidate pairs of one move: which of them it may bring into contact, or to an impact.
#pragma once

#include "ringlet/collision/candidates.h"
#include "ringlet/collision/incidence.h"
#include "ringlet/collision/narrow_phase.h"
#include "ringlet/collision/swept_boxes.h"
#include "ringlet/math/parallel.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace ringlet {

// Paths of primitives on a move: upper bounds on their lengths, and which of them have escaped or changed.
// Borrows the mesh, which must outlive it.
class PrimitivePaths {
public:
    explicit PrimitivePaths(const CollisionMesh &mesh)
        : mesh_(mesh), vertices_(mesh.moves.size()), edges_(mesh.edges.size()), triangles_(mesh.triangles.size()),
          changed_vertices_(mesh.moves.size()), changed_edges_(mesh.edges.size()), changed_triangles_(mesh.triangles.size()) {}

    // Everything is at rest.
    void clear() {
        for (auto *paths : {&vertices_, &edges_, &triangles_}) std::fill(paths->begin(), paths->end(), Path{});
    }

    // A subset of the mesh has changed, and nothing else.
    void set_changed(const MeshSubset &subset) {
        const auto mark = [](const std::vector<int> &numbers, std::vector<unsigned char> &all) {
            std::fill(all.begin(), all.end(), 0);
            for (const int i : numbers) all[i] = 1;
        };
        mark(subset.vertices, changed_vertices_), mark(subset.edges, changed_edges_);
        mark(subset.triangles, changed_triangles_);
    }

    void measure(const Move &move, const MeshSubset &subset, View<unsigned char> escaped) {
        parallel_for(int(subset.vertices.size()), [&](int k) {
            const int v = subset.vertices[k];
            double length2 = (move.end[v] - move.start[v]).squaredNorm();
            if (!move.apex.empty()) length2 = std::max(length2, (move.apex[v] - move.start[v]).squaredNorm());
            const float length = float(std::sqrt(length2));
            vertices_[v] = {length + length * std::numeric_limits<float>::epsilon(), escaped[v] != 0};
        });
        const auto measure = [&](const std::vector<int> &numbers, const auto &primitives, std::vector<Path> &paths) {
            parallel_for(int(numbers.size()), [&](int k) {
                Path path;
                for (const int v : primitives[numbers[k]]) {
                    path.length = std::max(path.length, vertices_[v].length);
                    path.escaped |= vertices_[v].escaped;
                }
                paths[numbers[k]] = path;
            });
        };
        measure(subset.edges, mesh_.edges, edges_);
        measure(subset.triangles, mesh_.triangles, triangles_);
    }

    bool moves(int vertex) const { return vertices_[vertex].length > 0.0f; }

    // Upper bounds on the path lengths of a pair [m], and on how much nearer it can come.
    std::array<double, 2> lengths(const PrimitivePair &pair) const { return {first(pair).length, second(pair).length}; }
    double length(const PrimitivePair &pair) const { return double(first(pair).length) + second(pair).length; }
    bool escaped(const PrimitivePair &pair) const { return first(pair).escaped || second(pair).escaped; }
    bool changed(const PrimitivePair &pair) const {
        const auto [i, j] = pair.primitive;
        return pair.edge_edge ? changed_edges_[i] || changed_edges_[j] : changed_vertices_[i] || changed_triangles_[j];
    }

private:
    struct Path {            // small, since pairs access them in random order
        float length = 0.0f; // [m], rounded up
        bool escaped = false;
    };

    const Path &first(const PrimitivePair &pair) const { return (pair.edge_edge ? edges_ : vertices_)[pair.primitive[0]]; }
    const Path &second(const PrimitivePair &pair) const { return (pair.edge_edge ? edges_ : triangles_)[pair.primitive[1]]; }

    const CollisionMesh &mesh_;
    std::vector<Path> vertices_, edges_, triangles_;
    std::vector<unsigned char> changed_vertices_, changed_edges_, changed_triangles_;
};

// Each pair stores a lower bound on its gap; the lengths of paths are subtracted from it. While the bound is large enough, no
// distance is computed. Pairs of vertices that escape their bounds on the move are found for it alone, and are transient.
// Borrows the candidates.
class MoveCandidates {
public:
    explicit MoveCandidates(Candidates &candidates);
    const Candidates &candidates() const { return candidates_; }

    // Begins a move from the present positions, for which there are bounds. Until it is committed its end may change: to points
    // in the triangle of start, first end and apex, or without an apex of start and first end.
    void begin(const Move &move);
    void update(const Move &move, View<unsigned char> changed);
    // An update where paths became shorter and are known to have no impact.
    void shorten(const Move &move, View<unsigned char> changed);
    // The vertices are at `end` now: that of the move, or at any fraction of it.
    void commit(View<Vec3> start, View<Vec3> end);

    // Pairs that may have an impact on the move, in order; after an update only those with a changed vertex. Whoever measures a
    // gap at the start of the move may raise min_gap to it.
    const std::vector<CandidatePair *> &impact_candidates() const { return impact_candidates_; }
    // Pairs of vertices in their bounds that may have one wherever in their triangles these are.
    const std::vector<CandidatePair *> &path_candidates() const { return path_candidates_; }
    // Upper bounds on the lengths of the paths of a pair's primitives [m].
    std::array<double, 2> path_lengths(const CandidatePair &pair) const { return paths_.lengths(pair); }
    // Pairs of escaped vertices, in order; an update replaces them.
    const std::vector<CandidatePair> &transient_pairs() const { return transient_; }
    bool any_escaped() const { return any_escaped_; }

    // Pairs with a marked object that are nearer than their activation distance where the last move was begun or committed, in
    // order. Raises the lower bounds that it measures.
    std::vector<ContactPair> contact_pairs(View<Vec3> positions, View<unsigned char> objects);
    // Pairs with a marked object that may come into contact anywhere on the move, in order.
    ReachablePairs reachable_pairs(View<unsigned char> objects) const;

    int size() const { return int(candidates_.pairs().size() + transient_.size()); }

private:
    MeshSubset refit(const Move &move, View<unsigned char> changed);
    void find_moving();
    bool at_rest(const CandidatePair &pair) const { return !moving_[pair.object[0]] && !moving_[pair.object[1]]; }
    template <class Filter> std::vector<CandidatePair *> cull_straight(const Filter &filter) const;
    void add_transient_candidates();
    bool may_contact(const CandidatePair &pair) const { return pair.min_gap - paths_.length(pair) < pair.d_hat; }
    bool may_impact(const CandidatePair &pair) const {
        return pair.min_gap - paths_.length(pair) < collision::impact_distance * pair.d_hat;
    }

    Candidates &candidates_;
    const CollisionMesh &mesh_;
    const MeshSubset all_;
    std::vector<unsigned char> escaped_; // vertices
    bool any_escaped_ = false;
    std::vector<unsigned char> moving_; // objects
    SweptBoxes boxes_;                  // of the move
    PrimitivePaths paths_;
    std::vector<CandidatePair> transient_;
    // Reachable: pairs of vertices in their bounds that may come into contact. The others are of moving objects.
    std::vector<CandidatePair *> reachable_, path_candidates_, impact_candidates_;
};

} // namespace ringlet
