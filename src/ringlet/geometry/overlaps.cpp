#include "ringlet/geometry/overlaps.h"

namespace ringlet {

Traversal traversal(const Bvh &a, const Bvh &b, bool is_static) {
    Traversal traversal;
    traversal.a = a.nodes(), traversal.b = b.nodes(), traversal.one_tree = &a == &b, traversal.is_static = is_static;
    traversal.left = traversal.found = 0;
    return traversal;
}

std::vector<NodePair> split(const Bvh &a, const Bvh &b, bool is_static) {
    std::vector<NodePair> pairs = {{{0, 0}}};
    Traversal below = traversal(a, b, is_static);
    for (bool split = true; split && pairs.size() < bvh_settings::traversal_tasks;) {
        split = false;
        std::vector<NodePair> finer;
        for (const NodePair &pair : pairs)
            if (a.is_leaf(pair.of[0]) && b.is_leaf(pair.of[1]))
                finer.push_back(pair);
            else {
                split = true;
                below.nodes[0] = pair, below.left = 1;
                RINGLET_DISPATCH(traverse, below, 1);
                finer.insert(finer.end(), below.nodes, below.nodes + below.left);
            }
        pairs = std::move(finer);
    }
    return pairs;
}

} // namespace ringlet
