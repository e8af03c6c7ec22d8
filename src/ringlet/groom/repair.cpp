#include "ringlet/groom/repair.h"

#include "ringlet/geometry/distance.h"
#include "ringlet/geometry/near_segments.h"
#include "ringlet/groom/push_out.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

namespace ringlet {
namespace {

constexpr double rounding = 1e-9;    // [m] a depth below this is none
constexpr double clear = 5e-5;       // [m] what is moved out of a body is moved so far beyond its surface
constexpr double room = 1.15;        // curves are moved apart to that many thicknesses
constexpr double of_one = 4.0;       // parts of one curve count when they are so many thicknesses apart along it
constexpr double firm_body = 4.0;    // how much more it matters to be out of a body than apart from a curve
constexpr double most_firm = 4.0;    // and how much at most, where many places want something
constexpr double spread_over = 4e-3; // [m] length along a curve over which a move dies away
constexpr double ease = 0.05;        // how much it matters that a curve keeps its form and place
constexpr double skin = 2.5e-4;      // [m] points may move so far before pairs are looked for again

double may(const Allowed &allowed, double along) { return along <= allowed.root_length ? allowed.root_depth : 0.0; }

Crossing crossing(View<Vec3> points, const std::array<int, 2> &pair) {
    const auto &[a, b] = pair;
    const ClosestPoints nearest = closest_edge_edge(points[a], points[a + 1], points[b], points[b + 1]);
    const double s = nearest.weights[1], t = -nearest.weights[3];
    const Vec3 apart = points[b] + t * (points[b + 1] - points[b]) - points[a] - s * (points[a + 1] - points[a]);
    return {a, b, s, t, apart, apart.norm()};
}

// Moves of the points after a root that stays: the least of Σ w |δ − wanted|² + ease (stiffness |Δ²δ|² + |δ|²), where what is
// wanted matters enough to be got. A banded LDLᵀ with two bands beside the diagonal.
class LeastChange {
public:
    void operator()(std::span<const Vec3> wanted, std::span<const double> weight, double stiffness, std::span<Vec3> points) {
        const size_t n = points.size();
        const double bend = ease * stiffness;
        diagonal_.assign(n, ease);
        one_.assign(n, 0.0), two_.assign(n, 0.0), moves_.assign(n, Vec3::Zero());
        for (size_t k = 1; k + 1 < n; ++k) { // the second difference about point k
            diagonal_[k - 1] += bend, diagonal_[k] += 4.0 * bend, diagonal_[k + 1] += bend;
            one_[k] -= 2.0 * bend, one_[k + 1] -= 2.0 * bend;
            two_[k + 1] += bend;
        }
        one_[1] = 0.0; // point 0 stays
        if (n > 2) two_[2] = 0.0;
        for (size_t k = 1; k < n; ++k) {
            if (weight[k] <= 0.0) continue;
            const double firm = std::min(weight[k], most_firm) * (1.0 + 50.0 * bend);
            diagonal_[k] += firm;
            moves_[k] = firm / weight[k] * wanted[k];
        }
        for (size_t k = 2; k < n; ++k) {
            const double two = two_[k], one = one_[k] - two * one_[k - 1]; // D L, of which one_ and two_ keep L
            two_[k] = two / diagonal_[k - 2], one_[k] = one / diagonal_[k - 1];
            diagonal_[k] -= one_[k] * one + two_[k] * two;
            moves_[k] -= one_[k] * moves_[k - 1] + two_[k] * moves_[k - 2];
        }
        for (size_t k = n; k-- > 1;) {
            moves_[k] /= diagonal_[k];
            if (k + 1 < n) moves_[k] -= one_[k + 1] * moves_[k + 1];
            if (k + 2 < n) moves_[k] -= two_[k + 2] * moves_[k + 2];
            points[k] += moves_[k];
        }
    }

private:
    std::vector<double> diagonal_, one_, two_; // the matrix, with what ties a point to those one and two before it
    std::vector<Vec3> moves_;
};

} // namespace

std::vector<Sunk> find_sunk(const CurveView &curves, const std::vector<const Solid *> &bodies, const Allowed &allowed) {
    std::vector<Sunk> result;
    const auto floor = [&](double along) { return -may(allowed, along) - rounding; };
    for (size_t body = 0; body < bodies.size(); ++body) {
        const NearCells cells(bodies[body]->mesh(), band);
#pragma omp parallel
        {
            std::vector<Sunk> found;
#pragma omp for schedule(dynamic, 16) nowait
            for (int i = 0; i < curves.count(); ++i)
                sound(curves[i], *bodies[body], cells, 0.0, floor,
                      [&](size_t k, double, double along, const Vec3 &place, const Above &above) {
                          const int point = curves.offsets[i] + static_cast<int>(k);
                          const Sunk here{static_cast<int>(body), point, above.triangle, place,
                                          -above.height - may(allowed, along)};
                          if (found.empty() || found.back().point != point)
                              found.push_back(here);
                          else if (found.back().depth < here.depth) // of several on one segment the deepest
                              found.back() = here;
                      });
#pragma omp critical
            result.insert(result.end(), found.begin(), found.end());
        }
    }
    std::sort(result.begin(), result.end(),
              [](const Sunk &a, const Sunk &b) { return std::tie(a.body, a.point) < std::tie(b.body, b.point); });
    return result;
}

std::vector<Crossing> find_crossings(const CurveView &curves, double thickness) {
    std::vector<Crossing> result;
    for (const auto &pair : near_segments(curves, thickness, of_one * thickness))
        result.push_back(crossing(curves.points, pair));
    return result;
}

Repair::Repair(const CurveView &curves, std::vector<const Solid *> bodies, const Allowed &allowed)
    : offsets_(curves.offsets.begin(), curves.offsets.end()), bodies_(std::move(bodies)), allowed_(allowed),
      points_(curves.points.begin(), curves.points.end()), best_(points_), least_(std::numeric_limits<size_t>::max()),
      wanted_(points_.size()), weight_(points_.size()) {
    for (const Solid *body : bodies_) {
        cells_.emplace_back(body->mesh(), band);
        points_ = push_out(this->curves(), *body, clear, allowed_);
    }
}

int Repair::round() {
    std::fill(wanted_.begin(), wanted_.end(), Vec3::Zero());
    std::fill(weight_.begin(), weight_.end(), 0.0);
    const int wrong = push_apart() + push_out_of_bodies();
    if (static_cast<size_t>(wrong) < least_) {
        least_ = wrong;
        best_ = points_;
    }
    if (wrong > 0) spread();
    return wrong;
}

// Wants, of two segments that are too near, each its half of the way apart.
int Repair::push_apart() {
    const double wide = room * allowed_.thickness;
    double moved2 = seen_.empty() ? std::numeric_limits<double>::infinity() : 0.0;
    for (size_t i = 0; i < seen_.size(); ++i) moved2 = std::max(moved2, (points_[i] - seen_[i]).squaredNorm());
    if (moved2 > skin * skin) {
        pairs_ = near_segments(curves(), wide + 2.0 * skin, of_one * wide);
        seen_ = points_;
    }
    int wrong = 0;
    for (const auto &pair : pairs_) {
        const Crossing at = crossing(points_, pair);
        if (at.distance >= wide) continue;
        wrong += at.distance < allowed_.thickness;
        const Vec3 across = (points_[at.a + 1] - points_[at.a]).cross(points_[at.b + 1] - points_[at.b]);
        const Vec3 way = 0.5 * (wide - at.distance) * (at.distance > 1e-9 ? at.apart : across).stableNormalized();
        want(at.a, at.s, -way, 1.0);
        want(at.b, at.t, way, 1.0);
    }
    return wrong;
}

// Wants, of what is in a body, the nearest way out of it; near the root no farther than it may stay inside.
int Repair::push_out_of_bodies() {
    int wrong = 0;
    const auto goal = [&](double along) {
        return may(allowed_, along) > 0.0 ? -0.5 * may(allowed_, along) : std::min(clear, 0.5 * along);
    };
    const auto floor = [&](double along) { return (goal(along) < 0.0 ? 1.5 : 0.5) * goal(along); };
    for (size_t body = 0; body < bodies_.size(); ++body)
#pragma omp parallel for schedule(dynamic, 16) reduction(+ : wrong)
        for (int i = 0; i < curves().count(); ++i)
            sound(curves()[i], *bodies_[body], cells_[body], 0.5 * clear, floor,
                  [&](size_t k, double at, double along, const Vec3 &place, const Above &above) {
                      wrong += above.height < -may(allowed_, along) - rounding;
                      const Vec3 way = above.foot + goal(along) * above.normal - place;
                      want(offsets_[i] + static_cast<int>(k), at, way, firm_body);
                  });
    return wrong;
}

// Adds to the ends of a segment what moves the place on it by a way.
void Repair::want(int point, double at, const Vec3 &way, double firm) {
    const double squares = at * at + (1.0 - at) * (1.0 - at);
    for (const auto &[end, share] : {std::pair(point, 1.0 - at), std::pair(point + 1, at)}) {
        wanted_[end] += firm * share * share / squares * way;
        weight_[end] += firm * share;
    }
}

void Repair::spread() {
#pragma omp parallel
    {
        LeastChange least_change;
#pragma omp for schedule(dynamic, 16)
        for (int i = 0; i < curves().count(); ++i) {
            const size_t first = offsets_[i], count = offsets_[i + 1] - first;
            const std::span<const double> weight = std::span(weight_).subspan(first, count);
            if (std::none_of(weight.begin(), weight.end(), [](double w) { return w > 0.0; })) continue;
            const std::span<Vec3> points = std::span(points_).subspan(first, count);
            double length = 0.0;
            for (size_t k = 1; k < count; ++k) length += (points[k] - points[k - 1]).norm();
            const double spacing = std::max(length / static_cast<double>(count - 1), 1e-9);
            least_change(std::span(wanted_).subspan(first, count), weight, std::pow(spread_over / spacing, 4), points);
        }
    }
}

} // namespace ringlet
