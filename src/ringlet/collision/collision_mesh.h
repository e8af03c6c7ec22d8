// What can touch: strands, cloth and bodies in one list of vertices, and how near two of its primitives may come.
#pragma once

#include "ringlet/geometry/distance.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace ringlet {

struct CollisionMesh {
    std::vector<std::array<int, 2>> edges;     // of strands, cloth and bodies alike
    int strand_edges = 0;                      // of them: the first are those of strands
    std::vector<std::array<int, 3>> triangles; // of cloth and bodies
    std::vector<int> points;                   // the vertices that are tested against triangles

    // Per vertex:
    std::vector<double> radius;       // half the thickness [m]
    std::vector<unsigned char> moves; // 0 where the motion is given: bodies, and what is held; two such primitives never meet
    std::vector<int> object;          // the strand, cloth or body it belongs to
    std::vector<int> anchor; // the object that carries it, which it may touch: the body that a strand is rooted in; −1: none
    std::vector<Vec3> rest;  // position at rest [m]

    // Of the vertices of strands, which are the first: at which distances [m] the edge from it to the next touches the edges
    // from the second next on. Known before they are asked for, which is in every search.
    static constexpr int asked_often = 8;
    std::vector<std::array<double, asked_often>> along_strand;
};

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

// Whether a vertex of a primitive is among those that are marked.
template <size_t N> bool any_of(View<unsigned char> vertices, const std::array<int, N> &primitive) {
    return std::any_of(primitive.begin(), primitive.end(), [&](int v) { return vertices[v] != 0; });
}

inline ClosestPoints closest_points(View<Vec3> x, const std::array<int, 2> &a, const std::array<int, 2> &b) {
    return closest_edge_edge(x[a[0]], x[a[1]], x[b[0]], x[b[1]]);
}

inline ClosestPoints closest_points(View<Vec3> x, const std::array<int, 1> &p, const std::array<int, 3> &t) {
    return closest_point_triangle(x[p[0]], x[t[0]], x[t[1]], x[t[2]]);
}

// How far the vertices of a primitive are from its first at rest [m].
template <size_t N> double extent(const CollisionMesh &mesh, const std::array<int, N> &primitive) {
    double most = 0.0;
    for (int v : primitive) most = std::max(most, (mesh.rest[v] - mesh.rest[primitive[0]]).squaredNorm());
    return std::sqrt(most);
}

// The distance [m] below which two edges, or a point and a triangle, touch: the sum of their radii; within one object at most
// nine tenths of what is between them at rest, so that neighbours along a strand never push each other apart. What is groomed
// through itself touches at a hundredth of their radii: at nothing, rounding would decide on which side it is.
template <size_t N, size_t M>
double contact_distance(const CollisionMesh &mesh, const std::array<int, N> &a, const std::array<int, M> &b) {
    if constexpr (N == 2 && M == 2) {
        const size_t first = std::min(a[0], b[0]), further = std::abs(a[0] - b[0]) - 2;
        if (first < mesh.along_strand.size() && further < mesh.asked_often && mesh.object[a[0]] == mesh.object[b[0]])
            return mesh.along_strand[first][further];
    }
    const double radii = mean_radius(mesh, a) + mean_radius(mesh, b);
    if (mesh.object[a[0]] != mesh.object[b[0]]) return radii;
    constexpr double least = 0.01; // of their radii
    // Most pairs of one object are so far apart at rest that it need not be known how far.
    const double apart = (mesh.rest[a[0]] - mesh.rest[b[0]]).norm() - extent(mesh, a) - extent(mesh, b);
    if (0.9 * apart >= radii) return radii;
    return std::clamp(0.9 * std::sqrt(closest_points(mesh.rest, a, b).distance2), least * radii, radii);
}

// Of strands that begin at `offsets` among the vertices.
inline void know_along_strands(CollisionMesh &mesh, View<int> offsets) {
    std::vector<std::array<double, CollisionMesh::asked_often>> known(offsets.back());
    for (size_t s = 0; s + 1 < offsets.size(); ++s)
        for (int v = offsets[s]; v + 3 < offsets[s + 1]; ++v)
            for (int w = v + 2; w + 1 < offsets[s + 1] && w < v + 2 + CollisionMesh::asked_often; ++w)
                known[v][w - v - 2] = contact_distance(mesh, std::array{v, v + 1}, std::array{w, w + 1});
    mesh.along_strand = std::move(known);
}

// Whether one of the two holds a vertex that the other's object carries.
template <size_t N, size_t M>
bool carries(const CollisionMesh &mesh, const std::array<int, N> &a, const std::array<int, M> &b) {
    for (int v : a)
        if (mesh.anchor[v] == mesh.object[b[0]]) return true;
    for (int v : b)
        if (mesh.anchor[v] == mesh.object[a[0]]) return true;
    return false;
}

// Calls work with the vertices of the two of a pair.
template <class Pair, class Work> auto with_vertices(const CollisionMesh &mesh, const Pair &pair, const Work &work) {
    if (pair.of_edges) return work(mesh.edges[pair.of[0]], mesh.edges[pair.of[1]]);
    return work(std::array{pair.of[0]}, mesh.triangles[pair.of[1]]);
}

} // namespace ringlet
