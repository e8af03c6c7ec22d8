#include "ringlet/collision/broad_phase.h"

#include "ringlet/geometry/overlaps.h"
#include "ringlet/math/lists.h"
#include "ringlet/math/parallel.h"

#include <algorithm>
#include <type_traits>
#include <utility>

namespace ringlet {
namespace {

// Removes the pairs of edges that separated() reports, in order.
template <class EdgePairs, class Separated>
void cull(const Bvh &edges, const SweptBoxes &boxes, const Separated &separated, Traversal &traversal) {
    EdgePairs batch = {};
    int kept = 0;
    for (int first = 0; first < traversal.found; first += EdgePairs::room) {
        const int count = std::min(traversal.found - first, EdgePairs::room);
        const NodePair *pairs = traversal.boxes + first;
        boxes.gather(batch, count,
                     [&](int k) { return std::array{edges.primitive(pairs[k].of[0]), edges.primitive(pairs[k].of[1])}; });
        const unsigned culled = separated(batch);
        for (int k = 0; k < count; ++k)
            if (!(culled >> k & 1u)) traversal.boxes[kept++] = pairs[k];
    }
    traversal.found = kept;
}

// Boxes say little about long edges that are askew.
void cull_edges(const Bvh &edges, const SweptBoxes &boxes, const SweptBoxes *move, Traversal &found) {
    const auto in_triangles = [](const MovingEdgePairs &some) { return RINGLET_DISPATCH(separated_in_triangles, some); };
    const auto in_boxes = [](const BoxedEdgePairs &some) { return RINGLET_DISPATCH(separated_in_boxes, some); };
    if (move != nullptr)
        cull<MovingEdgePairs>(edges, *move, in_triangles, found);
    else
        cull<BoxedEdgePairs>(edges, boxes, in_boxes, found);
}

} // namespace

BroadPhase::BroadPhase(const CollisionMesh &mesh) : mesh_(mesh), incidence_(mesh) {
    point_of_.assign(mesh.moves.size(), -1);
    escaped_.assign(mesh.moves.size(), 0);
    for (int v : mesh.points) {
        point_of_[v] = int(points_.size());
        points_.push_back({v});
    }
}

template <class Work> void BroadPhase::for_trees(const Work &work) {
    work(edge_tree_, mesh_.edges, [](const SweptBoxes &boxes, int i) { return boxes.of_edge(i); });
    work(point_tree_, points_, [&](const SweptBoxes &boxes, int i) { return boxes.of_vertex(points_[i][0]); });
    work(triangle_tree_, mesh_.triangles, [](const SweptBoxes &boxes, int i) { return boxes.of_triangle(i); });
}

void BroadPhase::fit(const SweptBoxes &boxes) {
    std::fill(escaped_.begin(), escaped_.end(), 0);
    for_trees([&](Bvh &tree, const auto &primitives, const auto &box_of) {
        tree.fit(int(primitives.size()), [&](int i) {
            SweptBox box = box_of(boxes, i);
            box.set_flags(true, any_of(mesh_.moves, primitives[i]));
            return box;
        });
    });
}

// Fits the hierarchies to new boxes of `stale` vertices; only primitives with a changed vertex, which is one of them, are
// active then.
template <class Boxes> void BroadPhase::refit(View<unsigned char> stale, View<unsigned char> changed, const Boxes &boxes_of) {
    const MeshSubset subset(mesh_, incidence_, stale);
    std::vector<int> points;
    for (const int v : subset.vertices)
        if (point_of_[v] >= 0) points.push_back(point_of_[v]);
    for_trees([&](Bvh &tree, const auto &primitives, const auto &box_of) {
        tree.deactivate();
        if (primitives.empty()) return;
        tree.refit(&tree == &edge_tree_    ? subset.edges
                   : &tree == &point_tree_ ? points
                                           : subset.triangles,
                   [&](int i) {
                       SweptBox box = box_of(boxes_of(primitives[i]), i);
                       box.set_flags(any_of(changed, primitives[i]), any_of(mesh_.moves, primitives[i]));
                       return box;
                   });
    });
}

std::vector<PrimitivePair> BroadPhase::find_changed(const SweptBoxes &boxes, View<unsigned char> changed) {
    std::vector<unsigned char> stale(escaped_.size());
    parallel_for(int(stale.size()), [&](int v) { stale[v] = std::exchange(escaped_[v], 0) | changed[v]; });
    refit(stale, changed, [&](const auto &) -> const SweptBoxes & { return boxes; });
    return search_all(boxes);
}

std::vector<PrimitivePair> BroadPhase::find_escaped(const SweptBoxes &move, const SweptBoxes &bounds,
                                                    View<unsigned char> escaped, View<unsigned char> changed) {
    std::vector<unsigned char> stale(escaped_.size());
    parallel_for(int(stale.size()), [&](int v) {
        stale[v] = changed[v] | (escaped[v] != escaped_[v]);
        escaped_[v] = escaped[v];
    });
    refit(stale, changed,
          [&](const auto &vertices) -> const SweptBoxes & { return any_of(escaped, vertices) ? move : bounds; });
    std::vector<PrimitivePair> found = search_all(move);
    std::erase_if(found, [&](const PrimitivePair &pair) {
        return with_vertices(mesh_, pair,
                             [&](const auto &a, const auto &b) { return !any_of(escaped, a) && !any_of(escaped, b); });
    });
    return found;
}

std::vector<PrimitivePair> BroadPhase::search_all(const SweptBoxes &boxes, const SweptBoxes *move) {
    std::vector<PrimitivePair> all;
    search(edge_tree_, mesh_.edges, edge_tree_, mesh_.edges, boxes, move);
    gather(mesh_.edges.size(), all);
    if (points_.empty() || mesh_.triangles.empty()) return all;
    search(point_tree_, points_, triangle_tree_, mesh_.triangles, boxes, nullptr);
    for (Pairs &found : found_)
        for (PrimitivePair &pair : found) pair.primitive[0] = mesh_.points[pair.primitive[0]];
    gather(mesh_.moves.size(), all);
    return all;
}

template <class A, class B>
void BroadPhase::search(const Bvh &tree_a, const A &all_a, const Bvh &tree_b, const B &all_b, const SweptBoxes &boxes,
                        const SweptBoxes *move) {
    for (Pairs &found : found_) found.clear();
    if (tree_a.empty()) return;
    const std::vector<NodePair> starts = split(tree_a, tree_b, boxes.is_static());
    if (found_.size() < starts.size()) found_.resize(starts.size());
    const auto take = [&](const NodePair &slots, Pairs &found) {
        const auto [i, j] = slots.of;
        const bool one_tree = &tree_a == &tree_b;
        int p = tree_a.primitive(i), q = tree_b.primitive(j);
        if (one_tree && p > q) std::swap(p, q); // before its activation distance, whose last bits have an order
        const auto &a = all_a[p];
        const auto &b = all_b[q];
        if (share_vertex(a, b) || anchored(mesh_, a, b)) return;
        const double d_hat = activation_distance(mesh_, a, b);
        if (mesh_.object[a[0]] == mesh_.object[b[0]]) { // boxes have the whole radii
            const auto less = static_cast<float>(mean_radius(mesh_, a) + mean_radius(mesh_, b) - d_hat);
            if (less > 0.0f && !overlap_at_one_time(tree_a.box(i), tree_b.box(j), less)) return;
        }
        found.push_back({{p, q}, one_tree, d_hat});
    };
    parallel_chunks(int(starts.size()), 1, [&](int task) {
        Traversal here = traversal(tree_a, tree_b, boxes.is_static());
        descend(here, starts[task], [&] {
            if (std::is_same_v<A, B> && boxes.is_static()) cull_edges(tree_a, boxes, move, here);
            for (int k = 0; k < here.found; ++k) take(here.boxes[k], found_[task]);
        });
    });
}

// Appends the pairs of all tasks, sorted: into bins by the first of a pair, which is below `firsts`, then within bins.
void BroadPhase::gather(size_t firsts, Pairs &all) {
    const auto each = [&](int task, const auto &add) {
        for (const PrimitivePair &pair : found_[task]) add(pair.primitive[0], pair);
    };
    size_t count = 0;
    for (const Pairs &found : found_) count += found.size();
    const Lists<PrimitivePair> bins(firsts, int(found_.size()), each, count);
    const size_t before_these = all.size();
    all.resize(before_these + count);
    parallel_chunks(int(firsts), 1024, [&](int i) {
        const auto begin = all.begin() + ptrdiff_t(before_these) + bins.begin(i);
        std::sort(begin, std::copy(bins.of(i).begin(), bins.of(i).end(), begin),
                  [](const PrimitivePair &a, const PrimitivePair &b) { return a.primitive[1] < b.primitive[1]; });
    });
}

} // namespace ringlet
