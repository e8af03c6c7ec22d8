#include "ringlet/ccd/hold_back.h"

#include "ringlet/ccd/fade.h"

#include <algorithm>
#include <functional>
#include <map>

namespace ringlet {
namespace {

constexpr int rounds = 8;      // after which strands stay
constexpr double hardly = 0.2; // of its way

} // namespace

HoldBack::HoldBack(const FilterScene &scene, const NearPairs &near, View<Vec3> start, std::vector<Vec3> &end)
    : scene_(scene), start_(start), end_(end), strands_(int(scene.offsets.size()) - 1), passing_(near.passing()),
      go_(strands_, 1.0), changed_(start.size(), 0) {
    of_strands_ = {size_t(strands_), [&](const auto &work) {
                       const auto look_at = [&](const NearPair &pair) {
                           const auto [a, b] = pair.objects;
                           if (pair.of_edges && a < strands_ && b < strands_ && a != b) work(a, &pair), work(b, &pair);
                       };
                       for (const NearPair *pair : near.may_come_near()) look_at(*pair);
                       for (const NearPair &pair : passing_) look_at(pair);
                   }};
}

int HoldBack::strand_of(int v, int w) const {
    const bool moves = scene_.mesh.moves[v] || scene_.mesh.moves[w];
    return moves && scene_.mesh.object[v] < strands_ ? scene_.mesh.object[v] : -1;
}

void HoldBack::round(const std::vector<Met> &met) {
    for (const int v : touched_) changed_[v] = 0;
    touched_.clear();
    for (const Met &pair : met) // is asked again: one of the two may be held back elsewhere, and not stop as a whole for it
        for (const int v : pair.vertices)
            if (scene_.mesh.moves[v]) change(v);
    stop(met, hold_near(met));
    ++round_;
}

// Cloths, and strands that could hardly move.
std::vector<int> HoldBack::hold_near(const std::vector<Met> &met) {
    constexpr int local_rounds = 2, local_rounds_of_cloth = 16;
    const bool of_strands = !scene_.whole && round_ < local_rounds;
    if (!of_strands && scene_.cloths.size() <= 1) return {};
    std::map<int, double> parts; // strand → how much of what is left to it now
    std::vector<Pull> pulls(start_.size());
    for (const Met &pair : met) {
        const int a = strand_of(pair.vertices[0], pair.vertices[1]), b = strand_of(pair.vertices[3], pair.vertices[2]);
        if (a >= 0 && b >= 0 && go_[a] != go_[b] && round_ < rounds) continue;
        const double part = round_ < rounds ? pair.time : 0.0;
        for (const int v : pair.vertices) {
            const int object = scene_.mesh.object[v];
            if (!scene_.mesh.moves[v]) continue;
            if (object < strands_) {
                double &whole = parts.try_emplace(object, 1.0).first->second;
                whole = std::min(whole, part);
            }
            pulls[v].part = std::max(pulls[v].part, 1.0 - part);
        }
    }
    std::vector<int> held;
    for (const auto &[strand, part] : parts)
        if (of_strands && part <= hardly)
            held.push_back(strand);
        else
            std::fill(pulls.begin() + scene_.offsets[strand], pulls.begin() + scene_.offsets[strand + 1], Pull{});
    fade(scene_, start_, end_, {most_strain, round_ < local_rounds_of_cloth ? most_strain : 0.0}, held, pulls);
    for (int v = 0; v < int(pulls.size()); ++v)
        if (pulls[v].part > 0.0) draw_back(v, 1.0 - pulls[v].part);
    return held;
}

// Event by event, the one that lets go least first: what it stops is asked at once whether it is in the way of others.
void HoldBack::stop(const std::vector<Met> &met, const std::vector<int> &held_near) {
    std::vector<Event> events; // a heap
    for (const Met &pair : met) note(pair, events);
    const auto holds = [&](int strand) { return std::binary_search(held_near.begin(), held_near.end(), strand); };
    while (!events.empty()) {
        std::pop_heap(events.begin(), events.end(), std::greater<>());
        const Event e = events.back();
        events.pop_back();
        if ((e.a >= 0 && go_[e.a] != e.go_a) || (e.b >= 0 && go_[e.b] != e.go_b)) continue; // was asked again
        for (const int strand : {e.a, e.b})
            if (strand >= 0 && !holds(strand)) stop(strand, e.go, events);
    }
}

void HoldBack::stop(int strand, double go, std::vector<Event> &events) {
    if (go >= go_[strand]) return;
    scale(strand, go / go_[strand]);
    go_[strand] = go;
    for (const NearPair *pair : of_strands_.of(strand)) {
        if (go_[pair->objects[0]] == go_[pair->objects[1]]) continue; // it was asked when they would meet
        const auto &a = scene_.mesh.edges[pair->of[0]], &b = scene_.mesh.edges[pair->of[1]];
        if (strand_of(a[0], a[1]) < 0 || strand_of(b[0], b[1]) < 0) continue;
        const double time = meeting_time(scene_.mesh, *pair, start_, end_);
        if (time <= 1.0) note({{a[0], a[1], b[0], b[1]}, time}, events);
    }
}

// Of two that do not go equally far, the one ahead is first made to.
void HoldBack::note(const Met &pair, std::vector<Event> &events) const {
    const int a = strand_of(pair.vertices[0], pair.vertices[1]), b = strand_of(pair.vertices[3], pair.vertices[2]);
    if (a < 0 && b < 0) return;
    const double go_a = a >= 0 ? go_[a] : 1.0, go_b = b >= 0 ? go_[b] : 1.0;
    double go = 0.0;
    if (round_ < rounds) go = a >= 0 && b >= 0 && go_a != go_b ? std::min(go_a, go_b) : pair.time * (a >= 0 ? go_a : go_b);
    events.push_back({go, a, b, go_a, go_b});
    std::push_heap(events.begin(), events.end(), std::greater<>());
}

void HoldBack::scale(int strand, double part) {
    for (int v = scene_.offsets[strand]; v < scene_.offsets[strand + 1]; ++v)
        if (scene_.mesh.moves[v]) draw_back(v, part);
}

void HoldBack::draw_back(int v, double part) {
    end_[v] = start_[v] + part * (end_[v] - start_[v]);
    if (scene_.via != nullptr) (*scene_.via)[v] = start_[v] + part * ((*scene_.via)[v] - start_[v]);
    change(v);
}

} // namespace ringlet
