// Incidence of a collision mesh: the edges and triangles of each vertex.
#pragma once

#include "ringlet/collision/mesh.h"
#include "ringlet/math/collect.h"
#include "ringlet/math/lists.h"

#include <numeric>
#include <vector>

namespace ringlet {

using VertexLists = Lists<int>;

// The primitives of each vertex.
template <size_t N> VertexLists primitives_of(size_t vertices, const std::vector<std::array<int, N>> &primitives) {
    return {vertices, int(primitives.size()), [&](int i, const auto &add) {
                for (const int v : primitives[i]) add(v, i);
            }};
}

struct Incidence {
    VertexLists edges, triangles; // of each vertex

    explicit Incidence(const CollisionMesh &mesh)
        : edges(primitives_of(mesh.moves.size(), mesh.edges)), triangles(primitives_of(mesh.moves.size(), mesh.triangles)) {}
};

// Some vertices of a mesh and the primitives that have any of them, each once.
struct MeshSubset {
    std::vector<int> vertices, edges, triangles;

    explicit MeshSubset(const CollisionMesh &mesh) // everything
        : vertices(mesh.moves.size()), edges(mesh.edges.size()), triangles(mesh.triangles.size()) {
        for (auto *all : {&vertices, &edges, &triangles}) std::iota(all->begin(), all->end(), 0);
    }

    MeshSubset(const CollisionMesh &mesh, const Incidence &incidence, View<unsigned char> marked) {
        const auto with_marked = [&](const VertexLists &lists, const auto &primitives) {
            return collect<int>(int(vertices.size()), [&](int k, std::vector<int> &subset) {
                for (const int i : lists.of(vertices[k])) {
                    const auto first =
                        std::find_if(primitives[i].begin(), primitives[i].end(), [&](int w) { return marked[w] != 0; });
                    if (*first == vertices[k]) subset.push_back(i);
                }
            });
        };
        vertices = collect<int>(int(marked.size()), [&](int v, std::vector<int> &subset) {
            if (marked[v]) subset.push_back(v);
        });
        edges = with_marked(incidence.edges, mesh.edges);
        triangles = with_marked(incidence.triangles, mesh.triangles);
    }
};

} // namespace ringlet
