// The pairs that are near one another, found once for the many moves of a step.
#pragma once

#include "ringlet/collision/broad_phase.h"
#include "ringlet/collision/pairs_in_reach.h"
#include "ringlet/collision/path_boxes.h"
#include "ringlet/geometry/rigid_motion.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace ringlet {

struct NearPair {
    std::array<int, 2> of; // two edges, the lower first; or a vertex and a triangle
    bool of_edges;
    double distance;      // r: they touch below it [m]
    mutable double apart; // noted by whoever measures it: no less is between them where things were when they last arrived [m]
    std::array<int, 2> objects;
};

// A pair that is known is apart by what was measured last, less what its two have moved since, on each move by themselves or,
// once they have arrived, relative to one another: while that is enough, nothing has to be computed. Pairs are noted for
// vertices that keep to their corridors. Vertices that do not are quick: their pairs are looked for anew in every move. All
// this says only what need not be looked at; what is found does not depend on it.
//
// Borrows the mesh, which must outlive it.
class NearPairs {
public:
    explicit NearPairs(const CollisionMesh &mesh);

    void forget(); // everything is quick
    // Everything is to go from `start` to `end`: vertices that would leave their corridors get new ones, boxes around their
    // ways, or around the start alone of what goes further than `far` [m], wider by `margin` [m] on each side. Where most
    // would, all do; and if most of them would right after all did, pairs are noted for this move alone, unless they are to
    // serve others, too (`lasts`). `via` as below.
    void note(View<Vec3> start, View<Vec3> end, double margin, double far, View<Vec3> via = {}, bool lasts = true);

    // Everything sets out straight from `start`, where it is, to `end`; or, while it has not arrived, to another end, which
    // differs where vertices have `changed`: one in the triangle of the start and the first end and `via`, or of the start and
    // the first end alone where no via is given.
    void set_out(View<Vec3> start, View<Vec3> end, View<Vec3> via = {});
    void set_out_anew(View<Vec3> start, View<Vec3> end, View<unsigned char> changed, View<Vec3> via = {});
    // The same nearly as one body, by that motion: no more is looked for than what strays from it may meet. Vertices of one
    // number ≥ 0 in `rigid` move by one affine map, others by themselves. Set out anew they may go further away.
    void set_out_as_one(View<Vec3> start, View<Vec3> end, const RigidMotion &motion, View<int> rigid);
    void set_out_as_one_anew(View<Vec3> start, View<Vec3> end, const RigidMotion &motion, View<int> rigid,
                             View<unsigned char> changed);
    // In order, the pairs that may come nearer than half their distance on the way; of those that set out anew, only what has
    // changed. Whoever measures one may note how far it is apart at the start.
    const std::vector<NearPair *> &may_meet() const { return may_meet_; }
    // Those that may come so near if each goes as far as it likes, wherever that leads: of those that are known, and of what is
    // quick, which change with set_out_anew().
    const std::vector<NearPair *> &may_come_near() const { return may_come_near_; }
    const std::vector<NearPair> &passing() const { return passing_; }
    void arrive(View<Vec3> start, View<Vec3> end);          // all of it, or any part of its last way
    void arrive_as_one(View<Vec3> start, View<Vec3> end);   // all of it as it last set out as one
    bool knows_all_here() const { return knows_all_here_; } // that may touch, and nothing need be noted, until they set out

    std::vector<Touch> touching(View<Vec3> positions); // where everything is now, in order
    // In order, of pairs with one of the objects that count, those that may touch somewhere on the last move.
    PairsInReach in_reach(View<unsigned char> objects) const;

    int count() const { return int(known_.size() + passing_.size()); }

private:
    struct Way {             // of a primitive in this move; small, since pairs ask for it in no order
        float length = 0.0f; // [m], rounded up
        bool quick = false;
    };

    enum class Noted { // last, pairs of
        some,
        all,
        this_move // that may touch on it; corridors have no margin
    };

    bool leaves(int v, const Vec3 &to, double by = 0.0) const { // by more than that [m]
        return !((to.array() >= low_[v].array() - by).all() && (to.array() <= high_[v].array() + by).all());
    }
    void fit_ways(View<Vec3> start, View<Vec3> end, View<Vec3> via = {});
    void measure_ways(View<Vec3> start, View<Vec3> end, const Affected &changed, View<Vec3> via = {});
    void mark_changed(const Affected &changed);
    bool reach(const NearPair &pair) const { return pair.apart - way(pair) < pair.distance; }
    bool comes_near(const NearPair &pair) const { return pair.apart - way(pair) < 0.5 * pair.distance; }
    double way(const NearPair &pair) const { return double(first(pair).length) + second(pair).length; }
    bool quick(const NearPair &pair) const { return any_quick_ && (first(pair).quick || second(pair).quick); }
    const Way &first(const NearPair &pair) const { return (pair.of_edges ? edges_ : vertices_)[pair.of[0]]; }
    const Way &second(const NearPair &pair) const { return (pair.of_edges ? edges_ : triangles_)[pair.of[1]]; }
    bool any_of(const NearPair &pair, View<unsigned char> vertices) const;
    bool has_changed(const NearPair &pair) const {
        return pair.of_edges ? changed_edges_[pair.of[0]] || changed_edges_[pair.of[1]]
                             : changed_[pair.of[0]] || changed_triangles_[pair.of[1]];
    }
    std::vector<NearPair> pairs_of(const Candidates &found) const;
    std::vector<NearPair> look_for_quick(View<unsigned char> changed);
    double room(int v, const Vec3 &at) const { // in its corridor, to every side; below 0 outside [m]
        return std::min((at - low_[v]).minCoeff(), (high_[v] - at).minCoeff());
    }
    void go_as_one(View<Vec3> start, View<Vec3> end, const RigidMotion &motion, View<int> rigid, const Affected &changed);
    template <class Counts> std::vector<NearPair *> find_may_meet(const Counts &counts) const;
    void meet_passing();
    double strays(const NearPair &pair) const; // both together, at most [m]

    const CollisionMesh &mesh_;
    const Affected all_;
    BroadPhase broad_phase_;
    PathBoxes ways_of_, homes_;     // boxes of this move; of the corridors
    std::vector<Vec3> low_, high_;  // of the corridors; empty: nothing is known
    std::vector<NearPair> known_;   // in order
    std::vector<NearPair> passing_; // in order: of what is quick, those that may touch in this move
    std::vector<Way> vertices_, edges_, triangles_;
    std::vector<unsigned char> quick_;                                       // vertices
    std::vector<unsigned char> changed_, changed_edges_, changed_triangles_; // since everything set out
    bool any_quick_ = false, knows_all_here_ = false;
    Noted noted_ = Noted::some;
    bool boxes_ways_ = false;           // as one: the broad phase has boxed this move's ways
    double least_radius_ = 0.0;         // of what moves [m]
    std::vector<double> strays_;        // how far each vertex ends from where a motion as one would lead it [m]
    std::vector<NearPair *> may_touch_; // of the known, those whose ways come so near
    std::vector<NearPair *> may_come_near_, may_meet_;
};

// By how much two primitives that move straight can at most come nearer: what they move by together does not count [m].
template <size_t N, size_t M>
double most_nearer(const std::array<int, N> &a, const std::array<int, M> &b, View<Vec3> start, View<Vec3> end) {
    double most = 0.0;
    for (const int v : a)
        for (const int w : b) most = std::max(most, ((end[v] - start[v]) - (end[w] - start[w])).squaredNorm());
    return std::sqrt(most);
}

// The order of pairs: those of edges come first.
template <class Pair> bool before(const Pair &a, const Pair &b) { return a.of_edges != b.of_edges ? a.of_edges : a.of < b.of; }

// Puts `more` among `pairs`, both in order.
template <class Pair> void merge(std::vector<Pair> &pairs, const std::vector<Pair> &more) {
    const size_t size = pairs.size();
    pairs.insert(pairs.end(), more.begin(), more.end());
    std::inplace_merge(pairs.begin(), pairs.begin() + size, pairs.end(), before<Pair>);
}

} // namespace ringlet
