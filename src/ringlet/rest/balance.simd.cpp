#include "ringlet/rest/balance.h"

#include "ringlet/energy/strand/frame.h"

namespace ringlet::RINGLET_SIMD {
namespace {

using Vector = Vec<double>;

Vector row(const double *values, int i) { return {values[3 * i], values[3 * i + 1], values[3 * i + 2]}; }
void put(double *values, int i, Vector v) {
    for (int k = 0; k < 3; ++k) values[3 * i + k] = v[k];
}

struct Edge {
    double length;
    Vector tangent;
};

Edge edge(const double *points, int i) {
    const Vector e = row(points, i + 1) - row(points, i);
    const double length = norm(e);
    return {length, (1.0 / (length > 0.0 ? length : 1.0)) * e};
}

// Gradients of the two bends of a corner, by the edges before and after it and by the rotation of the director of the latter.
struct Bends {
    EdgeGradient<double> by_edges[2];
    double by_turn[2];
};

Bends bends(const Edge &before, const Edge &behind, Vector director) {
    const Corner<double> c = corner(before.tangent, behind.tangent);
    const Vector across = cross(behind.tangent, director), K = turning(c, before.tangent, behind.tangent);
    const auto gradient = [&](Vector axis) {
        return turning_gradient(c, before.tangent, behind.tangent, before.length, behind.length, axis);
    };
    return {{gradient(director), gradient(across)}, {dot(K, across), -dot(K, director)}};
}

EdgeGradient<double> twist_gradient(const Edge &e, const Edge &next) {
    return frame_twist_gradient(corner(e.tangent, next.tangent), e.tangent, next.tangent, e.length, next.length);
}

// The x for which x₀ a + x₁ b + x₂ c = v.
Vector solve(Vector a, Vector b, Vector c, Vector v) {
    const Vector bc = cross(b, c), ca = cross(c, a), ab = cross(a, b);
    return (1.0 / dot(a, bc)) * Vector{dot(v, bc), dot(v, ca), dot(v, ab)};
}

// v rotated about the direction of `turn` by its length [rad].
Vector rotate(Vector v, Vector turn) {
    const double angle = norm(turn);
    if (!(angle > 0.0)) return v;
    const Vector axis = (1.0 / angle) * turn, along = dot(axis, v) * axis;
    const SineCosine<double> by = sine_cosine(angle);
    return along + by.cosine * (v - along) + by.sine * cross(axis, v);
}

} // namespace

void balance(int n, int held, const double *points, const double *directors, const double *loads, const double *twisting,
             JointRows<double> forces) {
    for (int i = 0; i < n; ++i) forces.length[i] = forces.bend[2 * i] = forces.bend[2 * i + 1] = forces.twist[i] = 0.0;
    Vector beyond{}; // sum of the loads from the end of edge k to the tip
    Edge next{};     // edge k + 1
    Bends ahead{};   // of the corner between the two
    for (int k = n - 2; k >= held - 1; --k) {
        const Edge before = edge(points, k - 1), e = edge(points, k);
        const EdgeGradient<double> twist_before = twist_gradient(before, e);
        const Bends here = bends(before, e, row(directors, k));
        beyond = beyond + row(loads, k + 1);

        // The forces of the corner at the end of edge k, and its twist, are known. The twist of the edge before it follows from
        // the moment balance of the director of edge k.
        const double behind = forces.twist[k] + twisting[k];
        Vector left = beyond - behind * twist_before.second;
        if (k + 2 < n) {
            left = left - forces.twist[k] * twist_gradient(e, next).first;
            for (int a = 0; a < 2; ++a) left = left - forces.bend[2 * (k + 1) + a] * ahead.by_edges[a].first;
        }
        const auto column = [&](int a) { return here.by_edges[a].second - here.by_turn[a] * twist_before.second; };
        const Vector found = solve(e.tangent, column(0), column(1), left);
        forces.length[k] = found.x;
        forces.bend[2 * k] = found.y;
        forces.bend[2 * k + 1] = found.z;
        forces.twist[k - 1] = behind - found.y * here.by_turn[0] - found.z * here.by_turn[1];
        next = e;
        ahead = here;
    }
}

void shape_of(int n, JointRows<const double> joints, const double *points, const double *directors, double *made_points,
              double *made_directors) {
    for (int i = 0; i < 3 * n; ++i) made_directors[i] = 0.0;
    Vector point = row(points, 0), tangent = edge(points, 0).tangent;
    Vector director = transport(row(directors, 1), edge(points, 1).tangent, tangent);
    put(made_points, 0, point);
    for (int k = 0; k + 1 < n; ++k) {
        if (k > 0) {
            director = rotate(director, joints.twist[k - 1] * tangent);
            const Vector turn = joints.bend[2 * k] * director + joints.bend[2 * k + 1] * cross(tangent, director);
            tangent = rotate(tangent, turn);
            director = rotate(director, turn);
            put(made_directors, k, director);
        }
        point = point + joints.length[k] * tangent;
        put(made_points, k + 1, point);
    }
}

} // namespace ringlet::RINGLET_SIMD
