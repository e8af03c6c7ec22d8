#include "ringlet/contact/broad_phase.h"

#include <algorithm>
#include <numeric>

namespace ringlet {
namespace {

using Pair = std::array<int, 2>; // two nodes

constexpr size_t tasks = 256; // at least, where there are as many: the same for any number of threads

// Calls visit(pair) for the pairs of children of a pair of nodes that are not both leaves.
template <class Visit> void for_children(const MovingTree &a, const MovingTree &b, Pair pair, const Visit &visit) {
    const auto [i, j] = pair;
    if (&a == &b && i == j) {
        visit({2 * i + 1, 2 * i + 1});
        visit({2 * i + 2, 2 * i + 2});
        visit({2 * i + 1, 2 * i + 2});
        return;
    }
    const bool split_a = !a.is_leaf(i), split_b = !b.is_leaf(j);
    for (int u = split_a ? 2 * i + 1 : i; u <= (split_a ? 2 * i + 2 : i); ++u)
        for (int v = split_b ? 2 * j + 1 : j; v <= (split_b ? 2 * j + 2 : j); ++v) visit({u, v});
}

bool may_meet(const MovingTree &a, const MovingTree &b, Pair pair) {
    return (&a == &b && pair[0] == pair[1]) || may_meet(a.node(pair[0]), b.node(pair[1]));
}

bool are_leaves(const MovingTree &a, const MovingTree &b, Pair pair) { return a.is_leaf(pair[0]) && b.is_leaf(pair[1]); }

template <class Meet> void descend(const MovingTree &a, const MovingTree &b, Pair pair, const Meet &meet) {
    if (!may_meet(a, b, pair)) return;
    if (!are_leaves(a, b, pair)) return for_children(a, b, pair, [&](Pair child) { descend(a, b, child, meet); });
    const MovingTree::Leaf first = a.leaf(pair[0]), second = b.leaf(pair[1]);
    const bool itself = &a == &b && pair[0] == pair[1];
    for (int i = first.begin; i < first.end; ++i)
        for (int j = itself ? i + 1 : second.begin; j < second.end; ++j)
            if (may_meet(a.box(i), b.box(j))) meet(i, j);
}

// The pairs of nodes to descend from, one for each task.
std::vector<Pair> split(const MovingTree &a, const MovingTree &b) {
    std::vector<Pair> pairs = {{0, 0}};
    for (bool split = true; split && pairs.size() < tasks;) {
        split = false;
        std::vector<Pair> finer;
        for (Pair pair : pairs)
            if (!may_meet(a, b, pair))
                continue;
            else if (are_leaves(a, b, pair))
                finer.push_back(pair);
            else {
                split = true;
                for_children(a, b, pair, [&](Pair child) { finer.push_back(child); });
            }
        pairs = std::move(finer);
    }
    return pairs;
}

template <size_t N> bool any_moves(const CollisionMesh &mesh, const std::array<int, N> &primitive) {
    return std::any_of(primitive.begin(), primitive.end(), [&](int v) { return mesh.moves[v] != 0; });
}

// Whether two primitives whose boxes may meet are a candidate.
template <size_t N, size_t M>
bool candidate(const CollisionMesh &mesh, const std::array<int, N> &a, const std::array<int, M> &b, const MovingBox &box_a,
               const MovingBox &box_b) {
    if (share_vertex(a, b)) return false;
    double less = 0.0;
    if (mesh.object[a[0]] == mesh.object[b[0]])
        less = mean_radius(mesh, a) + mean_radius(mesh, b) - contact_distance(mesh, a, b);
    return meet_at_one_time(box_a, box_b, static_cast<float>(less)) && !carries(mesh, a, b);
}

} // namespace

BroadPhase::BroadPhase(const CollisionMesh &mesh) : mesh_(mesh) {
    for (int v : mesh.points) points_.push_back({v});
}

void BroadPhase::find(View<Vec3> start, View<Vec3> end, double margin, Candidates &candidates) {
    place(start, end);
    fit(edge_tree_, mesh_.edges, margin);
    search(edge_tree_, edge_tree_, [&](int i, int j, Pairs &found) {
        const auto [a, b] = std::minmax(edge_tree_.order()[i], edge_tree_.order()[j]);
        if (candidate(mesh_, mesh_.edges[a], mesh_.edges[b], edge_tree_.box(i), edge_tree_.box(j))) found.push_back({a, b});
    });
    gather(mesh_.edges.size(), candidates.edge_edge);

    fit(point_tree_, points_, margin);
    fit(triangle_tree_, mesh_.triangles, margin);
    search(point_tree_, triangle_tree_, [&](int i, int j, Pairs &found) {
        const std::array<int, 1> &point = points_[point_tree_.order()[i]];
        const int triangle = triangle_tree_.order()[j];
        if (candidate(mesh_, point, mesh_.triangles[triangle], point_tree_.box(i), triangle_tree_.box(j)))
            found.push_back({point[0], triangle});
    });
    gather(start.size(), candidates.point_triangle);
}

// In the frame of the first vertex: where the scene is and how fast it flies as a whole costs no precision.
void BroadPhase::place(View<Vec3> start, View<Vec3> end) {
    const int count = static_cast<int>(start.size());
    places_.resize(count);
    motions_.resize(count);
    if (count == 0) return;
    const Vec3 origin = start[0], shared = end[0] - start[0];
#pragma omp parallel for schedule(static)
    for (int v = 0; v < count; ++v) {
        places_[v] << (start[v] - origin).cast<float>().array(), 0.0f;
        motions_[v] << (end[v] - start[v] - shared).cast<float>().array(), 0.0f;
    }
}

template <class Primitives> void BroadPhase::fit(MovingTree &tree, const Primitives &primitives, double margin) {
    const int count = static_cast<int>(primitives.size());
    boxes_.resize(count);
#pragma omp parallel for schedule(static)
    for (int i = 0; i < count; ++i) {
        const auto &primitive = primitives[i];
        MovingBox box{places_[primitive[0]], places_[primitive[0]], motions_[primitive[0]], motions_[primitive[0]]};
        for (int v : primitive) box.include({places_[v], places_[v], motions_[v], motions_[v]});
        box.widen(static_cast<float>(mean_radius(mesh_, primitive) + 0.5 * margin), any_moves(mesh_, primitive));
        boxes_[i] = box;
    }
    tree.fit(boxes_);
}

template <class Accept> void BroadPhase::search(const MovingTree &a, const MovingTree &b, const Accept &accept) {
    for (Pairs &found : found_) found.clear();
    if (a.empty() || b.empty()) return;
    const std::vector<Pair> starts = split(a, b);
    if (found_.size() < starts.size()) found_.resize(starts.size());
#pragma omp parallel for schedule(dynamic, 1)
    for (size_t task = 0; task < starts.size(); ++task)
        descend(a, b, starts[task], [&](int i, int j) { accept(i, j, found_[task]); });
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
