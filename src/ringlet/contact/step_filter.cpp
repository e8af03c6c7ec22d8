#include "ringlet/contact/step_filter.h"

#include "ringlet/contact/impact.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>
#include <queue>

namespace ringlet {
namespace {

// Disjoint sets of vertices; a set is named by its smallest member, so that the order of joining does not matter.
class Zones {
public:
    explicit Zones(int vertices) : parent_(vertices) { std::iota(parent_.begin(), parent_.end(), 0); }
    int find(int v) {
        while (parent_[v] != v) v = parent_[v] = parent_[parent_[v]];
        return v;
    }
    void join(int a, int b) {
        a = find(a), b = find(b);
        parent_[std::max(a, b)] = std::min(a, b);
    }

private:
    std::vector<int> parent_;
};

std::array<int, 4> vertices_of(const CollisionMesh &mesh, const Candidates &candidates, int k) {
    const int edges = int(candidates.edge_edge.size());
    if (k < edges) {
        const auto [a, b] = candidates.edge_edge[k];
        return {mesh.edges[a][0], mesh.edges[a][1], mesh.edges[b][0], mesh.edges[b][1]};
    }
    const auto [p, t] = candidates.point_triangle[k - edges];
    return {p, mesh.triangles[t][0], mesh.triangles[t][1], mesh.triangles[t][2]};
}

struct Zone { // of one round
    double mass = 0.0;
    Vec3 moved = Vec3::Zero(); // Σ mass × displacement
    int carrier = -1;          // a kinematic vertex that it met
    double safe = 1.0;         // part of its vertices' own motion
};

template <size_t N, size_t M>
double impact_time(const CollisionMesh &mesh, const std::array<int, N> &a, const std::array<int, M> &b, View<Vec3> start,
                   View<Vec3> end) {
    Vec3 x[4], p[4];
    for (size_t i = 0; i < 4; ++i) {
        const int v = i < N ? a[i] : b[i - N];
        x[i] = start[v];
        p[i] = end[v] - start[v];
    }
    const double distance = std::sqrt(closest_points(start, a, b).distance2);
    const double r = contact_distance(mesh, a, b);
    const double kept = std::min(0.5 * r, 0.2 * distance);
    if constexpr (N == 2)
        return edge_edge_impact(x, p, kept);
    else
        return point_triangle_impact(x, p, kept);
}

template <size_t N, size_t M> bool move_as_one(View<int> rigid, const std::array<int, N> &a, const std::array<int, M> &b) {
    bool same = rigid[a[0]] >= 0;
    for (const int v : a) same &= rigid[v] == rigid[a[0]];
    for (const int v : b) same &= rigid[v] == rigid[a[0]];
    return same;
}

void impact_times(const CollisionMesh &mesh, View<int> rigid, View<Vec3> start, View<Vec3> end, const Candidates &candidates,
                  std::vector<double> &times) {
    const int edges = int(candidates.edge_edge.size());
    times.resize(edges + candidates.point_triangle.size());
#pragma omp parallel for schedule(dynamic, 256)
    for (int k = 0; k < int(times.size()); ++k) {
        const auto of = [&](const auto &a, const auto &b) {
            return !rigid.empty() && move_as_one(rigid, a, b) ? no_impact : impact_time(mesh, a, b, start, end);
        };
        if (k < edges) {
            const auto [a, b] = candidates.edge_edge[k];
            times[k] = of(mesh.edges[a], mesh.edges[b]);
        } else {
            const auto [p, t] = candidates.point_triangle[k - edges];
            times[k] = of(std::array{p}, mesh.triangles[t]);
        }
    }
}

// How much a vertex gives up of its own motion for another.
struct Pull {
    double part = 0.0;
    Vec3 motion = Vec3::Zero();
};

// Over cloths from vertex to vertex, what pulls hardest first.
template <class PassOn> void fade_over_cloths(const FilterScene &scene, const std::vector<Pull> &pulls, const PassOn &pass_on) {
    std::priority_queue<std::pair<double, int>> queue;
    for (int v = scene.cloths.front(); v < scene.cloths.back(); ++v)
        if (pulls[v].part > 0.0) queue.emplace(pulls[v].part, v);
    while (!queue.empty()) {
        const auto [part, v] = queue.top();
        queue.pop();
        if (part < pulls[v].part) continue; // it has been pulled harder since
        for (const int next : scene.neighbours->of(v))
            if (pass_on(v, next)) queue.emplace(pulls[next].part, next);
    }
}

// How much an edge may be strained by what its vertices give up.
struct FadeStrain {
    double strand, cloth;
};

// Along every strand from vertex to vertex, in both directions, and over cloths.
void fade(const FilterScene &scene, View<Vec3> start, View<Vec3> end, const FadeStrain &most, std::vector<Pull> &pulls) {
    const auto pass_on = [&](int from, int to, double strain) { // says whether `to` is pulled harder now
        if (!scene.mesh.moves[to] || pulls[from].part <= 0.0) return false;
        const double length = (start[to] - start[from]).norm(), way = (end[to] - start[to] - pulls[from].motion).norm();
        const double left = pulls[from].part - strain * length / std::max(way, 1e-30);
        if (left <= pulls[to].part) return false;
        pulls[to] = {left, pulls[from].motion};
        return true;
    };
    const int strands = int(scene.offsets.size()) - 1;
#pragma omp parallel for schedule(static)
    for (int s = 0; s < strands; ++s) {
        for (int v = scene.offsets[s]; v + 1 < scene.offsets[s + 1]; ++v) pass_on(v, v + 1, most.strand);
        for (int v = scene.offsets[s + 1] - 1; v > scene.offsets[s]; --v) pass_on(v, v - 1, most.strand);
    }
    if (scene.cloths.size() > 1)
        fade_over_cloths(scene, pulls, [&](int from, int to) { return pass_on(from, to, most.cloth); });
}

constexpr double most_strain = 0.05;

// Strands of pairs that would meet go only as far as that, as a whole; one that could hardly move is in the first rounds held
// back near the pair alone, so that the rest of it can follow. After some more rounds they stay where they are: two that stay
// do not meet. A cloth is held back near the pair, and stays as a whole only when all else fails.
void hold_back(const FilterScene &scene, View<Vec3> start, const std::vector<int> &met, const std::vector<double> &times,
               const Candidates &candidates, int round, std::vector<Vec3> &end, std::vector<unsigned char> &changed) {
    constexpr int local_rounds = 2, rounds = 8, local_rounds_of_cloth = 16;
    constexpr double hardly = 0.2;
    const int strands = int(scene.offsets.size()) - 1;
    std::vector<Pull> pulls(start.size());
    std::map<int, double> parts; // strand → how far it goes as a whole
    for (const int k : met)
        for (const int v : vertices_of(scene.mesh, candidates, k))
            if (scene.mesh.moves[v]) {
                const double part = round < rounds ? times[k] : 0.0;
                pulls[v].part = std::max(pulls[v].part, 1.0 - part);
                double &whole = parts.try_emplace(scene.mesh.object[v], 1.0).first->second;
                whole = std::min(whole, part);
            }
    fade(scene, start, end, {most_strain, round < local_rounds_of_cloth ? most_strain : 0.0}, pulls);
    for (const auto &[strand, part] : parts)
        if (strand < strands && (round >= local_rounds || part > hardly))
            for (int v = scene.offsets[strand]; v < scene.offsets[strand + 1]; ++v)
                if (scene.mesh.moves[v]) pulls[v].part = 1.0 - part;
#pragma omp parallel for schedule(static)
    for (int v = 0; v < int(start.size()); ++v)
        if (pulls[v].part > 0.0) {
            end[v] += pulls[v].part * (start[v] - end[v]);
            changed[v] = 1;
        }
}

// Takes out of `pairs` those of primitives with a changed vertex, and puts `found` in, all in order.
template <class Changed>
void replace(std::vector<std::array<int, 2>> &pairs, const Changed &changed, const std::vector<std::array<int, 2>> &found) {
    std::erase_if(pairs, changed);
    const size_t kept = pairs.size();
    pairs.insert(pairs.end(), found.begin(), found.end());
    std::inplace_merge(pairs.begin(), pairs.begin() + kept, pairs.end());
}

void replace(const CollisionMesh &mesh, View<unsigned char> changed, Candidates &candidates, const Candidates &found) {
    const auto any = [&](const auto &primitive) {
        return std::any_of(primitive.begin(), primitive.end(), [&](int v) { return changed[v] != 0; });
    };
    replace(
        candidates.edge_edge, [&](const auto &pair) { return any(mesh.edges[pair[0]]) || any(mesh.edges[pair[1]]); },
        found.edge_edge);
    replace(
        candidates.point_triangle, [&](const auto &pair) { return changed[pair[0]] || any(mesh.triangles[pair[1]]); },
        found.point_triangle);
}

} // namespace

FilterReport filter_step(const FilterScene &scene, BroadPhase &broad_phase, View<Vec3> start, std::vector<Vec3> &end,
                         Candidates &candidates) {
    constexpr int to_touch = 3; // rounds in which zones keep some of their own motion
    const int most_rounds = scene.still ? int(scene.offsets.size() + scene.cloths.size()) + 16 : 16;
    const CollisionMesh &mesh = scene.mesh;
    FilterReport report;
    const int vertices = int(start.size());
    Zones zones(vertices);
    std::vector<unsigned char> in_zone(vertices, 0);
    std::vector<int> carrier(vertices, -1); // a kinematic vertex that it met
    std::vector<Pull> pulls;
    std::vector<double> times;
    std::vector<unsigned char> changed; // since the last round; empty: everything
    Candidates looked_at;
    for (;; ++report.rounds) {
        // What has not changed since the last round has not met.
        broad_phase.find(start, end, 0.0, looked_at, changed);
        if (changed.empty())
            candidates = looked_at;
        else
            replace(mesh, changed, candidates, looked_at);
        impact_times(mesh, scene.rigid, start, end, looked_at, times);
        std::vector<int> met;
        for (int k = 0; k < int(times.size()); ++k)
            if (times[k] <= 1.0) met.push_back(k);
        if (report.rounds == 0) {
            report.candidates = int(times.size());
            report.violations = int(met.size());
        }
        if (met.empty()) break;
        if (report.rounds >= most_rounds) { // no way out was found: everything stops before the first pair meets
            report.fraction = 0.9 * *std::min_element(times.begin(), times.end());
            for (int v = 0; v < vertices; ++v) end[v] = start[v] + report.fraction * (end[v] - start[v]);
            broad_phase.find(start, end, 0.0, candidates);
            break;
        }

        // What is kinematic does not join zones: one body would tie together all that touches it.
        for (const int k : met) {
            const auto v = vertices_of(mesh, looked_at, k);
            for (const int i : v)
                for (const int j : v) {
                    if (!mesh.moves[i]) continue;
                    in_zone[i] = 1;
                    if (mesh.moves[j])
                        zones.join(i, j);
                    else
                        carrier[i] = j;
                }
        }
        // Of what a pair's motions differ by only as much is taken as lets the two touch: only then do they push each other
        // away.
        std::map<int, Zone> hit;
        for (const int k : met)
            for (const int v : vertices_of(mesh, looked_at, k))
                if (mesh.moves[v]) {
                    Zone &zone = hit[zones.find(v)];
                    if (report.rounds < to_touch)
                        zone.safe = std::min(zone.safe, times[k]);
                    else
                        zone.safe = 0.0;
                }
        const auto zone_of = [&](int v) { return in_zone[v] ? hit.find(zones.find(v)) : hit.end(); };
        for (int v = 0; v < vertices; ++v)
            if (const auto zone = zone_of(v); zone != hit.end()) {
                zone->second.mass += scene.mass[v];
                zone->second.moved += scene.mass[v] * (end[v] - start[v]);
                zone->second.carrier = std::max(zone->second.carrier, carrier[v]);
            }
        if (scene.still) {
            changed.assign(vertices, 0);
            hold_back(scene, start, met, times, looked_at, report.rounds, end, changed);
            continue;
        }
        pulls.assign(vertices, {});
        for (int v = 0; v < vertices; ++v)
            if (const auto found = zone_of(v); found != hit.end()) {
                const Zone &zone = found->second;
                pulls[v] = {1.0 - zone.safe, zone.carrier >= 0 ? Vec3(scene.carried_by(zone.carrier, start[v]) - start[v])
                                                               : Vec3(zone.moved / zone.mass)};
            }
        fade(scene, start, end, {most_strain, most_strain}, pulls);
#pragma omp parallel for schedule(static)
        for (int v = 0; v < vertices; ++v)
            if (pulls[v].part > 0.0) end[v] += pulls[v].part * (start[v] + pulls[v].motion - end[v]);
    }
    if (report.violations > 0) report.zone_vertices = int(std::count(in_zone.begin(), in_zone.end(), 1));
    return report;
}

} // namespace ringlet
