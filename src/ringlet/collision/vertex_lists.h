// What belongs to each vertex: its neighbours, its edges, its triangles.
#pragma once

#include "ringlet/collision/collision_mesh.h"
#include "ringlet/math/lists.h"

#include <numeric>
#include <vector>

namespace ringlet {

using VertexLists = Lists<int>;

// The vertices that share an edge with one, from `first` on, up to `end`; others have none.
inline VertexLists neighbours(const CollisionMesh &mesh, int first, int end) {
    return {mesh.moves.size(), [&](const auto &work) {
                for (const auto &[a, b] : mesh.edges)
                    if (std::min(a, b) >= first && std::max(a, b) < end) work(a, b), work(b, a);
            }};
}

// The numbers of the primitives that have a vertex.
template <size_t N> VertexLists primitives_of(size_t vertices, const std::vector<std::array<int, N>> &primitives) {
    return {vertices, [&](const auto &work) {
                for (int i = 0; i < int(primitives.size()); ++i)
                    for (const int v : primitives[i]) work(v, i);
            }};
}

// Which primitives of a mesh have a vertex.
struct Incidence {
    VertexLists edges, triangles;

    explicit Incidence(const CollisionMesh &mesh)
        : edges(primitives_of(mesh.moves.size(), mesh.edges)), triangles(primitives_of(mesh.moves.size(), mesh.triangles)) {}
};

// Some vertices, and the primitives that have any of them, each once.
struct Affected {
    std::vector<int> vertices, edges, triangles;

    explicit Affected(const CollisionMesh &mesh) // all of them
        : vertices(mesh.moves.size()), edges(mesh.edges.size()), triangles(mesh.triangles.size()) {
        for (auto *all : {&vertices, &edges, &triangles}) std::iota(all->begin(), all->end(), 0);
    }

    // By vertices that are marked.
    Affected(const CollisionMesh &mesh, const Incidence &incidence, View<unsigned char> marked) {
        const auto add = [&](int v, const VertexLists &lists, const auto &primitives, std::vector<int> &affected) {
            for (const int i : lists.of(v)) {
                const auto first =
                    std::find_if(primitives[i].begin(), primitives[i].end(), [&](int w) { return marked[w] != 0; });
                if (*first == v) affected.push_back(i);
            }
        };
        for (int v = 0; v < int(marked.size()); ++v)
            if (marked[v]) {
                vertices.push_back(v);
                add(v, incidence.edges, mesh.edges, edges);
                add(v, incidence.triangles, mesh.triangles, triangles);
            }
    }
};

} // namespace ringlet
