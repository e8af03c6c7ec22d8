#include "ringlet/geometry/orientation.h"

#include "ringlet/geometry/sides.h"
#include "ringlet/math/disjoint_sets.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

namespace ringlet {
namespace {

constexpr double small_openings = 0.25; // area of openings of a surface with an inside, at most, relative to its own
constexpr double thin = 1e-6;           // volume, relative to area^1.5, up to which a surface encloses nothing

// A number for each point, the same for those at one place.
std::vector<int> numbered_places(const std::vector<Vec3> &points) {
    std::vector<int> order(points.size()), place(points.size());
    std::iota(order.begin(), order.end(), 0);
    const auto row = [&](int i) { return std::array<double, 3>{points[i].x(), points[i].y(), points[i].z()}; };
    std::sort(order.begin(), order.end(), [&](int a, int b) { return row(a) < row(b); });
    for (size_t k = 1; k < order.size(); ++k)
        place[order[k]] = place[order[k - 1]] + (points[order[k]] != points[order[k - 1]]);
    return place;
}

struct Enclosed {
    double volume = 0.0, area = 0.0, open_area = 0.0;
};

// Of a triangle and the origin; the volume is positive where the triangle faces away.
Enclosed enclosed(const Vec3 &a, const Vec3 &b, const Vec3 &c) {
    const Vec3 across = (b - a).cross(c - a);
    return {a.dot(across) / 6.0, 0.5 * across.norm()};
}

// Closes openings by fans: a triangle for each open side, from the middle of its rim.
template <class Add>
void add_fans(const std::vector<Side> &open, const std::vector<Vec3> &points, size_t places, const Add &add) {
    DisjointSets rims{int(places)};
    for (const Side &side : open) rims.join(side.low, side.high);
    std::vector<Vec3> middle(places, Vec3::Zero());
    std::vector<double> length(places, 0.0);
    for (const Side &side : open) {
        const int rim = rims.find(side.low);
        const double own = (points[side.to] - points[side.from]).norm();
        middle[rim] += 0.5 * own * (points[side.from] + points[side.to]);
        length[rim] += own;
    }
    for (const Side &side : open) {
        const int rim = rims.find(side.low);
        const Vec3 apex = length[rim] > 0.0 ? Vec3(middle[rim] / length[rim]) : points[side.from];
        add(side.triangle, enclosed(apex, points[side.to], points[side.from]));
    }
}

} // namespace

std::vector<int> parts_facing_inside(const TriangleMesh &mesh) {
    const int count = int(mesh.triangles.size());
    if (count == 0) return {};
    const Vec3 mean = std::accumulate(mesh.points.begin(), mesh.points.end(), Vec3(Vec3::Zero())) / mesh.points.size();
    std::vector<Vec3> points(mesh.points.begin(), mesh.points.end());
    for (Vec3 &point : points) point -= mean;
    if (!mean.allFinite()) return std::vector<int>(count, -1); // no inside is known

    DisjointSets cover(2 * count); // triangles as they are wound, and turned over
    std::vector<Side> open;
    for_edges(sides_by_edge(mesh.triangles, numbered_places(points), int(points.size())), [&](View<Side> sides) {
        const Side &a = sides[0];
        if (sides.size() == 1) open.push_back(a);
        if (sides.size() != 2) return;
        const Side &b = sides[1];
        const bool agree = a.rises != b.rises; // a side runs one way in one triangle, and the other way in the other
        cover.join(a.triangle, agree ? b.triangle : b.triangle + count);
        cover.join(a.triangle + count, agree ? b.triangle + count : b.triangle);
    });

    std::vector<Enclosed> parts(2 * size_t(count));
    const auto add = [&](int triangle, const Enclosed &of, bool fan) {
        for (const int side : {0, 1}) {
            Enclosed &part = parts[cover.find(triangle + side * count)];
            part.volume += side == 0 ? of.volume : -of.volume;
            (fan ? part.open_area : part.area) += of.area;
        }
    };
    for (int t = 0; t < count; ++t)
        add(t, enclosed(points[mesh.triangles[t][0]], points[mesh.triangles[t][1]], points[mesh.triangles[t][2]]), false);
    add_fans(open, points, points.size(), [&](int triangle, const Enclosed &of) { add(triangle, of, true); });

    std::vector<int> facing(count);
    for (int t = 0; t < count; ++t) {
        const int number = cover.find(t);
        const Enclosed &part = parts[number];
        const bool inwards = part.volume < -thin * std::pow(part.area, 1.5) && part.open_area <= small_openings * part.area;
        facing[t] = inwards ? number : -1;
    }
    return facing;
}

} // namespace ringlet
