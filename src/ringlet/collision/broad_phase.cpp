#include "ringlet/collision/broad_phase.h"

#include <algorithm>
#include <limits>
#include <numeric>
#include <type_traits>

namespace ringlet {
namespace {

using Pair = std::array<int, 2>; // two primitives

constexpr size_t tasks = 256; // at least, where there are as many: the same for any number of threads

Descent descent(const MovingTree &a, const MovingTree &b, bool still) {
    Descent descent;
    descent.a = a.boxes(), descent.b = b.boxes(), descent.one_tree = &a == &b, descent.still = still;
    descent.left = descent.found = 0;
    return descent;
}

// The pairs of nodes to descend from, one for each task.
std::vector<BoxPair> split(const MovingTree &a, const MovingTree &b, bool still) {
    std::vector<BoxPair> pairs = {{{0, 0}}};
    Descent below = descent(a, b, still);
    for (bool split = true; split && pairs.size() < tasks;) {
        split = false;
        std::vector<BoxPair> finer;
        for (const BoxPair &pair : pairs)
            if (a.is_leaf(pair.of[0]) && b.is_leaf(pair.of[1]))
                finer.push_back(pair);
            else {
                split = true;
                below.nodes[0] = pair, below.left = 1;
                RINGLET_DISPATCH(descend, below, 1);
                finer.insert(finer.end(), below.nodes, below.nodes + below.left);
            }
        pairs = std::move(finer);
    }
    return pairs;
}

// By how much the contact distance of two primitives is less than their radii together.
template <size_t N, size_t M> float less(const CollisionMesh &mesh, const std::array<int, N> &a, const std::array<int, M> &b) {
    if (mesh.object[a[0]] != mesh.object[b[0]]) return 0.0f;
    return static_cast<float>(mean_radius(mesh, a) + mean_radius(mesh, b) - contact_distance(mesh, a, b));
}

// Leaves the pairs of edges of which `apart` says nothing, in order: it is asked of as many of them at a time as there is room
// for side by side.
template <class SideBySide, class Apart>
void leave_out(const MovingTree &edges, const PathBoxes &boxes, const Apart &apart, Descent &found) {
    SideBySide some = {};
    int kept = 0;
    for (int first = 0; first < found.found; first += SideBySide::room) {
        const int count = std::min(found.found - first, SideBySide::room);
        const BoxPair *pairs = found.boxes + first;
        boxes.put(some, count,
                  [&](int k) { return std::array{edges.primitive(pairs[k].of[0]), edges.primitive(pairs[k].of[1])}; });
        const unsigned out = apart(some);
        for (int k = 0; k < count; ++k)
            if (!(out >> k & 1u)) found.boxes[kept++] = pairs[k];
    }
    found.found = kept;
}

// Of pairs of edges that stay in their corridors, or on a move, those of which boxes tell little: that are long and askew.
void leave_out_apart(const MovingTree &edges, const PathBoxes &corridors, const PathBoxes *move, Descent &found) {
    if (move != nullptr)
        leave_out<EdgeWays>(edges, *move, [](const EdgeWays &some) { return RINGLET_DISPATCH(apart_anywhere, some); }, found);
    else
        leave_out<EdgePairs>(edges, corridors, [](const EdgePairs &some) { return RINGLET_DISPATCH(apart, some); }, found);
}

} // namespace

BroadPhase::BroadPhase(const CollisionMesh &mesh) : mesh_(mesh), incidence_(mesh) {
    point_of_.assign(mesh.moves.size(), -1);
    for (int v : mesh.points) {
        point_of_[v] = int(points_.size());
        points_.push_back({v});
    }
}

void BroadPhase::find(const PathBoxes &ways, Candidates &candidates, View<unsigned char> changed, const PathBoxes *move) {
    const auto fit = [&](MovingTree &tree, const auto &primitives, const auto &box_of) {
        tree.fit(int(primitives.size()), [&](int i) {
            MovingBox box = box_of(primitives[i], i);
            box.count(changed.empty() || any_of(changed, primitives[i]), any_of(mesh_.moves, primitives[i]));
            return box;
        });
    };
    fit(edge_tree_, mesh_.edges, [&](const auto &, int i) { return ways.of_edge(i); });
    fit(point_tree_, points_, [&](const auto &point, int) { return ways.of_vertex(point[0]); });
    fit(triangle_tree_, mesh_.triangles, [&](const auto &, int i) { return ways.of_triangle(i); });
    search_all(ways, candidates, move);
    away_.assign(mesh_.moves.size(), 0);
}

void BroadPhase::find_quick(const PathBoxes &ways, const PathBoxes &homes, View<unsigned char> quick,
                            View<unsigned char> changed, Candidates &candidates) {
    stale_ = away_;
    for (size_t v = 0; v < quick.size(); ++v) {
        const bool leaves = quick[v] && &ways != &homes;
        stale_[v] |= leaves || changed[v];
        away_[v] = leaves;
    }
    for (MovingTree *tree : {&edge_tree_, &point_tree_, &triangle_tree_}) tree->discount();
    const Affected stale(mesh_, incidence_, stale_);
    const auto refit = [&](MovingTree &tree, const std::vector<int> &some, const auto &primitives, const auto &box_of) {
        if (primitives.empty()) return;
        tree.refit(some, [&](int i) {
            MovingBox box = box_of(any_of(quick, primitives[i]) ? ways : homes, primitives[i], i);
            box.count(any_of(changed, primitives[i]), any_of(mesh_.moves, primitives[i]));
            return box;
        });
    };
    refit(edge_tree_, stale.edges, mesh_.edges, [](const PathBoxes &boxes, const auto &, int i) { return boxes.of_edge(i); });
    std::vector<int> points;
    for (const int v : stale.vertices)
        if (point_of_[v] >= 0) points.push_back(point_of_[v]);
    refit(point_tree_, points, points_,
          [](const PathBoxes &boxes, const auto &point, int) { return boxes.of_vertex(point[0]); });
    refit(triangle_tree_, stale.triangles, mesh_.triangles,
          [](const PathBoxes &boxes, const auto &, int i) { return boxes.of_triangle(i); });
    search_all(ways, candidates);
    const auto neither = [&](const auto &a, const auto &b) { return !any_of(quick, a) && !any_of(quick, b); };
    std::erase_if(candidates.edge_edge, [&](const Pair &pair) { return neither(mesh_.edges[pair[0]], mesh_.edges[pair[1]]); });
    std::erase_if(candidates.point_triangle,
                  [&](const Pair &pair) { return neither(std::array{pair[0]}, mesh_.triangles[pair[1]]); });
}

void BroadPhase::search_all(const PathBoxes &ways, Candidates &candidates, const PathBoxes *move) {
    search(edge_tree_, mesh_.edges, edge_tree_, mesh_.edges, ways, move);
    gather(mesh_.edges.size(), candidates.edge_edge);
    candidates.point_triangle.clear();
    if (points_.empty() || mesh_.triangles.empty()) return;
    search(point_tree_, points_, triangle_tree_, mesh_.triangles, ways, nullptr);
    for (Pairs &found : found_)
        for (auto &pair : found) pair[0] = mesh_.points[pair[0]];
    gather(mesh_.moves.size(), candidates.point_triangle);
}

template <class A, class B>
void BroadPhase::search(const MovingTree &tree_a, const A &all_a, const MovingTree &tree_b, const B &all_b,
                        const PathBoxes &ways, const PathBoxes *move) {
    for (Pairs &found : found_) found.clear();
    if (tree_a.empty()) return;
    const std::vector<BoxPair> starts = split(tree_a, tree_b, ways.still());
    if (found_.size() < starts.size()) found_.resize(starts.size());
    const auto take = [&](const BoxPair &slots, Pairs &found) {
        const auto [i, j] = slots.of;
        int p = tree_a.primitive(i), q = tree_b.primitive(j);
        const auto &a = all_a[p];
        const auto &b = all_b[q];
        if (share_vertex(a, b) || carries(mesh_, a, b)) return;
        const float by = less(mesh_, a, b);
        if (by > 0.0f && !meet_at_one_time(tree_a.box(i), tree_b.box(j), by)) return;
        if (&tree_a == &tree_b && p > q) std::swap(p, q);
        found.push_back({p, q});
    };
#pragma omp parallel
    {
        Descent here = descent(tree_a, tree_b, ways.still());
#pragma omp for schedule(dynamic, 1)
        for (size_t task = 0; task < starts.size(); ++task) {
            here.nodes[0] = starts[task];
            for (here.left = 1; here.left > 0; here.found = 0) {
                RINGLET_DISPATCH(descend, here, std::numeric_limits<int>::max());
                if (std::is_same_v<A, B> && ways.still()) leave_out_apart(tree_a, ways, move, here); // edges
                for (int k = 0; k < here.found; ++k) take(here.boxes[k], found_[task]);
            }
        }
    }
}

// Sorts what the tasks have found: by the first of a pair, whose number is below `firsts`, into bins, and then each bin.
void BroadPhase::gather(size_t firsts, Pairs &sorted) {
    std::vector<int> bins(firsts + 1, 0);
    for (const Pairs &found : found_)
        for (const auto &pair : found) ++bins[pair[0]];
    std::exclusive_scan(bins.begin(), bins.end(), bins.begin(), 0);
    sorted.resize(bins.back());
    for (const Pairs &found : found_)
        for (const auto &pair : found) sorted[bins[pair[0]]++] = pair; // bins[i] is then where bin i ends
#pragma omp parallel for schedule(dynamic, 1024)
    for (size_t i = 0; i < firsts; ++i) std::sort(sorted.begin() + (i == 0 ? 0 : bins[i - 1]), sorted.begin() + bins[i]);
}

} // namespace ringlet
