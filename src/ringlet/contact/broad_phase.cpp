#include "ringlet/contact/broad_phase.h"

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

// Leaves those pairs that are not apart, in order, and returns how many: puts so many of them side by side as there is room
// for.
template <class SideBySide, class EdgePair, class Put, class Apart>
int leave_out(EdgePair *pairs, int count, const Put &put, const Apart &apart) {
    SideBySide some = {};
    int kept = 0;
    for (int first = 0; first < count; first += SideBySide::room) {
        const int here = std::min(count - first, SideBySide::room);
        put(some, pairs + first, here);
        const unsigned out = apart(some);
        for (int k = 0; k < here; ++k)
            if (!(out >> k & 1u)) pairs[kept++] = pairs[first + k];
    }
    return kept;
}

// Of edges that stay in their corridors, those that are long and askew: of them boxes tell little.
void leave_out_apart(const MovingTree &edges, const PathBoxes &homes, Descent &found) {
    found.found = leave_out<EdgePairs>(
        found.boxes, found.found,
        [&](EdgePairs &some, const BoxPair *pairs, int count) {
            homes.put(some, count,
                      [&](int k) { return std::array{edges.primitive(pairs[k].of[0]), edges.primitive(pairs[k].of[1])}; });
        },
        [](const EdgePairs &some) { return RINGLET_DISPATCH(apart, some); });
}

// Of edges that go anywhere in the triangles of their ways: from there on.
void leave_out_apart(const CollisionMesh &mesh, const PathBoxes &move, size_t from, std::vector<Pair> &found) {
    const int kept = leave_out<EdgeWays>(
        found.data() + from, int(found.size() - from),
        [&](EdgeWays &some, const Pair *pairs, int count) {
            move.put(some, count, [&](int k) { return pairs[k]; });
            for (int k = 0; k < count; ++k)
                some.reach[k] = float(contact_distance(mesh, mesh.edges[pairs[k][0]], mesh.edges[pairs[k][1]])) + move.lost();
        },
        [](const EdgeWays &some) { return RINGLET_DISPATCH(apart_anywhere, some); });
    found.resize(from + kept);
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
                if (std::is_same_v<A, B> && ways.still()) leave_out_apart(tree_a, ways, here); // edges
                const size_t from = found_[task].size();
                for (int k = 0; k < here.found; ++k) take(here.boxes[k], found_[task]);
                if (move != nullptr) leave_out_apart(mesh_, *move, from, found_[task]);
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
