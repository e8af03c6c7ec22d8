// Where two primitives are in contact: their vertices, and the weights of the closest points.
#pragma once

#include "ringlet/collision/narrow_phase.h"
#include "ringlet/contact/settings.h"
#include "ringlet/math/parallel.h"

#include <algorithm>
#include <cstdint>

namespace ringlet {

// Names of contacts ascend as pairs do, and as the contact points of one pair do.
inline constexpr int max_points_of_pair = 7;

inline uint64_t contact_name(const ContactPair &pair, int point = 0) {
    return uint64_t(!pair.edge_edge) << 63 | uint64_t(pair.primitive[0]) << 33 | uint64_t(pair.primitive[1]) << 3 |
           uint64_t(point);
}
inline uint64_t pair_of(uint64_t contact_name) { return contact_name & ~uint64_t(max_points_of_pair); }

// The objects of both primitives of a contact.
inline std::array<int, 2> objects_of(const CollisionMesh &mesh, uint64_t contact_name) {
    constexpr uint64_t number = (uint64_t(1) << 30) - 1;
    const int i = int(contact_name >> 33 & number), j = int(contact_name >> 3 & number);
    const bool edge_edge = contact_name >> 63 == 0;
    return {mesh.object[edge_edge ? mesh.edges[i][0] : i], mesh.object[edge_edge ? mesh.edges[j][0] : mesh.triangles[j][0]]};
}

template <class Known, class Found, class NameOf, class Work>
void for_known_in(Known &known, Found &found, size_t begin, size_t end, const NameOf &name_of, const Work &work) {
    if (begin == end) return;
    auto next = std::lower_bound(known.begin(), known.end(), name_of(found[begin]),
                                 [](const auto &of, uint64_t name) { return of.name < name; });
    for (size_t k = begin; k < end; ++k) {
        const uint64_t name = name_of(found[k]);
        while (next != known.end() && next->name < name) ++next;
        if (next == known.end()) return;
        if (next->name == name) work(*next, found[k]);
    }
}

// Walks through two lists in the order of names together: calls work(known, found) for each of `found` whose name one of
// `known` has.
template <class Known, class Found, class NameOf, class Work>
void for_known(Known &known, Found &found, const NameOf &name_of, const Work &work) {
    for_known_in(known, found, 0, found.size(), name_of, work);
}

// The same in parallel, where work() changes nothing but the two.
template <class Known, class Found, class NameOf, class Work>
void parallel_for_known(Known &known, Found &found, const NameOf &name_of, const Work &work) {
    constexpr size_t range = 1024;
    parallel_for(int((found.size() + range - 1) / range),
                 [&](int r) { for_known_in(known, found, r * range, std::min(found.size(), (r + 1) * range), name_of, work); });
}

template <class Known, class Found, class Work> void parallel_for_known(Known &known, Found &found, const Work &work) {
    parallel_for_known(known, found, [](const auto &now) { return now.name; }, work);
}

struct Stencil {
    std::array<int, 4> vertex;
    std::array<double, 4> weight; // sum to 1 over the first primitive, to −1 over the second
    int first;                    // vertices of the first primitive: 2 of an edge, 1 of a point

    bool edge_edge() const { return first == 2; }

    // Which of the four are on the same side as one of them: the first, and their end.
    std::array<int, 2> side_of(int one) const { return one < first ? std::array{0, first} : std::array{first, 4}; }

    Vec3 separation(View<Vec3> positions) const { // c_a − c_b of the closest points = Σ wᵢ xᵢ
        Vec3 sum = Vec3::Zero();
        for (int i = 0; i < 4; ++i) sum += weight[i] * positions[vertex[i]];
        return sum;
    }
};

inline Stencil stencil(const CollisionMesh &mesh, const ContactPair &pair, const ClosestPoints &closest) {
    Stencil stencil{{}, closest.weights, pair.edge_edge ? 2 : 1};
    with_vertices(mesh, pair, [&](const auto &a, const auto &b) {
        std::copy(b.begin(), b.end(), std::copy(a.begin(), a.end(), stencil.vertex.begin()));
    });
    return stencil;
}

// A point at which a pair pushes, with its share of the stiffness.
struct ContactPoint {
    ClosestPoints closest;
    double share;
    int number; // among those of the pair
};

// The closest points of almost parallel edges jump from end to end as they turn. There the push is shared among the four ends
// and the points closest to them, which move continuously. (On surfaces, points against triangles do this.) Calls
// work(ContactPoint) in order.
template <class Work>
void for_contact_points(const CollisionMesh &mesh, const ContactPair &pair, View<Vec3> positions, const Work &work) {
    if (!pair.edge_edge || std::max(pair.primitive[0], pair.primitive[1]) >= mesh.curve_edges)
        return work(ContactPoint{pair.closest, 1.0, 0});
    const auto [a0, a1] = mesh.edges[pair.primitive[0]];
    const auto [b0, b1] = mesh.edges[pair.primitive[1]];
    const Vec3 &p = positions[a0], &q = positions[b0], a = positions[a1] - p, b = positions[b1] - q;
    const double aa = a.squaredNorm(), bb = b.squaredNorm(), sine2 = a.cross(b).squaredNorm();
    const double s = std::min(sine2 / (contact_settings::parallel_sine2 * aa * bb + 1e-300), 1.0),
                 crossing = s * s * (3.0 - 2.0 * s);
    if (crossing > 0.0) work(ContactPoint{pair.closest, crossing, 0});
    if (crossing == 1.0) return;
    const double share = 0.5 * (1.0 - crossing); // two of the four ends lie beside the other edge, as a rule
    const auto at = [&](double u, double v, int number) {
        const double distance2 = (p + u * a - q - v * b).squaredNorm();
        work(ContactPoint{{{1.0 - u, u, v - 1.0, -v}, distance2}, share, number});
    };
    for (const double end : {0.0, 1.0}) at(end, closest::fraction((p + end * a - q).dot(b), bb), 1 + int(end));
    for (const double end : {0.0, 1.0}) at(closest::fraction((q + end * b - p).dot(a), aa), end, 3 + int(end));
}

} // namespace ringlet
