// A scene of strands, a cloth and a body on a move, and which pairs have impacts and contacts.
#pragma once

#include "ringlet/ccd/time_of_impact.h"
#include "ringlet/collision/move_candidates.h"

#include <cmath>
#include <random>
#include <set>

namespace ringlet {

// Strands in the unit cube that wind among a cloth and a body. The strands are anchored to the body, object 0; the cloth is
// object 1.
struct CollisionScene {
    CollisionMesh mesh;
    std::vector<Vec3> start, end;
    std::mt19937 random;

    explicit CollisionScene(unsigned seed, double motion) : random(seed) {
        add_grid(0, 0.0, false);
        add_grid(1, 0.4, true);
        for (int strand = 0; strand < 30; ++strand) add_strand(2 + strand);
        mesh.rest = start;
        const Vec3 shared = motion * anywhere(1.0);
        for (const Vec3 &x : start) end.push_back(x + shared + motion * anywhere(0.3));
    }

    Vec3 anywhere(double size) {
        std::uniform_real_distribution<double> in(-size, size);
        return Vec3(in(random), in(random), in(random));
    }

    int add(const Vec3 &x, int object, double radius, bool moves, int anchor) {
        start.push_back(x);
        mesh.radius.push_back(radius);
        mesh.moves.push_back(moves);
        mesh.object.push_back(object);
        if (object >= int(mesh.objects.size())) mesh.objects.resize(object + 1, {int(mesh.object.size()) - 1, 0});
        mesh.objects[object].end = int(mesh.object.size());
        mesh.anchor.push_back(anchor);
        mesh.points.push_back(static_cast<int>(start.size()) - 1);
        return mesh.points.back();
    }

    void add_grid(int object, double height, bool moves) { // 6 × 6 vertices
        const int first = static_cast<int>(start.size());
        for (int i = 0; i < 36; ++i) add(Vec3(i / 6 / 5.0, height, i % 6 / 5.0) + anywhere(0.03), object, 0.002, moves, -1);
        for (int i = 0; i < 36; ++i) {
            const int v = first + i;
            const bool right = i % 6 < 5, down = i < 30;
            if (right) mesh.edges.push_back({v, v + 1});
            if (down) mesh.edges.push_back({v, v + 6});
            if (!right || !down) continue;
            mesh.edges.push_back({v, v + 7});
            mesh.triangles.push_back({v, v + 7, v + 1});
            mesh.triangles.push_back({v, v + 6, v + 7});
        }
    }

    void add_strand(int object) { // of 20 vertices, the first two prescribed
        Vec3 x = Vec3::Constant(0.5) + anywhere(0.5);
        x.y() = 0.0;
        for (int k = 0; k < 20; ++k) {
            add(x, object, 0.01, k >= 2, k < 2 ? 0 : -1);
            if (k > 0) mesh.edges.push_back({mesh.points.back() - 1, mesh.points.back()});
            x += Vec3(0.0, 0.015, 0.0) + anywhere(0.03);
        }
    }
};

inline SweptBoxes boxes_of_move(const CollisionMesh &mesh, const std::vector<Vec3> &start, const std::vector<Vec3> &end,
                                double margin) {
    SweptBoxes boxes(mesh);
    boxes.fit({start, end}, {start[0], end[0]}, margin);
    return boxes;
}

using Pairs = std::set<std::array<int, 3>>;

inline std::array<int, 3> name(const PrimitivePair &pair) { return {pair.edge_edge, pair.primitive[0], pair.primitive[1]}; }

// Whether a pair has an impact on straight paths.
inline bool has_impact(const CollisionMesh &mesh, const PrimitivePair &pair, const std::vector<Vec3> &start,
                       const std::vector<Vec3> &end) {
    return with_vertices(mesh, pair, [&](const auto &a, const auto &b) {
        Vec3 x[4], p[4];
        int i = 0;
        for (const int v : a) x[i] = start[v], p[i++] = end[v] - start[v];
        for (const int v : b) x[i] = start[v], p[i++] = end[v] - start[v];
        const double kept = collision::impact_distance * pair.d_hat;
        return (pair.edge_edge ? accd::toi<2>(x, p, kept, accd::closest<2>(x))
                               : accd::toi<1>(x, p, kept, accd::closest<1>(x))) <= 1.0;
    });
}

// The impact candidates that have an impact.
inline Pairs impacts(const CollisionMesh &mesh, const MoveCandidates &pairs, const std::vector<Vec3> &start,
                     const std::vector<Vec3> &end) {
    Pairs found;
    for (const CandidatePair *pair : pairs.impact_candidates())
        if (has_impact(mesh, *pair, start, end)) found.insert(name(*pair));
    return found;
}

inline Pairs contacts(MoveCandidates &pairs, const std::vector<Vec3> &positions) {
    Pairs found;
    const std::vector<unsigned char> all(pairs.candidates().mesh().objects.size(), 1);
    for (const ContactPair &touch : pairs.contact_pairs(positions, all)) found.insert(name(touch));
    return found;
}

template <size_t N> bool any_moves(const CollisionMesh &mesh, const std::array<int, N> &vertices) {
    return std::any_of(vertices.begin(), vertices.end(), [&](int v) { return mesh.moves[v]; });
}

template <class A, class B> bool excluded(const CollisionMesh &mesh, const A &a, const B &b) {
    return share_vertex(a, b) || anchored(mesh, a, b) || (!any_moves(mesh, a) && !any_moves(mesh, b));
}

// All pairs that are tested, wherever they are.
inline std::vector<PrimitivePair> all_pairs(const CollisionMesh &mesh) {
    std::vector<PrimitivePair> pairs;
    const auto add = [&](const PrimitivePair &pair) {
        with_vertices(mesh, pair, [&](const auto &a, const auto &b) {
            if (excluded(mesh, a, b)) return;
            pairs.push_back(pair);
            pairs.back().d_hat = activation_distance(mesh, a, b);
        });
    };
    for (int a = 0; a < int(mesh.edges.size()); ++a)
        for (int b = a + 1; b < int(mesh.edges.size()); ++b) add({{a, b}, true, 0.0});
    for (const int v : mesh.points)
        for (int t = 0; t < int(mesh.triangles.size()); ++t) add({{v, t}, false, 0.0});
    return pairs;
}

// Of all pairs those that have an impact, and those nearer than their activation distance.
inline Pairs all_impacts(const CollisionMesh &mesh, const std::vector<Vec3> &start, const std::vector<Vec3> &end) {
    Pairs found;
    for (const PrimitivePair &pair : all_pairs(mesh))
        if (has_impact(mesh, pair, start, end)) found.insert(name(pair));
    return found;
}

inline Pairs all_contacts(const CollisionMesh &mesh, const std::vector<Vec3> &positions) {
    Pairs found;
    for (const PrimitivePair &pair : all_pairs(mesh))
        with_vertices(mesh, pair, [&](const auto &a, const auto &b) {
            if (std::sqrt(closest_points(positions, a, b).distance2) < pair.d_hat) found.insert(name(pair));
        });
    return found;
}

} // namespace ringlet
