#include "ringlet/ccd/motion_limiter.h"

#include "ringlet/ccd/settings.h"

#include <algorithm>
#include <functional>
#include <map>
#include <optional>

namespace ringlet {
namespace {

constexpr size_t prefetched_pairs = 6; // loaded ahead of the one that is tested

} // namespace

MotionLimiter::MotionLimiter(const LimitMotionInput &input, PairCache &pairs, std::vector<Vec3> &end, std::vector<Vec3> *apex)
    : input_(input), pairs_(pairs), mesh_(input.connected.mesh), end_(end), apex_(apex),
      strands_(int(input.connected.strands.size()) - 1), transient_(pairs.transient_pairs()), fraction_(strands_, 1.0),
      changed_(end.size(), 0) {
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
int MotionLimiter::strand_of(int v, int w) const {
    const bool moves = mesh_.moves[v] || mesh_.moves[w];
    return moves && mesh_.object[v] < strands_ ? mesh_.object[v] : -1;
}

std::array<int, 2> MotionLimiter::strands_of(const Impact &impact) const {
    const auto &[a0, a1, b0, b1] = impact.vertices;
    return {strand_of(a0, a1), strand_of(b1, b0)};
}

bool MotionLimiter::resolve(const std::vector<Impact> &impacts) {
    for (const int v : changed_list_) changed_[v] = 0;
    changed_list_.clear();
    for (const Impact &impact : impacts) // is checked again: a local correction elsewhere may have left this impact unresolved
        for (const int v : impact.vertices)
            if (mesh_.moves[v]) mark_changed(v);
    measured_ = fraction_;
    const std::vector<int> corrected = correct_locally(impacts);
    limit_strands(impacts, corrected);
    corrected_locally_ |= !corrected.empty();
    const bool any_cloths = input_.connected.cloths.size() > 1;
    return ++round_ > ccd::strand_rounds || corrected_locally_ || any_cloths || !pairs_.is_bounded();
}

// Corrects cloths, and strands that could hardly move, near their impacts. Returns these strands.
std::vector<int> MotionLimiter::correct_locally(const std::vector<Impact> &impacts) {
    const bool any_strands = !input_.whole_strands && round_ < ccd::local_strand_rounds;
    if (!any_strands && input_.connected.cloths.size() <= 1) return {};
    std::map<int, double> fractions; // strand → fraction of its present motion up to its first impact
    std::vector<Correction> corrections(end_.size());
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
    const View<int> offsets = input_.connected.strands;
    std::vector<int> corrected;
    for (const auto &[strand, fraction] : fractions)
        if (any_strands && fraction <= ccd::hardly_moves)
            corrected.push_back(strand);
        else
            std::fill(corrections.begin() + offsets[strand], corrections.begin() + offsets[strand + 1], Correction{});
    const StrainLimit limit{ccd::max_strain, round_ < ccd::local_cloth_rounds ? ccd::max_strain : 0.0};
    spread_correction(input_.connected, input_.start, end_, limit, corrected, corrections);
    for (int v = 0; v < int(corrections.size()); ++v)
        if (corrections[v].weight > 0.0) scale_motion(v, 1.0 - corrections[v].weight);
    return corrected;
}

void MotionLimiter::limit_strands(const std::vector<Impact> &impacts, const std::vector<int> &corrected) {
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
void MotionLimiter::prefetch(View<CandidatePair *> pairs, size_t k) const {
    if (k + 2 * prefetched_pairs < pairs.size()) __builtin_prefetch(pairs[k + 2 * prefetched_pairs]);
    if (k + prefetched_pairs >= pairs.size()) return;
    for (const int edge : pairs[k + prefetched_pairs]->primitive) {
        const int v = mesh_.edges[edge][0]; // the other vertex is next to it
        __builtin_prefetch(&input_.start[v]);
        __builtin_prefetch(&end_[v]);
    }
}

// Adds the events of the impacts that this causes.
void MotionLimiter::limit_strand(int strand, double fraction, std::vector<Event> &events) {
    if (fraction >= fraction_[strand]) return;
    const View<int> offsets = input_.connected.strands;
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
        const double toi = time_of_impact(mesh_, pair, input_.start, end_);
        if (toi <= 1.0) add_event({{a[0], a[1], b[0], b[1]}, toi}, events);
    }
}

// Whether the paths that are left to two strands are longer than a lower bound on their gap. Many are not, and no vertex is
// needed.
bool MotionLimiter::may_have_impact(const CandidatePair &pair) const {
    const auto [length_a, length_b] = pairs_.path_lengths(pair);
    const auto [a, b] = pair.object;
    const double approach = fraction_[a] / measured_[a] * length_a + fraction_[b] / measured_[b] * length_b;
    return !(pair.min_gap - ccd::separation_of_d_hat * pair.d_hat > approach); // a strand that rests: not a number
}

// Of two strands with different fractions the one that goes farther stops just before it meets the other, and goes as far as
// that one at least. With one fraction for both, the pair with the least room would stop all hair in contact with it.
void MotionLimiter::add_event(const Impact &impact, std::vector<Event> &events) const {
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

void MotionLimiter::scale_motion(int v, double factor) {
    const Vec3 &start = input_.start[v];
    end_[v] = start + factor * (end_[v] - start);
    if (apex_ != nullptr) (*apex_)[v] = start + factor * ((*apex_)[v] - start);
    mark_changed(v);
}

CcdReport limit_motion(const LimitMotionInput &input, PairCache &pairs, std::vector<Vec3> &end, std::vector<Vec3> *apex) {
    const auto &[mesh, strands, cloths, neighbours] = input.connected;
    const int max_rounds = int(strands.size() + cloths.size()) + ccd::spare_rounds;
    const auto move = [&] { return Move{input.start, end, apex != nullptr ? View<Vec3>(*apex) : View<Vec3>()}; };
    CcdReport report;
    std::vector<unsigned char> corrected(end.size(), 0);
    std::optional<MotionLimiter> limiter;
    if (input.changed.empty())
        pairs.begin_move(move());
    else
        pairs.update_move(move(), input.changed);
    for (;; ++report.rounds) {
        const std::vector<Impact> impacts = find_impacts(mesh, pairs.impact_candidates(), input.start, end);
        if (report.rounds == 0) report.candidates = pairs.size(), report.impacts = int(impacts.size());
        if (impacts.empty()) break;
        mark_vertices(mesh, impacts, corrected);
        if (report.rounds >= max_rounds) {
            report.fraction = truncate_before_first(impacts, input.start, end);
            pairs.begin_move(move());
            break;
        }
        if (!limiter) limiter.emplace(input, pairs, end, apex);
        if (!limiter->resolve(impacts)) {
            pairs.defer_update(limiter->changed());
            ++report.rounds;
            break;
        }
        pairs.update_move(move(), limiter->changed());
    }
    report.corrected_vertices = int(std::count(corrected.begin(), corrected.end(), 1));
    return report;
}

} // namespace ringlet
