#include "ringlet/geometry/triangle_tree.h"

#include <algorithm>
#include <array>
#include <numeric>

namespace ringlet {
namespace {

double distance2(const Vec3 &p, const Vec3 &low, const Vec3 &high) {
    return (low - p).cwiseMax(p - high).cwiseMax(0.0).squaredNorm();
}

// Barycentric coordinates of the point of the edge (i, j) closest to p.
Vec3 on_edge(const std::array<Vec3, 3> &corners, int i, int j, const Vec3 &p) {
    const Vec3 edge = corners[j] - corners[i];
    const double length2 = edge.squaredNorm();
    const double along = length2 > 0.0 ? std::clamp((p - corners[i]).dot(edge) / length2, 0.0, 1.0) : 0.0;
    Vec3 barycentric = Vec3::Zero();
    barycentric[i] = 1.0 - along;
    barycentric[j] = along;
    return barycentric;
}

} // namespace

SurfacePoint closest_point(const TriangleMesh &mesh, int triangle, const Vec3 &p) {
    const std::array<Vec3, 3> corners = {mesh.corner(triangle, 0), mesh.corner(triangle, 1), mesh.corner(triangle, 2)};
    SurfacePoint nearest{triangle};
    const auto take_nearer = [&](const Vec3 &barycentric) {
        const Vec3 position = mesh.at(triangle, barycentric);
        const double distance = (p - position).norm();
        if (distance < nearest.distance) nearest = {triangle, barycentric, position, distance};
    };
    const Vec3 a = corners[1] - corners[0], b = corners[2] - corners[0], normal = a.cross(b), q = p - corners[0];
    const double area2 = normal.squaredNorm();
    if (area2 > 0.0) { // the foot of the perpendicular, if it falls inside
        const double v = q.cross(b).dot(normal) / area2, w = a.cross(q).dot(normal) / area2;
        if (v >= 0.0 && w >= 0.0 && v + w <= 1.0) {
            take_nearer({1.0 - v - w, v, w});
            return nearest;
        }
    }
    take_nearer(on_edge(corners, 0, 1, p));
    take_nearer(on_edge(corners, 1, 2, p));
    take_nearer(on_edge(corners, 2, 0, p));
    return nearest;
}

TriangleTree::TriangleTree(const TriangleMesh &mesh, View<int> triangles)
    : mesh_(mesh), order_(triangles.begin(), triangles.end()) {
    build();
}

TriangleTree::TriangleTree(const TriangleMesh &mesh) : mesh_(mesh), order_(mesh.triangles.size()) {
    std::iota(order_.begin(), order_.end(), 0);
    build();
}

void TriangleTree::build() {
    if (order_.empty()) return;
    nodes_.reserve(order_.size());
    build(0, static_cast<int>(order_.size()));
    spheres_.reserve(order_.size());
    for (const int t : order_) {
        const Vec3 centre = (mesh_.corner(t, 0) + mesh_.corner(t, 1) + mesh_.corner(t, 2)) / 3.0;
        double radius = 0.0;
        for (int k = 0; k < 3; ++k) radius = std::max(radius, (mesh_.corner(t, k) - centre).norm());
        spheres_.push_back({centre, radius});
    }
}

int TriangleTree::build(int begin, int end) {
    constexpr int leaf = 4;
    const int self = static_cast<int>(nodes_.size());
    Vec3 low = mesh_.corner(order_[begin], 0), high = low;
    for (int i = begin; i < end; ++i)
        for (int k = 0; k < 3; ++k) {
            low = low.cwiseMin(mesh_.corner(order_[i], k));
            high = high.cwiseMax(mesh_.corner(order_[i], k));
        }
    nodes_.push_back({low, high, begin, end - begin});
    if (end - begin <= leaf) return self;

    int axis = 0;
    (high - low).maxCoeff(&axis);
    const auto middle = [&](int t) { return mesh_.corner(t, 0)[axis] + mesh_.corner(t, 1)[axis] + mesh_.corner(t, 2)[axis]; };
    const int half = begin + (end - begin) / 2;
    std::nth_element(order_.begin() + begin, order_.begin() + half, order_.begin() + end, [&](int s, int t) {
        const double a = middle(s), b = middle(t);
        return a != b ? a < b : s < t; // a total order: the same tree on every machine
    });
    build(begin, half);
    const int right = build(half, end);
    nodes_[self].begin = right;
    nodes_[self].count = 0;
    return self;
}

SurfacePoint TriangleTree::closest(const Vec3 &p, double within) const {
    SurfacePoint nearest;
    if (nodes_.empty()) return nearest;
    double bound = within, bound2 = within * within;
    const auto is_farther = [&](const Sphere &sphere) {
        const double reach = bound + (1.0 + 1e-12) * sphere.radius; // for rounding
        return (p - sphere.centre).squaredNorm() > reach * reach;
    };
    struct Visit {
        int node;
        double distance2;
    };
    std::array<Visit, 64> stack; // a balanced tree over 2³¹ triangles is 31 deep
    int top = 0;
    stack[top++] = {0, distance2(p, nodes_[0].low, nodes_[0].high)};
    while (top > 0) {
        const Visit visit = stack[--top];
        if (visit.distance2 > bound2) continue;
        const Node &node = nodes_[visit.node];
        if (node.count > 0) {
            for (int i = node.begin; i < node.begin + node.count; ++i) {
                if (is_farther(spheres_[i])) continue;
                const SurfacePoint found = closest_point(mesh_, order_[i], p);
                if (found.distance < nearest.distance && found.distance * found.distance <= bound2) {
                    nearest = found;
                    bound = found.distance;
                    bound2 = bound * bound;
                }
            }
            continue;
        }
        Visit near{visit.node + 1, 0.0}, far{node.begin, 0.0};
        near.distance2 = distance2(p, nodes_[near.node].low, nodes_[near.node].high);
        far.distance2 = distance2(p, nodes_[far.node].low, nodes_[far.node].high);
        if (far.distance2 < near.distance2) std::swap(near, far);
        stack[top++] = far;
        stack[top++] = near;
    }
    return nearest;
}

void TriangleTree::overlapping(const Vec3 &low, const Vec3 &high, std::vector<int> &found) const {
    const auto overlaps = [&](const Vec3 &from, const Vec3 &to) {
        return (from.array() <= high.array()).all() && (to.array() >= low.array()).all();
    };
    if (nodes_.empty()) return;
    std::array<int, 64> stack;
    int top = 0;
    stack[top++] = 0;
    while (top > 0) {
        const int self = stack[--top];
        const Node &node = nodes_[self];
        if (!overlaps(node.low, node.high)) continue;
        if (node.count == 0) {
            stack[top++] = node.begin;
            stack[top++] = self + 1;
            continue;
        }
        for (int i = node.begin; i < node.begin + node.count; ++i) {
            const Vec3 &a = mesh_.corner(order_[i], 0), &b = mesh_.corner(order_[i], 1), &c = mesh_.corner(order_[i], 2);
            if (overlaps(a.cwiseMin(b).cwiseMin(c), a.cwiseMax(b).cwiseMax(c))) found.push_back(order_[i]);
        }
    }
}

} // namespace ringlet
