#include "ringlet/contact/step_filter.h"

#include "ringlet/contact/collect.h"
#include "ringlet/contact/impact.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>
#include <optional>
#include <queue>

namespace ringlet {
namespace {

struct Met { // a pair that would meet
    std::array<int, 4> vertices;
    double time; // until when it keeps its distance
};

template <size_t N, size_t M> bool move_as_one(View<int> rigid, const std::array<int, N> &a, const std::array<int, M> &b) {
    bool same = rigid[a[0]] >= 0;
    for (const int v : a) same &= rigid[v] == rigid[a[0]];
    for (const int v : b) same &= rigid[v] == rigid[a[0]];
    return same;
}

// Notes how far the pair is apart at the start.
template <size_t N, size_t M>
double impact_time(NearPair &pair, const std::array<int, N> &a, const std::array<int, M> &b, View<Vec3> start, View<Vec3> end) {
    pair.apart = std::sqrt(closest_points(start, a, b).distance2);
    const double kept = std::min({0.5 * pair.distance, std::max(0.2 * pair.apart, pair.distance / 250), 0.9 * pair.apart});
    Vec3 x[4], p[4];
    for (size_t i = 0; i < 4; ++i) {
        const int v = i < N ? a[i] : b[i - N];
        x[i] = start[v];
        p[i] = end[v] - start[v];
    }
    double most = 0.0; // that two vertices come nearer
    for (size_t i = 0; i < N; ++i)
        for (size_t j = N; j < 4; ++j) most = std::max(most, (p[i] - p[j]).squaredNorm());
    if (pair.apart - kept > std::sqrt(most)) return no_impact;
    if constexpr (N == 2)
        return edge_edge_impact(x, p, kept);
    else
        return point_triangle_impact(x, p, kept);
}

std::vector<Met> find_met(const FilterScene &scene, const NearPairs &near, View<Vec3> start, View<Vec3> end) {
    const std::vector<NearPair *> &pairs = near.may_meet();
    return collect<Met>(int(pairs.size()), [&](int k, std::vector<Met> &met) {
        with_vertices(scene.mesh, *pairs[k], [&](const auto &a, const auto &b) {
            if (!scene.rigid.empty() && move_as_one(scene.rigid, a, b)) return;
            const double time = impact_time(*pairs[k], a, b, start, end);
            if (time > 1.0) return;
            met.push_back({{}, time});
            std::copy(b.begin(), b.end(), std::copy(a.begin(), a.end(), met.back().vertices.begin()));
        });
    });
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
// back near the pair alone, so that the rest of it can follow. Of two strands that do not go equally far, the one ahead is
// first made to. After some more rounds they stay where they are: two that stay do not meet. A cloth is held back near the
// pair, and stays as a whole only when all else fails. `go`: per strand, how much of its way is left to it as a whole.
void hold_back(const FilterScene &scene, View<Vec3> start, const std::vector<Met> &met, int round, std::vector<double> &go,
               std::vector<Vec3> &end, std::vector<unsigned char> &changed) {
    constexpr int local_rounds = 2, rounds = 8, local_rounds_of_cloth = 16;
    constexpr double hardly = 0.2;
    const int strands = int(scene.offsets.size()) - 1;
    std::vector<Pull> pulls(start.size());
    std::map<int, double> parts; // object → how much of what is left to it now
    const auto keep = [&](int object, double part) {
        double &whole = parts.try_emplace(object, 1.0).first->second;
        whole = std::min(whole, part);
    };
    const auto strand_of = [&](int v, int w) { // an edge's
        const bool moves = scene.mesh.moves[v] || scene.mesh.moves[w];
        return moves && scene.mesh.object[v] < strands ? scene.mesh.object[v] : -1;
    };
    for (const Met &pair : met) {
        const int a = strand_of(pair.vertices[0], pair.vertices[1]), b = strand_of(pair.vertices[3], pair.vertices[2]);
        if (a >= 0 && b >= 0 && go[a] != go[b] && round < rounds) {
            keep(go[a] > go[b] ? a : b, std::min(go[a], go[b]) / std::max(go[a], go[b]));
            continue;
        }
        const double part = round < rounds ? pair.time : 0.0;
        for (const int v : pair.vertices)
            if (scene.mesh.moves[v]) {
                pulls[v].part = std::max(pulls[v].part, 1.0 - part);
                keep(scene.mesh.object[v], part);
            }
    }
    fade(scene, start, end, {most_strain, round < local_rounds_of_cloth ? most_strain : 0.0}, pulls);
    for (const auto &[strand, part] : parts)
        if (strand < strands && (scene.whole || round >= local_rounds || part > hardly)) {
            go[strand] *= part;
            for (int v = scene.offsets[strand]; v < scene.offsets[strand + 1]; ++v)
                if (scene.mesh.moves[v]) pulls[v].part = 1.0 - part;
        }
#pragma omp parallel for schedule(static)
    for (int v = 0; v < int(start.size()); ++v) {
        changed[v] = pulls[v].part > 0.0;
        if (changed[v]) end[v] += pulls[v].part * (start[v] - end[v]);
    }
}

// Zones of vertices that would meet; they grow from round to round. A zone is named by its smallest member, so that the order
// of joining does not matter.
class Zones {
public:
    explicit Zones(const FilterScene &scene)
        : scene_(scene), parent_(scene.mesh.moves.size()), in_zone_(parent_.size(), 0), carrier_(parent_.size(), -1) {
        std::iota(parent_.begin(), parent_.end(), 0);
    }

    // What is kinematic does not join zones: one body would tie together all that touches it.
    void join(const std::vector<Met> &met) {
        for (const Met &pair : met)
            for (const int i : pair.vertices)
                for (const int j : pair.vertices) {
                    if (!scene_.mesh.moves[i]) continue;
                    in_zone_[i] = 1;
                    if (scene_.mesh.moves[j])
                        join(i, j);
                    else
                        carrier_[i] = j;
                }
    }

    // Zones in which a pair would still meet move as one. Of what a pair's motions differ by only as much is taken as lets the
    // two touch, while that is hoped to do: only then do they push each other away.
    void move_as_one(View<Vec3> start, const std::vector<Met> &met, bool to_touch, std::vector<Vec3> &end) {
        struct Zone {
            double mass = 0.0;
            Vec3 moved = Vec3::Zero(); // Σ mass × displacement
            int carrier = -1;          // a kinematic vertex that it met
            double safe = 1.0;         // part of its vertices' own motion
        };
        std::map<int, Zone> hit;
        for (const Met &pair : met)
            for (const int v : pair.vertices)
                if (scene_.mesh.moves[v]) {
                    double &safe = hit[find(v)].safe;
                    safe = to_touch ? std::min(safe, pair.time) : 0.0;
                }
        const auto zone_of = [&](int v) { return in_zone_[v] ? hit.find(find(v)) : hit.end(); };
        const int vertices = int(start.size());
        for (int v = 0; v < vertices; ++v)
            if (const auto zone = zone_of(v); zone != hit.end()) {
                zone->second.mass += scene_.mass[v];
                zone->second.moved += scene_.mass[v] * (end[v] - start[v]);
                zone->second.carrier = std::max(zone->second.carrier, carrier_[v]);
            }
        std::vector<Pull> pulls(vertices);
        for (int v = 0; v < vertices; ++v)
            if (const auto found = zone_of(v); found != hit.end()) {
                const Zone &zone = found->second;
                pulls[v] = {1.0 - zone.safe, zone.carrier >= 0 ? Vec3(scene_.carried_by(zone.carrier, start[v]) - start[v])
                                                               : Vec3(zone.moved / zone.mass)};
            }
        fade(scene_, start, end, {most_strain, most_strain}, pulls);
#pragma omp parallel for schedule(static)
        for (int v = 0; v < vertices; ++v)
            if (pulls[v].part > 0.0) end[v] += pulls[v].part * (start[v] + pulls[v].motion - end[v]);
    }

private:
    int find(int v) {
        while (parent_[v] != v) v = parent_[v] = parent_[parent_[v]];
        return v;
    }
    void join(int a, int b) {
        a = find(a), b = find(b);
        parent_[std::max(a, b)] = std::min(a, b);
    }

    const FilterScene &scene_;
    std::vector<int> parent_;
    std::vector<unsigned char> in_zone_;
    std::vector<int> carrier_; // a kinematic vertex that it met
};

} // namespace

FilterReport filter_step(const FilterScene &scene, NearPairs &near, View<Vec3> start, std::vector<Vec3> &end) {
    constexpr int to_touch = 3; // rounds in which zones keep some of their own motion
    const int most_rounds = scene.still ? int(scene.offsets.size() + scene.cloths.size()) + 16 : 16;
    FilterReport report;
    const size_t vertices = start.size();
    std::vector<unsigned char> changed(vertices, 0), in_the_way(vertices, 0);
    std::vector<double> go(scene.offsets.size(), 1.0);
    std::optional<Zones> zones;
    near.set_out(start, end);
    for (;; ++report.rounds) {
        const std::vector<Met> met = find_met(scene, near, start, end);
        if (report.rounds == 0) {
            report.candidates = near.count();
            report.violations = int(met.size());
        }
        if (met.empty()) break;
        for (const Met &pair : met)
            for (const int v : pair.vertices) in_the_way[v] = scene.mesh.moves[v];
        if (report.rounds >= most_rounds) { // no way out was found: everything stops before the first pair meets
            report.fraction = 1.0;
            for (const Met &pair : met) report.fraction = std::min(report.fraction, 0.9 * pair.time);
            for (size_t v = 0; v < vertices; ++v) end[v] = start[v] + report.fraction * (end[v] - start[v]);
            near.set_out(start, end);
            break;
        }
        if (scene.still) { // what has not changed since the last round has not met
            hold_back(scene, start, met, report.rounds, go, end, changed);
            near.set_out_anew(start, end, changed);
        } else {
            if (!zones) zones.emplace(scene);
            zones->join(met);
            zones->move_as_one(start, met, report.rounds < to_touch, end);
            near.set_out(start, end);
        }
    }
    near.arrive();
    report.zone_vertices = int(std::count(in_the_way.begin(), in_the_way.end(), 1));
    return report;
}

} // namespace ringlet
