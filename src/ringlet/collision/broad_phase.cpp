#include "ringlet/collision/broad_phase.h"

#include <algorithm>
#include <limits>
#include <numeric>
#include <type_traits>

namespace ringlet {
namespace {

using Pair = std::array<int, 2>; // two primitives

Traversal traversal(const Bvh &a, const Bvh &b, bool is_static) {
    Traversal traversal;
    traversal.a = a.nodes(), traversal.b = b.nodes(), traversal.one_tree = &a == &b, traversal.is_static = is_static;
    traversal.left = traversal.found = 0;
    return traversal;
}

// The pairs of nodes from which tasks descend.
std::vector<NodePair> split(const Bvh &a, const Bvh &b, bool is_static) {
    std::vector<NodePair> pairs = {{{0, 0}}};
    Traversal below = traversal(a, b, is_static);
    for (bool split = true; split && pairs.size() < collision::traversal_tasks;) {
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

// The sum of the radii of two primitives, less their activation distance.
template <size_t N, size_t M>
float excess(const CollisionMesh &mesh, const std::array<int, N> &a, const std::array<int, M> &b) {
    if (mesh.object[a[0]] != mesh.object[b[0]]) return 0.0f;
    return static_cast<float>(mean_radius(mesh, a) + mean_radius(mesh, b) - activation_distance(mesh, a, b));
}

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
void cull_edges(const Bvh &edges, const SweptBoxes &bounds, const SweptBoxes *move, Traversal &found) {
    const auto in_triangles = [](const MovingEdgePairs &some) { return RINGLET_DISPATCH(separated_in_triangles, some); };
    const auto in_boxes = [](const BoxedEdgePairs &some) { return RINGLET_DISPATCH(separated_in_boxes, some); };
    if (move != nullptr)
        cull<MovingEdgePairs>(edges, *move, in_triangles, found);
    else
        cull<BoxedEdgePairs>(edges, bounds, in_boxes, found);
}

} // namespace

BroadPhase::BroadPhase(const CollisionMesh &mesh) : mesh_(mesh), incidence_(mesh) {
    point_of_.assign(mesh.moves.size(), -1);
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

void BroadPhase::find(const SweptBoxes &boxes, Candidates &candidates, View<unsigned char> changed, const SweptBoxes *move) {
    for_trees([&](Bvh &tree, const auto &primitives, const auto &box_of) {
        tree.fit(int(primitives.size()), [&](int i) {
            SweptBox box = box_of(boxes, i);
            box.set_flags(changed.empty() || any_of(changed, primitives[i]), any_of(mesh_.moves, primitives[i]));
            return box;
        });
    });
    search_all(boxes, candidates, move);
    unbounded_.assign(mesh_.moves.size(), 0);
}

void BroadPhase::find_escaped(const SweptBoxes &move, const SweptBoxes &bounds, View<unsigned char> escaped,
                              View<unsigned char> changed, Candidates &candidates) {
    stale_ = unbounded_;
#pragma omp parallel for schedule(static)
    for (size_t v = 0; v < escaped.size(); ++v) {
        const bool leaves = escaped[v] && &move != &bounds;
        stale_[v] |= leaves || changed[v];
        unbounded_[v] = leaves;
    }
    const MeshSubset stale(mesh_, incidence_, stale_);
    std::vector<int> points;
    for (const int v : stale.vertices)
        if (point_of_[v] >= 0) points.push_back(point_of_[v]);
    for_trees([&](Bvh &tree, const auto &primitives, const auto &box_of) {
        tree.deactivate();
        if (primitives.empty()) return;
        tree.refit(&tree == &edge_tree_    ? stale.edges
                   : &tree == &point_tree_ ? points
                                           : stale.triangles,
                   [&](int i) {
                       SweptBox box = box_of(any_of(escaped, primitives[i]) ? move : bounds, i);
                       box.set_flags(any_of(changed, primitives[i]), any_of(mesh_.moves, primitives[i]));
                       return box;
                   });
    });
    search_all(move, candidates);
    const auto neither = [&](const auto &a, const auto &b) { return !any_of(escaped, a) && !any_of(escaped, b); };
    std::erase_if(candidates.edge_edge, [&](const Pair &pair) { return neither(mesh_.edges[pair[0]], mesh_.edges[pair[1]]); });
    std::erase_if(candidates.point_triangle,
                  [&](const Pair &pair) { return neither(std::array{pair[0]}, mesh_.triangles[pair[1]]); });
}

void BroadPhase::search_all(const SweptBoxes &boxes, Candidates &candidates, const SweptBoxes *move) {
    search(edge_tree_, mesh_.edges, edge_tree_, mesh_.edges, boxes, move);
    gather(mesh_.edges.size(), candidates.edge_edge);
    candidates.point_triangle.clear();
    if (points_.empty() || mesh_.triangles.empty()) return;
    search(point_tree_, points_, triangle_tree_, mesh_.triangles, boxes, nullptr);
    for (Pairs &found : found_)
        for (auto &pair : found) pair[0] = mesh_.points[pair[0]];
    gather(mesh_.moves.size(), candidates.point_triangle);
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
        int p = tree_a.primitive(i), q = tree_b.primitive(j);
        const auto &a = all_a[p];
        const auto &b = all_b[q];
        if (share_vertex(a, b) || anchored(mesh_, a, b)) return;
        const float less = excess(mesh_, a, b);
        if (less > 0.0f && !overlap_at_one_time(tree_a.box(i), tree_b.box(j), less)) return;
        if (&tree_a == &tree_b && p > q) std::swap(p, q);
        found.push_back({p, q});
    };
#pragma omp parallel
    {
        Traversal here = traversal(tree_a, tree_b, boxes.is_static());
#pragma omp for schedule(dynamic, 1)
        for (size_t task = 0; task < starts.size(); ++task) {
            here.nodes[0] = starts[task];
            for (here.left = 1; here.left > 0; here.found = 0) {
                RINGLET_DISPATCH(traverse, here, std::numeric_limits<int>::max());
                if (std::is_same_v<A, B> && boxes.is_static()) cull_edges(tree_a, boxes, move, here);
                for (int k = 0; k < here.found; ++k) take(here.boxes[k], found_[task]);
            }
        }
    }
}

// Sorts the pairs of all tasks: into bins by the first of a pair, which is below `firsts`, then within bins.
void BroadPhase::gather(size_t firsts, Pairs &sorted) {
    std::vector<int> bins(firsts + 1, 0);
    for (const Pairs &found : found_)
        for (const auto &pair : found) ++bins[pair[0]];
    std::exclusive_scan(bins.begin(), bins.end(), bins.begin(), 0);
    sorted.resize(bins.back());
    for (const Pairs &found : found_)
        for (const auto &pair : found) sorted[bins[pair[0]]++] = pair; // bins[i] becomes the end of bin i
#pragma omp parallel for schedule(dynamic, 1024)
    for (size_t i = 0; i < firsts; ++i) std::sort(sorted.begin() + (i == 0 ? 0 : bins[i - 1]), sorted.begin() + bins[i]);
}

} // namespace ringlet
