// A scene of strands, a cloth and a body on a move, and what the pair cache finds in it.
#pragma once

#include "ringlet/ccd/time_of_impact.h"
#include "ringlet/collision/pair_cache.h"

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

// The impact candidates that have an impact on straight paths.
inline Pairs impacts(const CollisionMesh &mesh, PairCache &cache, const std::vector<Vec3> &start,
                     const std::vector<Vec3> &end) {
    Pairs pairs;
    for (const CandidatePair *pair : cache.impact_candidates())
        with_vertices(mesh, *pair, [&](const auto &a, const auto &b) {
            Vec3 x[4], p[4];
            int i = 0;
            for (const int v : a) x[i] = start[v], p[i++] = end[v] - start[v];
            for (const int v : b) x[i] = start[v], p[i++] = end[v] - start[v];
            const double kept = collision::impact_distance * pair->d_hat;
            const double time = pair->edge_edge ? edge_edge_toi(x, p, kept) : point_triangle_toi(x, p, kept);
            if (time <= 1.0) pairs.insert({pair->edge_edge, pair->primitive[0], pair->primitive[1]});
        });
    return pairs;
}

inline Pairs contacts(PairCache &cache, const std::vector<Vec3> &positions) {
    Pairs pairs;
    for (const ContactPair &touch : cache.contact_pairs(positions))
        pairs.insert({touch.edge_edge, touch.primitive[0], touch.primitive[1]});
    return pairs;
}

} // namespace ringlet
