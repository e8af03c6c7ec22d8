#include "ringlet/ccd/limit_move.h"

#include "ringlet/ccd/settings.h"
#include "ringlet/ccd/spread_correction.h"

#include <algorithm>
#include <atomic>
#include <map>
#include <optional>

namespace ringlet {
namespace {

constexpr size_t prefetched_pairs = 6; // loaded ahead of the one that is tested
constexpr int few_objects = 32;        // fewer are not worth threads

// One call of limit_move(). The whole objects of an impact are scaled to its time, and one that then hits another with a
// smaller fraction stops before that. Such chains are resolved within a round, in passes over events: all at once that come
// first for both their objects, as the edges of a locally dominant matching (Preis 1999). What was corrected locally is checked
// in a further round. After some rounds objects with an impact rest, and two that rest have none.
class MoveLimiter {
public:
    MoveLimiter(MoveCandidates &pairs, View<Vec3> start, PlannedMove &move, Yield yield);

    // Resolves impacts among the vertices that the last round changed.
    void resolve(const std::vector<Impact> &impacts);
    // Whether impacts may be left: events find those of whole objects with one another, and bodies stay.
    bool may_leave_impacts() const;
    const std::vector<unsigned char> &changed() const { return changed_; } // vertices, in the last round

private:
    // At `fraction` of their motions whole objects a and b have an impact. Valid while their own fractions are unchanged.
    struct Event {
        double fraction;
        int a, b; // −1: not a whole object that moves
        double fraction_a, fraction_b;

        bool operator<(const Event &other) const {
            if (fraction != other.fraction) return fraction < other.fraction;
            return a != other.a ? a < other.a : b < other.b;
        }
    };

    bool correct_locally(const std::vector<Impact> &impacts);
    void limit_whole(const std::vector<Impact> &impacts);
    void find_first_events(const std::vector<int> &objects);
    bool is_first_of_both(const Event &event) const;
    bool is_superseded(const Event &event) const;
    bool shortens(double fraction, int object) const;
    void limit_object(int object, double fraction);
    void find_events(int object);
    void add_event(const Impact &impact, int object);
    std::array<int, 2> whole_objects_of(const Impact &impact) const;
    int whole_object_of(int v, int w) const;
    void scale_motion(int v, double factor);
    void prefetch(View<CandidatePair *> pairs, size_t k) const;
    bool may_have_impact(const CandidatePair &pair) const;

    const MoveCandidates &pairs_;
    const CollisionMesh &mesh_;
    View<Vec3> start_;
    PlannedMove &move_;
    Yield yield_;
    int round_ = 0;
    bool any_local_ = false;                        // whether objects that are not whole move in any pair
    bool corrected_locally_ = false;                // in any round: what was known of impacts no longer holds
    std::vector<CandidatePair> transient_;          // as in the first round; later rounds change those of the cache
    Lists<CandidatePair *> pairs_of_object_;        // of two whole objects that may come together on their paths
    std::vector<double> fraction_, measured_;       // of its motion that each object makes, now and when paths were measured
    std::vector<unsigned char> changed_;            // per vertex
    std::vector<std::vector<Event>> events_;        // that each object has found
    std::vector<std::atomic<const Event *>> first_; // of the events that concern each object
    int pass_ = 0;                                  // counted through all rounds
    std::vector<int> limited_in_;                   // pass in which each object was limited last
    std::vector<unsigned char> stays_;              // whole objects that were corrected locally in this round
};

MoveLimiter::MoveLimiter(MoveCandidates &pairs, View<Vec3> start, PlannedMove &move, Yield yield)
    : pairs_(pairs), mesh_(pairs.candidates().mesh()), start_(start), move_(move), yield_(yield),
      transient_(pairs.transient_pairs()), fraction_(mesh_.objects.size(), 1.0), changed_(move.to.size(), 0),
      events_(mesh_.objects.size()), first_(mesh_.objects.size()), limited_in_(mesh_.objects.size(), 0),
      stays_(mesh_.objects.size(), 0) {
    const std::vector<CandidatePair *> &cached = pairs_.path_candidates();
    const int count = int(cached.size());
    const auto pair_of = [&](int k) { return k < count ? cached[k] : &transient_[k - count]; };
    const auto is_whole = [&](int object) { return mesh_.objects[object].whole; };
    pairs_of_object_ = {mesh_.objects.size(), count + int(transient_.size()), [&](int k, const auto &add) {
                            CandidatePair *const pair = pair_of(k);
                            const int a = pair->object[0], b = pair->object[1];
                            if (pair->edge_edge && a != b && is_whole(a) && is_whole(b)) add(a, pair), add(b, pair);
                        }};
    const auto moves = [&](const auto &primitive) {
        return !is_whole(mesh_.object[primitive[0]]) && any_of(mesh_.moves, primitive);
    };
    const bool all_whole = std::all_of(mesh_.objects.begin(), mesh_.objects.end(), [&](const CollisionObject &object) {
        return object.whole ||
               std::count(mesh_.moves.begin() + object.first, mesh_.moves.begin() + object.end, 0) == object.end - object.first;
    });
    for (int k = 0; !all_whole && !any_local_ && k < count + int(transient_.size()); ++k)
        any_local_ = with_vertices(mesh_, *pair_of(k), [&](const auto &a, const auto &b) { return moves(a) || moves(b); });
}

// The whole object of an edge; −1: it has none, or does not move.
int MoveLimiter::whole_object_of(int v, int w) const {
    const bool moves = mesh_.moves[v] || mesh_.moves[w];
    return moves && mesh_.objects[mesh_.object[v]].whole ? mesh_.object[v] : -1;
}

// An impact of an object with itself has one.
std::array<int, 2> MoveLimiter::whole_objects_of(const Impact &impact) const {
    const auto &[a0, a1, b0, b1] = impact.vertices;
    const int a = whole_object_of(a0, a1), b = whole_object_of(b1, b0);
    return {a, a == b ? -1 : b};
}

void MoveLimiter::resolve(const std::vector<Impact> &impacts) {
    std::fill(changed_.begin(), changed_.end(), 0);
    mark_vertices(mesh_, impacts, changed_); // checked again: a local correction elsewhere may have left an impact unresolved
    measured_ = fraction_;
    corrected_locally_ |= correct_locally(impacts);
    limit_whole(impacts);
    ++round_;
}

bool MoveLimiter::may_leave_impacts() const {
    return round_ > ccd::whole_rounds || corrected_locally_ || any_local_ || pairs_.any_escaped();
}

// Corrects objects near their impacts that are not whole, and whole ones that could hardly move. Returns whether there are any
// of the latter.
bool MoveLimiter::correct_locally(const std::vector<Impact> &impacts) {
    const bool any_whole = yield_ == Yield::near_impacts && round_ < ccd::local_rounds;
    std::fill(stays_.begin(), stays_.end(), 0);
    if (!any_whole && !any_local_) return false;
    std::map<int, double> fractions; // whole object → fraction of its present motion up to its first impact
    std::vector<Correction> corrections(move_.to.size());
    for (const Impact &impact : impacts) {
        const auto [a, b] = whole_objects_of(impact);
        if (a >= 0 && b >= 0 && fraction_[a] != fraction_[b] && round_ < ccd::whole_rounds) continue;
        const double fraction = round_ < ccd::whole_rounds ? impact.toi : 0.0;
        for (const int v : impact.vertices) {
            const int object = mesh_.object[v];
            if (!mesh_.moves[v]) continue;
            if (mesh_.objects[object].whole) {
                double &least = fractions.try_emplace(object, 1.0).first->second;
                least = std::min(least, fraction);
            }
            corrections[v].weight = std::max(corrections[v].weight, 1.0 - fraction);
        }
    }
    bool any = false;
    for (const auto &[object, fraction] : fractions)
        if (any_whole && fraction <= ccd::hardly_moves)
            stays_[object] = any = true;
        else
            std::fill(corrections.begin() + mesh_.objects[object].first, corrections.begin() + mesh_.objects[object].end,
                      Correction{});
    const double max_strain = round_ < ccd::spread_rounds ? ccd::max_strain : 0.0;
    spread_correction(pairs_.candidates(), start_, move_.to, max_strain, corrections);
    for (int v = 0; v < int(corrections.size()); ++v)
        if (corrections[v].weight > 0.0) scale_motion(v, 1.0 - corrections[v].weight);
    return any;
}

void MoveLimiter::limit_whole(const std::vector<Impact> &impacts) {
    for (const Impact &impact : impacts) {
        const auto [a, b] = whole_objects_of(impact);
        if (a >= 0 || b >= 0) add_event(impact, std::max(a, b));
    }
    for (++pass_;; ++pass_) {
        const std::vector<int> objects = collect<int>(int(events_.size()), [&](int object, std::vector<int> &all) {
            std::erase_if(events_[object], [&](const Event &event) { return is_superseded(event); });
            if (!events_[object].empty()) all.push_back(object);
        });
        if (objects.empty()) break;
        find_first_events(objects);
        struct Limit {
            int object;
            double fraction;
        };
        const std::vector<Limit> limits = collect<Limit>(int(objects.size()), [&](int k, std::vector<Limit> &all) {
            for (const Event &event : events_[objects[k]])
                if (is_first_of_both(event))
                    for (const int object : {event.a, event.b})
                        if (shortens(event.fraction, object)) all.push_back({object, event.fraction});
        });
        parallel_for(int(limits.size()), few_objects, [&](int k) { limit_object(limits[k].object, limits[k].fraction); });
        parallel_chunks(int(limits.size()), 1, [&](int k) { find_events(limits[k].object); });
    }
}

// Of each object, among the events of `objects`.
void MoveLimiter::find_first_events(const std::vector<int> &objects) {
    const auto for_ends = [&](const auto &work) {
        parallel_for(int(objects.size()), few_objects, [&](int k) {
            for (const Event &event : events_[objects[k]])
                for (const int object : {event.a, event.b})
                    if (object >= 0) work(first_[object], event);
        });
    };
    for_ends([](std::atomic<const Event *> &first, const Event &) { first = nullptr; });
    for_ends([](std::atomic<const Event *> &first, const Event &event) {
        const Event *known = first;
        while ((!known || event < *known) && !first.compare_exchange_weak(known, &event)) {
        }
    });
}

bool MoveLimiter::is_first_of_both(const Event &event) const {
    return (event.a < 0 || first_[event.a] == &event) && (event.b < 0 || first_[event.b] == &event);
}

bool MoveLimiter::is_superseded(const Event &event) const {
    return (event.a >= 0 && fraction_[event.a] != event.fraction_a) || (event.b >= 0 && fraction_[event.b] != event.fraction_b);
}

// Whether an event at a fraction limits an object further.
bool MoveLimiter::shortens(double fraction, int object) const {
    return object >= 0 && !stays_[object] && fraction < fraction_[object];
}

// Pairs of an object lead all over memory: those to come are loaded while one is tested.
void MoveLimiter::prefetch(View<CandidatePair *> pairs, size_t k) const {
    if (k + 2 * prefetched_pairs < pairs.size()) __builtin_prefetch(pairs[k + 2 * prefetched_pairs]);
    if (k + prefetched_pairs >= pairs.size()) return;
    for (const int edge : pairs[k + prefetched_pairs]->primitive) {
        const int v = mesh_.edges[edge][0]; // the other vertex is next to it
        __builtin_prefetch(&start_[v]);
        __builtin_prefetch(&move_.to[v]);
    }
}

void MoveLimiter::limit_object(int object, double fraction) {
    const double factor = fraction / fraction_[object];
    for (int v = mesh_.objects[object].first; v < mesh_.objects[object].end; ++v)
        if (mesh_.moves[v]) scale_motion(v, factor);
    fraction_[object] = fraction;
    limited_in_[object] = pass_;
}

// Those of an object that has been limited. A pair of two such objects is that of the first one.
void MoveLimiter::find_events(int object) {
    events_[object].clear();
    const View<CandidatePair *> pairs = pairs_of_object_.of(object);
    for (size_t k = 0; k < pairs.size(); ++k) {
        prefetch(pairs, k);
        CandidatePair &pair = *pairs[k];
        const int other = pair.object[0] == object ? pair.object[1] : pair.object[0];
        if (fraction_[object] == fraction_[other]) continue; // its impact is known from before
        if (limited_in_[other] == pass_ && other < object) continue;
        if (!may_have_impact(pair)) continue;
        const auto &a = mesh_.edges[pair.primitive[0]], &b = mesh_.edges[pair.primitive[1]];
        if (whole_object_of(a[0], a[1]) < 0 || whole_object_of(b[0], b[1]) < 0) continue;
        const double toi = time_of_impact(mesh_, pair, start_, move_.to);
        if (toi <= 1.0) add_event({{a[0], a[1], b[0], b[1]}, toi}, object);
    }
}

// Whether the paths that are left to two objects are longer than a lower bound on their gap. Many are not, and no vertex is
// needed.
bool MoveLimiter::may_have_impact(const CandidatePair &pair) const {
    const auto [length_a, length_b] = pairs_.path_lengths(pair);
    const auto [a, b] = pair.object;
    const double approach = fraction_[a] / measured_[a] * length_a + fraction_[b] / measured_[b] * length_b;
    return !(pair.min_gap - ccd::separation_of_d_hat * pair.d_hat > approach); // an object that rests: not a number
}

// Of two objects with different fractions the one that goes farther stops just before it meets the other, and goes as far as
// that one at least. With one fraction for both, the pair with the least room would stop all hair in contact with it.
void MoveLimiter::add_event(const Impact &impact, int object) {
    const auto [a, b] = whole_objects_of(impact);
    const double fraction_a = a >= 0 ? fraction_[a] : 1.0, fraction_b = b >= 0 ? fraction_[b] : 1.0;
    double fraction = 0.0;
    if (round_ < ccd::whole_rounds) {
        const bool differ = a >= 0 && b >= 0 && fraction_a != fraction_b;
        const auto [least, most] = std::minmax(fraction_a, fraction_b);
        fraction =
            differ ? std::max(least, ccd::before_impact * impact.toi * most) : impact.toi * (a >= 0 ? fraction_a : fraction_b);
    }
    if (shortens(fraction, a) || shortens(fraction, b)) events_[object].push_back({fraction, a, b, fraction_a, fraction_b});
}

void MoveLimiter::scale_motion(int v, double factor) {
    const Vec3 &start = start_[v];
    move_.to[v] = start + factor * (move_.to[v] - start);
    if (!move_.apex.empty()) move_.apex[v] = start + factor * (move_.apex[v] - start);
    changed_[v] = 1;
}

} // namespace

CcdReport limit_move(MoveCandidates &pairs, View<Vec3> start, PlannedMove &move, Yield yield) {
    const CollisionMesh &mesh = pairs.candidates().mesh();
    const int max_rounds = int(mesh.objects.size()) + ccd::spare_rounds;
    const auto path = [&] { return Move{start, move.to, move.apex}; };
    CcdReport report;
    std::vector<unsigned char> corrected(move.to.size(), 0);
    std::optional<MoveLimiter> limiter;
    for (int round = 0;; ++round) {
        const std::vector<Impact> impacts = find_impacts(mesh, pairs.impact_candidates(), start, move.to);
        if (round == 0) report.candidates = pairs.size(), report.impacts = int(impacts.size());
        if (impacts.empty()) break;
        mark_vertices(mesh, impacts, corrected);
        if (round >= max_rounds) {
            report.fraction = truncate_before_first(impacts, start, move.to);
            pairs.shorten(path(), std::vector<unsigned char>(move.to.size(), 1));
            break;
        }
        if (!limiter) limiter.emplace(pairs, start, move, yield);
        limiter->resolve(impacts);
        if (!limiter->may_leave_impacts()) {
            pairs.shorten(path(), limiter->changed());
            break;
        }
        pairs.update(path(), limiter->changed());
    }
    report.corrected_vertices = int(std::count(corrected.begin(), corrected.end(), 1));
    return report;
}

} // namespace ringlet
