// Small meshes and curves for the tests.
#pragma once

#include "ringlet/geometry/triangle_mesh.h"

#include <cmath>
#include <numbers>
#include <random>
#include <vector>

namespace ringlet {

struct OwnedMesh {
    std::vector<Vec3> points;
    std::vector<Triangle> triangles;
    TriangleMesh view() const { return {points, triangles}; }
};

// The eight faces of a regular octahedron, corners at distance 1.
inline OwnedMesh octahedron() {
    return {{{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}},
            {{2, 4, 0}, {2, 0, 5}, {2, 5, 1}, {2, 1, 4}, {3, 0, 4}, {3, 5, 0}, {3, 1, 5}, {3, 4, 1}}};
}

// Random triangles in the unit cube.
inline OwnedMesh triangle_soup(int count) {
    std::mt19937 random(3);
    std::uniform_real_distribution<double> in(0.0, 1.0);
    OwnedMesh soup;
    for (int i = 0; i < count; ++i) {
        const Vec3 centre(in(random), in(random), in(random));
        for (int k = 0; k < 3; ++k) soup.points.push_back(centre + 0.1 * Vec3(in(random), in(random), in(random)));
        soup.triangles.emplace_back(3 * i, 3 * i + 1, 3 * i + 2);
    }
    return soup;
}

inline std::vector<Vec3> straight(int count, double length) {
    std::vector<Vec3> points;
    for (int i = 0; i < count; ++i) points.emplace_back(0.0, length * i / (count - 1), 0.0);
    return points;
}

} // namespace ringlet
