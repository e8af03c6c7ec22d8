// The collision mesh: curves and surfaces in one list of vertices, with the distance at which two primitives activate.
#pragma once

#include "ringlet/geometry/distance.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

// Constants that decide which pairs collision detection returns.
namespace ringlet::collision {

// Activation distance of two primitives of one object, or of two that cannot yield, as a fraction.
inline constexpr double rest_fraction = 0.9;         // of their distance at rest, at most
inline constexpr double yield_fraction = 0.25;       // of the lengths over which both yield, or else of that distance
inline constexpr double least_d_hat_fraction = 0.01; // of the sum of their radii, at least: else rounding picks a side

// Culling of candidate pairs.
inline constexpr double impact_distance = 0.5; // of d_hat: pairs that keep more have no impact
inline constexpr double impact_reach = 0.6;    // of d_hat: culling for impacts is conservative

} // namespace ringlet::collision

namespace ringlet {

// Two primitives of a mesh.
struct PrimitivePair {
    std::array<int, 2> primitive; // two edges, the lower index first; or a vertex and a triangle
    bool edge_edge;
    double d_hat; // activation distance: the pair is in contact below it [m]
};

// The order of pairs: those of edges come first.
template <class Pair> bool before(const Pair &a, const Pair &b) {
    return a.edge_edge != b.edge_edge ? a.edge_edge : a.primitive < b.primitive;
}

// One curve or surface: its vertices, and how it yields to an impact.
struct CollisionObject {
    int first, end;
    bool whole = false; // its move is scaled as a whole, so that it keeps its shape; otherwise it is corrected near the impact
};

struct CollisionMesh {
    std::vector<std::array<int, 2>> edges;
    int curve_edges = 0; // the first edges are those of curves, which bound no triangle
    std::vector<std::array<int, 3>> triangles;
    std::vector<int> points;              // the vertices that are tested against triangles
    std::vector<CollisionObject> objects; // in the order of their vertices

    // Per vertex:
    std::vector<double> radius;       // half the thickness [m]
    std::vector<unsigned char> moves; // 0: kinematic, as bodies and prescribed vertices are; kinematic pairs are ignored
    std::vector<int> object;          // the object that it belongs to
    std::vector<int> anchor;          // the object that it is anchored to, which it may touch; −1: none
    std::vector<Vec3> rest;           // position at rest [m]
    std::vector<double> yield;        // length of curve between it and what is prescribed [m], 0 on bodies; empty: infinite

    std::vector<PrimitivePair> exempt; // pairs that are never tested, in order

    // Per vertex of curves, which come first: activation distances [m] of the edge from it to the next vertex and the edges
    // that begin two or more vertices later. Cached, since every search asks for them.
    static constexpr int asked_often = 8;
    std::vector<std::array<double, asked_often>> along_curve;
};

// Merges two ordered lists of pairs into `pairs`.
template <class Pair> void merge(std::vector<Pair> &pairs, const std::vector<Pair> &more) {
    const size_t size = pairs.size();
    pairs.insert(pairs.end(), more.begin(), more.end());
    std::inplace_merge(pairs.begin(), pairs.begin() + size, pairs.end(), before<Pair>);
}

// Calls work with the vertices of both primitives.
template <class Pair, class Work> auto with_vertices(const CollisionMesh &mesh, const Pair &pair, const Work &work) {
    if (pair.edge_edge) return work(mesh.edges[pair.primitive[0]], mesh.edges[pair.primitive[1]]);
    return work(std::array{pair.primitive[0]}, mesh.triangles[pair.primitive[1]]);
}

// The radius of a primitive is the mean over its vertices.
template <size_t N> double mean_radius(const CollisionMesh &mesh, const std::array<int, N> &primitive) {
    double sum = 0.0;
    for (int v : primitive) sum += mesh.radius[v];
    return sum / N;
}

template <size_t N, size_t M> bool share_vertex(const std::array<int, N> &a, const std::array<int, M> &b) {
    for (int v : a)
        for (int w : b)
            if (v == w) return true;
    return false;
}

// Whether a vertex of a primitive is marked.
template <size_t N> bool any_of(View<unsigned char> marked, const std::array<int, N> &primitive) {
    return std::any_of(primitive.begin(), primitive.end(), [&](int v) { return marked[v] != 0; });
}

// Whether one of two objects is marked; those beyond the marks are not, nor is −1: none.
inline bool any_marked(const std::array<int, 2> &objects, View<unsigned char> marked) {
    const auto is_marked = [&](int object) { return size_t(object) < marked.size() && marked[object] != 0; };
    return is_marked(objects[0]) || is_marked(objects[1]);
}

// Whether a vertex of one primitive is anchored to the object of the other.
template <size_t N, size_t M>
bool anchored(const CollisionMesh &mesh, const std::array<int, N> &a, const std::array<int, M> &b) {
    for (int v : a)
        if (mesh.anchor[v] == mesh.object[b[0]]) return true;
    for (int v : b)
        if (mesh.anchor[v] == mesh.object[a[0]]) return true;
    return false;
}

inline ClosestPoints closest_points(View<Vec3> x, const std::array<int, 2> &a, const std::array<int, 2> &b) {
    return closest_edge_edge(x[a[0]], x[a[1]], x[b[0]], x[b[1]]);
}

inline ClosestPoints closest_points(View<Vec3> x, const std::array<int, 1> &p, const std::array<int, 3> &t) {
    return closest_point_triangle(x[p[0]], x[t[0]], x[t[1]], x[t[2]]);
}

// Upper bound on how much nearer two primitives come that move straight; a shared motion does not count [m].
template <size_t N, size_t M>
double max_approach(const std::array<int, N> &a, const std::array<int, M> &b, View<Vec3> start, View<Vec3> end) {
    double most = 0.0;
    for (const int v : a)
        for (const int w : b) most = std::max(most, ((end[v] - start[v]) - (end[w] - start[w])).squaredNorm());
    return std::sqrt(most);
}

// Largest distance of a primitive's vertices from its first one at rest [m].
template <size_t N> double rest_extent(const CollisionMesh &mesh, const std::array<int, N> &primitive) {
    double most = 0.0;
    for (int v : primitive) most = std::max(most, (mesh.rest[v] - mesh.rest[primitive[0]]).squaredNorm());
    return std::sqrt(most);
}

// How far a primitive yields [m]: the largest length of curve between a vertex of it and what is prescribed.
template <size_t N> double yield(const CollisionMesh &mesh, const std::array<int, N> &primitive) {
    if (mesh.yield.empty()) return std::numeric_limits<double>::infinity();
    double most = 0.0;
    for (int v : primitive) most = std::max(most, mesh.yield[v]);
    return most;
}

// The activation distance d_hat of two primitives [m]: the sum of their radii. Within one object it is at most nine tenths of
// their distance at rest, so that neighbours along a curve never repel each other; but at least a hundredth of the radii.
// Near what is prescribed the same holds for two objects: curves shorter than their activation distance could part only by
// stretch. There it is at most that distance or a quarter of the lengths over which both yield, whichever is larger.
template <size_t N, size_t M>
double activation_distance(const CollisionMesh &mesh, const std::array<int, N> &a, const std::array<int, M> &b) {
    if constexpr (N == 2 && M == 2) {
        const size_t first = std::min(a[0], b[0]), further = std::abs(a[0] - b[0]) - 2;
        if (first < mesh.along_curve.size() && further < mesh.asked_often && mesh.object[a[0]] == mesh.object[b[0]])
            return mesh.along_curve[first][further];
    }
    const double radii = mean_radius(mesh, a) + mean_radius(mesh, b);
    double least = collision::least_d_hat_fraction * radii;
    if (mesh.object[a[0]] != mesh.object[b[0]])
        least = std::max(least, collision::yield_fraction * (yield(mesh, a) + yield(mesh, b)));
    if (least >= radii) return radii;
    // A lower bound on the distance at rest settles most pairs.
    const double gap = (mesh.rest[a[0]] - mesh.rest[b[0]]).norm() - rest_extent(mesh, a) - rest_extent(mesh, b);
    if (collision::rest_fraction * gap >= radii) return radii;
    return std::clamp(collision::rest_fraction * std::sqrt(closest_points(mesh.rest, a, b).distance2), least, radii);
}

// Fills `along_curve` of a mesh that has its curves alone so far.
inline void cache_activation_distances(CollisionMesh &mesh) {
    std::vector<std::array<double, CollisionMesh::asked_often>> cached(mesh.rest.size());
    for (const auto &[first, end, whole] : mesh.objects)
        for (int v = first; v + 3 < end; ++v)
            for (int w = v + 2; w + 1 < end && w < v + 2 + CollisionMesh::asked_often; ++w)
                cached[v][w - v - 2] = activation_distance(mesh, std::array{v, v + 1}, std::array{w, w + 1});
    mesh.along_curve = std::move(cached);
}

} // namespace ringlet
