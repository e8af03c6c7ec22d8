// What belongs to each vertex: its neighbours, its edges, its triangles.
#pragma once

#include "ringlet/contact/collision_mesh.h"

#include <numeric>
#include <vector>

namespace ringlet {

class VertexLists {
public:
    // for_pairs(work) calls work(vertex, item) for all there are, each time in the same order.
    template <class ForPairs> VertexLists(size_t vertices, const ForPairs &for_pairs) : starts_(vertices + 1, 0) {
        for_pairs([&](int v, int) { ++starts_[v + 1]; });
        std::partial_sum(starts_.begin(), starts_.end(), starts_.begin());
        list_.resize(starts_.back());
        std::vector<int> next(starts_.begin(), starts_.end() - 1);
        for_pairs([&](int v, int item) { list_[next[v]++] = item; });
    }

    View<int> of(int vertex) const { return {list_.data() + starts_[vertex], list_.data() + starts_[vertex + 1]}; }

private:
    std::vector<int> starts_, list_;
};

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
