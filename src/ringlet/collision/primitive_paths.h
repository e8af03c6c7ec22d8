// Paths of primitives on a move: upper bounds on their lengths, and which of them have escaped or changed.
#pragma once

#include "ringlet/collision/incidence.h"
#include "ringlet/collision/swept_boxes.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace ringlet {

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
#pragma omp parallel for schedule(static)
        for (int k = 0; k < int(subset.vertices.size()); ++k) {
            const int v = subset.vertices[k];
            double length2 = (move.end[v] - move.start[v]).squaredNorm();
            if (!move.apex.empty()) length2 = std::max(length2, (move.apex[v] - move.start[v]).squaredNorm());
            const float length = float(std::sqrt(length2));
            vertices_[v] = {length + length * std::numeric_limits<float>::epsilon(), escaped[v] != 0};
        }
        const auto measure = [&](const std::vector<int> &numbers, const auto &primitives, std::vector<Path> &paths) {
#pragma omp parallel for schedule(static)
            for (int k = 0; k < int(numbers.size()); ++k) {
                Path path;
                for (const int v : primitives[numbers[k]]) {
                    path.length = std::max(path.length, vertices_[v].length);
                    path.escaped |= vertices_[v].escaped;
                }
                paths[numbers[k]] = path;
            }
        };
        measure(subset.edges, mesh_.edges, edges_);
        measure(subset.triangles, mesh_.triangles, triangles_);
    }

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

} // namespace ringlet
