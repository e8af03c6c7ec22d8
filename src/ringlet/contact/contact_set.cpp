#include "ringlet/contact/contact_set.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace ringlet {
namespace {

template <size_t N, size_t M>
std::optional<Contact> touch(const CollisionMesh &mesh, const std::array<int, N> &a, const std::array<int, M> &b,
                             View<Vec3> start, View<Vec3> now) {
    const ClosestPoints nearest = closest_points(now, a, b);
    const double distance = std::sqrt(nearest.distance2), radii = mean_radius(mesh, a) + mean_radius(mesh, b);
    if (distance >= radii || !(distance > 0.0)) return {};
    Contact contact{};
    contact.distance = contact_distance(mesh, a, b);
    if (distance >= contact.distance) return {};
    contact.barrier_end = std::clamp(0.25 * distance, contact.distance / 2000, contact.distance / 64);
    std::copy(a.begin(), a.end(), contact.vertex.begin());
    std::copy(b.begin(), b.end(), contact.vertex.begin() + N);
    contact.weight = nearest.weights;
    contact.first = N;
    contact.normal = separation(contact, now) / distance;
    contact.start = separation(contact, start);
    return contact;
}

uint64_t name(const std::array<int, 2> &pair, bool of_edges) {
    return uint64_t(of_edges) << 63 | uint64_t(pair[0]) << 32 | uint64_t(pair[1]);
}

} // namespace

void ContactSet::begin(const CollisionMesh &mesh, const Candidates &candidates, View<Vec3> positions) {
    early_.clear();
    const auto note = [&](const auto &a, const auto &b, uint64_t pair) {
        const double distance = std::sqrt(closest_points(positions, a, b).distance2);
        if (distance < contact_distance(mesh, a, b)) early_[pair] = distance;
    };
    for (const auto &pair : candidates.edge_edge) note(mesh.edges[pair[0]], mesh.edges[pair[1]], name(pair, true));
    for (const auto &pair : candidates.point_triangle) note(std::array{pair[0]}, mesh.triangles[pair[1]], name(pair, false));
}

void ContactSet::part_early(double way) {
    for (auto &[pair, distance] : early_) distance += way;
}

void ContactSet::find(const CollisionMesh &mesh, const ContactMaterial &material, const Candidates &candidates,
                      View<Vec3> start, View<Vec3> now) {
    const int edges = int(candidates.edge_edge.size()), all = edges + int(candidates.point_triangle.size());
    const auto contact_of = [&](int k) {
        if (k < edges) {
            const auto [a, b] = candidates.edge_edge[k];
            return touch(mesh, mesh.edges[a], mesh.edges[b], start, now);
        }
        const auto [p, t] = candidates.point_triangle[k - edges];
        return touch(mesh, std::array{p}, mesh.triangles[t], start, now);
    };
    // In chunks of fixed size, put together in order: the same for any number of threads.
    constexpr int chunk = 1024;
    const int chunks = (all + chunk - 1) / chunk;
    std::vector<std::vector<Contact>> found(chunks);
#pragma omp parallel for schedule(dynamic)
    for (int c = 0; c < chunks; ++c)
        for (int k = c * chunk; k < std::min(all, (c + 1) * chunk); ++k) {
            std::optional<Contact> contact = contact_of(k);
            if (!contact) continue;
            if (!early_.empty()) {
                const auto early = early_.find(k < edges ? name(candidates.edge_edge[k], true)
                                                         : name(candidates.point_triangle[k - edges], false));
                if (early != early_.end()) {
                    contact->distance = std::min(contact->distance, early->second);
                    contact->barrier_end =
                        std::min(contact->barrier_end, contact->distance / 64); // the clamp above, for the less distance
                }
            }
            double softness[2] = {0.0, 0.0};
            for (int i = 0; i < 4; ++i)
                softness[i >= contact->first] += std::abs(contact->weight[i]) / material.stiffness[contact->vertex[i]];
            contact->stiffness = 1.0 / std::max({softness[0], softness[1], 1e-12});
            contact->friction = material.friction[material.material[contact->vertex[0]] * material.materials +
                                                  material.material[contact->vertex[3]]];
            contact->creep = material.creep;
            contact->force = contact_force(*contact, separation(*contact, now));
            found[c].push_back(*contact);
        }
    contacts_.clear();
    for (const auto &part : found) contacts_.insert(contacts_.end(), part.begin(), part.end());
    index(mesh);
}

void ContactSet::index(const CollisionMesh &mesh) {
    const int vertices = int(mesh.moves.size());
    role_begin_.assign(vertices + 1, 0);
    for (const Contact &c : contacts_)
        for (int i = 0; i < 4; ++i)
            if (mesh.moves[c.vertex[i]] && c.weight[i] != 0.0) ++role_begin_[c.vertex[i] + 1];
    vertices_.clear();
    for (int v = 0; v < vertices; ++v) {
        if (role_begin_[v + 1] > 0) vertices_.push_back(v);
        role_begin_[v + 1] += role_begin_[v];
    }
    roles_.resize(role_begin_.back());
    std::vector<int> next(role_begin_.begin(), role_begin_.end() - 1);
    for (int k = 0; k < int(contacts_.size()); ++k)
        for (int i = 0; i < 4; ++i)
            if (mesh.moves[contacts_[k].vertex[i]] && contacts_[k].weight[i] != 0.0)
                roles_[next[contacts_[k].vertex[i]]++] = {k, i};
}

} // namespace ringlet
