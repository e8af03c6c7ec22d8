// Which vertices share an edge.
#pragma once

#include "ringlet/contact/collision_mesh.h"

#include <numeric>
#include <vector>

namespace ringlet {

class Neighbours {
public:
    Neighbours() = default;

    // Of the vertices of the mesh from `first` on, up to `end`; others have none.
    Neighbours(const CollisionMesh &mesh, int first, int end) : starts_(mesh.moves.size() + 1, 0) {
        const auto for_pairs = [&](const auto &work) {
            for (const auto &[a, b] : mesh.edges)
                if (std::min(a, b) >= first && std::max(a, b) < end) work(a, b), work(b, a);
        };
        for_pairs([&](int a, int) { ++starts_[a + 1]; });
        std::partial_sum(starts_.begin(), starts_.end(), starts_.begin());
        list_.resize(starts_.back());
        std::vector<int> next(starts_.begin(), starts_.end() - 1);
        for_pairs([&](int a, int b) { list_[next[a]++] = b; });
    }

    View<int> of(int vertex) const { return {list_.data() + starts_[vertex], list_.data() + starts_[vertex + 1]}; }

private:
    std::vector<int> starts_, list_;
};

} // namespace ringlet
