#include "ringlet/ccd/limit_move.h"

#include "ringlet/ccd/settings.h"
#include "ringlet/ccd/spread_correction.h"

#include <algorithm>
#include <functional>
#include <map>
#include <optional>

namespace ringlet {
namespace {

constexpr size_t prefetched_pairs = 6; // loaded ahead of the one that is tested

} // namespace

MoveLimiter::MoveLimiter(const MoveLimits &limits, const MoveCandidates &pairs, PlannedMove &move)
    : limits_(limits), pairs_(pairs), mesh_(pairs.candidates().mesh()), move_(move), strands_(int(limits.offsets.size()) - 1),
      any_cloths_(std::count(mesh_.moves.begin() + limits.offsets.back(), mesh_.moves.end(), 1) > 0),
      transient_(pairs.transient_pairs()), fraction_(strands_, 1.0), changed_(move.to.size(), 0) {
    pairs_of_strand_ = {size_t(strands_), [&](const auto &add) {
                            const auto consider = [&](CandidatePair &pair) {
                                const auto [a, b] = pair.object;
                                if (pair.edge_edge && a < strands_ && b < strands_ && a != b) add(a, &pair), add(b, &pair);
                            };
                            for (CandidatePair *pair : pairs.path_candidates()) consider(*pair);
                            for (CandidatePair &pair : transient_) consider(pair);
                        }};
}

// The strand of an edge; −1: it has none, or does not move.
int MoveLimiter::strand_of(int v, int w) const {
    const bool moves = mesh_.moves[v] || mesh_.moves[w];
    return moves && mesh_.object[v] < strands_ ? mesh_.object[v] : -1;
}

std::array<int, 2> MoveLimiter::strands_of(const Impact &impact) const {
    const auto &[a0, a1, b0, b1] = impact.vertices;
    return {strand_of(a0, a1), strand_of(b1, b0)};
}

void MoveLimiter::resolve(const std::vector<Impact> &impacts) {
    for (const int v : changed_list_) changed_[v] = 0;
    changed_list_.clear();
    for (const Impact &impact : impacts) // is checked again: a local correction elsewhere may have left this impact unresolved
        for (const int v : impact.vertices)
            if (mesh_.moves[v]) mark_changed(v);
    measured_ = fraction_;
    const std::vector<int> corrected = correct_locally(impacts);
    limit_strands(impacts, corrected);
    corrected_locally_ |= !corrected.empty();
    ++round_;
}

bool MoveLimiter::may_leave_impacts() const {
    return round_ > ccd::strand_rounds || corrected_locally_ || any_cloths_ || pairs_.any_escaped();
}

// Corrects cloths, and strands that could hardly move, near their impacts. Returns these strands.
std::vector<int> MoveLimiter::correct_locally(const std::vector<Impact> &impacts) {
    const bool any_strands = limits_.strands == StrandLimit::near_impacts && round_ < ccd::local_strand_rounds;
    if (!any_strands && !any_cloths_) return {};
    std::map<int, double> fractions; // strand → fraction of its present motion up to its first impact
    std::vector<Correction> corrections(move_.to.size());
    for (const Impact &impact : impacts) {
        const auto [a, b] = strands_of(impact);
        if (a >= 0 && b >= 0 && fraction_[a] != fraction_[b] && round_ < ccd::strand_rounds) continue;
        const double fraction = round_ < ccd::strand_rounds ? impact.toi : 0.0;
        for (const int v : impact.vertices) {
            const int object = mesh_.object[v];
            if (!mesh_.moves[v]) continue;
            if (object < strands_) {
                double &least = fractions.try_emplace(object, 1.0).first->second;
                least = std::min(least, fraction);
            }
            corrections[v].weight = std::max(corrections[v].weight, 1.0 - fraction);
        }
    }
    const View<int> offsets = limits_.offsets;
    std::vector<int> corrected;
    for (const auto &[strand, fraction] : fractions)
        if (any_strands && fraction <= ccd::hardly_moves)
            corrected.push_back(strand);
        else
            std::fill(corrections.begin() + offsets[strand], corrections.begin() + offsets[strand + 1], Correction{});
    const double max_strain = round_ < ccd::local_cloth_rounds ? ccd::max_strain : 0.0;
    spread_correction(pairs_.candidates(), limits_.start, move_.to, max_strain, corrections);
    for (int v = 0; v < int(corrections.size()); ++v)
        if (corrections[v].weight > 0.0) scale_motion(v, 1.0 - corrections[v].weight);
    return corrected;
}

void MoveLimiter::limit_strands(const std::vector<Impact> &impacts, const std::vector<int> &corrected) {
    std::vector<Event> events; // a heap
    for (const Impact &impact : impacts) add_event(impact, events);
    const auto is_corrected = [&](int strand) { return std::binary_search(corrected.begin(), corrected.end(), strand); };
    while (!events.empty()) {
        std::pop_heap(events.begin(), events.end(), std::greater<>());
        const Event e = events.back();
        events.pop_back();
        if ((e.a >= 0 && fraction_[e.a] != e.fraction_a) || (e.b >= 0 && fraction_[e.b] != e.fraction_b))
            continue; // superseded
        for (const int strand : {e.a, e.b})
            if (strand >= 0 && !is_corrected(strand)) limit_strand(strand, e.fraction, events);
    }
}

// Pairs of a strand lead all over memory: those to come are loaded while one is tested.
void MoveLimiter::prefetch(View<CandidatePair *> pairs, size_t k) const {
    if (k + 2 * prefetched_pairs < pairs.size()) __builtin_prefetch(pairs[k + 2 * prefetched_pairs]);
    if (k + prefetched_pairs >= pairs.size()) return;
    for (const int edge : pairs[k + prefetched_pairs]->primitive) {
        const int v = mesh_.edges[edge][0]; // the other vertex is next to it
        __builtin_prefetch(&limits_.start[v]);
        __builtin_prefetch(&move_.to[v]);
    }
}

// Adds the events of the impacts that this causes.
void MoveLimiter::limit_strand(int strand, double fraction, std::vector<Event> &events) {
    if (fraction >= fraction_[strand]) return;
    const View<int> offsets = limits_.offsets;
    const double factor = fraction / fraction_[strand];
    for (int v = offsets[strand]; v < offsets[strand + 1]; ++v)
        if (mesh_.moves[v]) scale_motion(v, factor);
    fraction_[strand] = fraction;
    const View<CandidatePair *> pairs = pairs_of_strand_.of(strand);
    for (size_t k = 0; k < pairs.size(); ++k) {
        prefetch(pairs, k);
        CandidatePair &pair = *pairs[k];
        if (fraction_[pair.object[0]] == fraction_[pair.object[1]]) continue; // its impact is known from before
        if (!may_have_impact(pair)) continue;
        const auto &a = mesh_.edges[pair.primitive[0]], &b = mesh_.edges[pair.primitive[1]];
        if (strand_of(a[0], a[1]) < 0 || strand_of(b[0], b[1]) < 0) continue;
        const double toi = time_of_impact(mesh_, pair, limits_.start, move_.to);
        if (toi <= 1.0) add_event({{a[0], a[1], b[0], b[1]}, toi}, events);
    }
}

// Whether the paths that are left to two strands are longer than a lower bound on their gap. Many are not, and no vertex is
// needed.
bool MoveLimiter::may_have_impact(const CandidatePair &pair) const {
    const auto [length_a, length_b] = pairs_.path_lengths(pair);
    const auto [a, b] = pair.object;
    const double approach = fraction_[a] / measured_[a] * length_a + fraction_[b] / measured_[b] * length_b;
    return !(pair.min_gap - ccd::separation_of_d_hat * pair.d_hat > approach); // a strand that rests: not a number
}

// Of two strands with different fractions the one that goes farther stops just before it meets the other, and goes as far as
// that one at least. With one fraction for both, the pair with the least room would stop all hair in contact with it.
void MoveLimiter::add_event(const Impact &impact, std::vector<Event> &events) const {
    const auto [a, b] = strands_of(impact);
    if (a < 0 && b < 0) return;
    const double fraction_a = a >= 0 ? fraction_[a] : 1.0, fraction_b = b >= 0 ? fraction_[b] : 1.0;
    double fraction = 0.0;
    if (round_ < ccd::strand_rounds) {
        const bool differ = a >= 0 && b >= 0 && fraction_a != fraction_b;
        const auto [least, most] = std::minmax(fraction_a, fraction_b);
        fraction =
            differ ? std::max(least, ccd::before_impact * impact.toi * most) : impact.toi * (a >= 0 ? fraction_a : fraction_b);
    }
    events.push_back({fraction, a, b, fraction_a, fraction_b});
    std::push_heap(events.begin(), events.end(), std::greater<>());
}

void MoveLimiter::scale_motion(int v, double factor) {
    const Vec3 &start = limits_.start[v];
    move_.to[v] = start + factor * (move_.to[v] - start);
    if (!move_.apex.empty()) move_.apex[v] = start + factor * (move_.apex[v] - start);
    mark_changed(v);
}

CcdReport limit_move(const MoveLimits &limits, MoveCandidates &pairs, PlannedMove &move) {
    const CollisionMesh &mesh = pairs.candidates().mesh();
    const int max_rounds = (mesh.object.empty() ? 0 : mesh.object.back() + 1) + ccd::spare_rounds;
    const auto path = [&] { return Move{limits.start, move.to, move.apex}; };
    CcdReport report;
    std::vector<unsigned char> corrected(move.to.size(), 0);
    std::optional<MoveLimiter> limiter;
    for (;; ++report.rounds) {
        const std::vector<Impact> impacts = find_impacts(mesh, pairs.impact_candidates(), limits.start, move.to);
        if (report.rounds == 0) report.candidates = pairs.size(), report.impacts = int(impacts.size());
        if (impacts.empty()) break;
        mark_vertices(mesh, impacts, corrected);
        if (report.rounds >= max_rounds) {
            report.fraction = truncate_before_first(impacts, limits.start, move.to);
            pairs.shorten(path(), std::vector<unsigned char>(move.to.size(), 1));
            break;
        }
        if (!limiter) limiter.emplace(limits, pairs, move);
        limiter->resolve(impacts);
        if (!limiter->may_leave_impacts()) {
            pairs.shorten(path(), limiter->changed());
            ++report.rounds;
            break;
        }
        pairs.update(path(), limiter->changed());
    }
    report.corrected_vertices = int(std::count(corrected.begin(), corrected.end(), 1));
    return report;
}

} // namespace ringlet
