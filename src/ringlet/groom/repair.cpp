#include "ringlet/groom/repair.h"

#include "ringlet/geometry/distance.h"
#include "ringlet/geometry/near_segments.h"
#include "ringlet/groom/keep_form.h"
#include "ringlet/groom/push_out.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

namespace ringlet {
namespace {

constexpr double rounding = 1e-9;         // [m] depths below this count as 0
constexpr double body_clearance = 5e-5;   // [m] target distance outside of a body
constexpr double clearance = 1.15;        // target distance of two curves, in thicknesses
constexpr double least_along = 4.0;       // arc length from which two segments of one curve count, in touching distances
constexpr double body_weight = 4.0;       // weight of a target outside of a body, beside 1 for one away from a curve
constexpr double largest_weight = 4.0;    // largest sum of weights at a point
constexpr double smoothing_length = 4e-3; // [m] length along a curve over which a move decays
constexpr double regularisation = 0.05;   // weight of keeping form and place
constexpr double largest_stretch_repaired = 1.25; // of a curve
constexpr double skin = 2.5e-4;                   // [m] motion of points after which candidate pairs are searched again

double allowed_depth(const Allowed &allowed, double along) { return along <= allowed.root_length ? allowed.root_depth : 0.0; }

Overlap overlap_of(View<Vec3> points, const std::array<int, 2> &pair) {
    const auto &[a, b] = pair;
    const ClosestPoints nearest = closest_edge_edge(points[a], points[a + 1], points[b], points[b + 1]);
    const double s = nearest.weights[1], t = -nearest.weights[3];
    const Vec3 separation = points[b] + t * (points[b + 1] - points[b]) - points[a] - s * (points[a + 1] - points[a]);
    return {a, b, s, t, separation, separation.norm()};
}

// Minimiser of Σ w |δ − target|² + λ (stiffness |Δ²δ|² + |δ|²) over the moves δ of a curve whose root is fixed, with λ the
// regularisation. Weights w grow with the stiffness, so that targets are reached. The solver is a banded LDLᵀ with two bands
// beside the diagonal.
class SmoothestMoves {
public:
    void operator()(std::span<const Vec3> target, std::span<const double> weight, double stiffness, std::span<Vec3> points) {
        const size_t n = points.size();
        const double bend = regularisation * stiffness;
        diagonal_.assign(n, regularisation);
        one_.assign(n, 0.0), two_.assign(n, 0.0), moves_.assign(n, Vec3::Zero());
        for (size_t k = 1; k + 1 < n; ++k) { // the second difference about point k
            diagonal_[k - 1] += bend, diagonal_[k] += 4.0 * bend, diagonal_[k + 1] += bend;
            one_[k] -= 2.0 * bend, one_[k + 1] -= 2.0 * bend;
            two_[k + 1] += bend;
        }
        one_[1] = 0.0; // point 0 is fixed
        if (n > 2) two_[2] = 0.0;
        for (size_t k = 1; k < n; ++k) {
            if (weight[k] <= 0.0) continue;
            const double w = std::min(weight[k], largest_weight) * (1.0 + 50.0 * bend);
            diagonal_[k] += w;
            moves_[k] = w / weight[k] * target[k];
        }
        for (size_t k = 2; k < n; ++k) {
            const double two = two_[k], one = one_[k] - two * one_[k - 1]; // of D L; one_ and two_ store L
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
    std::vector<double> diagonal_, one_, two_; // the matrix: its diagonal and the two bands below it
    std::vector<Vec3> moves_;
};

} // namespace

std::vector<Penetration> find_penetrations(const CurveView &curves, const std::vector<const Solid *> &bodies,
                                           const Allowed &allowed) {
    std::vector<Penetration> result;
    const auto floor = [&](double along) { return -allowed_depth(allowed, along) - rounding; };
    for (size_t body = 0; body < bodies.size(); ++body) {
        const std::shared_ptr<const ProximityGrid> grid = bodies[body]->cells_within(least_probe_distance);
#pragma omp parallel
        {
            std::vector<Penetration> found;
#pragma omp for schedule(dynamic, 16) nowait
            for (int i = 0; i < curves.count(); ++i)
                find_below(curves[i], *bodies[body], *grid, 0.0, floor,
                           [&](size_t k, double, double along, const Vec3 &place, const SignedDistance &above) {
                               const int point = curves.offsets[i] + static_cast<int>(k);
                               const Penetration here{static_cast<int>(body), point, above.triangle, place,
                                                      -above.distance - allowed_depth(allowed, along)};
                               if (found.empty() || found.back().point != point)
                                   found.push_back(here);
                               else if (found.back().depth < here.depth) // the deepest of one segment
                                   found.back() = here;
                           });
#pragma omp critical
            result.insert(result.end(), found.begin(), found.end());
        }
    }
    std::sort(result.begin(), result.end(),
              [](const Penetration &a, const Penetration &b) { return std::tie(a.body, a.point) < std::tie(b.body, b.point); });
    return result;
}

std::vector<Overlap> find_overlaps(const CurveView &curves, View<double> radius) {
    std::vector<Overlap> result;
    for (const auto &pair : near_segments(curves, radius, least_along)) result.push_back(overlap_of(curves.points, pair));
    return result;
}

Repair::Repair(const CurveView &curves, std::vector<const Solid *> bodies, const Allowed &allowed)
    : offsets_(curves.offsets.begin(), curves.offsets.end()), bodies_(std::move(bodies)), allowed_(allowed),
      before_(curves.points.begin(), curves.points.end()), points_(before_), best_(before_),
      fewest_(std::numeric_limits<size_t>::max()), target_(points_.size()), weight_(points_.size()) {
    for (const Solid *body : bodies_) grids_.push_back(body->cells_within(least_probe_distance));
    points_ = push_out(this->curves(), bodies_, body_clearance, allowed_);
}

int Repair::round() {
    std::fill(target_.begin(), target_.end(), Vec3::Zero());
    std::fill(weight_.begin(), weight_.end(), 0.0);
    const int violations = push_apart() + push_out_of_bodies();
    if (static_cast<size_t>(violations) < fewest_) {
        fewest_ = violations;
        best_ = points_;
    }
    if (violations > 0) solve_moves();
    return violations;
}

std::vector<Vec3> Repair::points() const {
    std::vector<Vec3> result = best_;
    const CurveView before{before_, offsets_};
    for (int i = 0; i < before.count(); ++i)
        keep_form(before[i], largest_stretch_repaired, std::span(result).subspan(offsets_[i], before[i].size()));
    return result;
}

// Adds targets for overlapping segments: each moves by half of the missing distance. Returns the number of violations.
int Repair::push_apart() {
    const double wide = clearance * allowed_.thickness;
    double moved2 = searched_.empty() ? std::numeric_limits<double>::infinity() : 0.0;
    for (size_t i = 0; i < searched_.size(); ++i) moved2 = std::max(moved2, (points_[i] - searched_[i]).squaredNorm());
    if (moved2 > skin * skin) {
        const std::vector<double> radius(points_.size(), 0.5 * wide + skin);
        pairs_ = near_segments(curves(), radius, least_along * wide / (wide + 2.0 * skin));
        searched_ = points_;
    }
    int violations = 0;
    for (const auto &pair : pairs_) {
        const Overlap at = overlap_of(points_, pair);
        if (at.distance >= wide) continue;
        violations += at.distance < allowed_.thickness;
        const Vec3 across = (points_[at.a + 1] - points_[at.a]).cross(points_[at.b + 1] - points_[at.b]);
        const Vec3 move = 0.5 * (wide - at.distance) * (at.distance > 1e-9 ? at.separation : across).stableNormalized();
        add_target(at.a, at.s, -move, 1.0);
        add_target(at.b, at.t, move, 1.0);
    }
    return violations;
}

// Adds targets for places in a body: out along the normal at the closest point. Near the root half of the depth allowed there
// is the target. Returns the number of violations.
int Repair::push_out_of_bodies() {
    int violations = 0;
    const auto goal = [&](double along) {
        return allowed_depth(allowed_, along) > 0.0 ? -0.5 * allowed_depth(allowed_, along)
                                                    : std::min(body_clearance, 0.5 * along);
    };
    const auto floor = [&](double along) { return (goal(along) < 0.0 ? 1.5 : 0.5) * goal(along); };
    for (size_t body = 0; body < bodies_.size(); ++body)
#pragma omp parallel for schedule(dynamic, 16) reduction(+ : violations)
        for (int i = 0; i < curves().count(); ++i)
            find_below(curves()[i], *bodies_[body], *grids_[body], 0.5 * body_clearance, floor,
                       [&](size_t k, double at, double along, const Vec3 &place, const SignedDistance &above) {
                           violations += above.distance < -allowed_depth(allowed_, along) - rounding;
                           const Vec3 move = above.closest + goal(along) * above.normal - place;
                           add_target(offsets_[i] + static_cast<int>(k), at, move, body_weight);
                       });
    return violations;
}

// Distributes the target move of a place on a segment to the ends of the segment.
void Repair::add_target(int point, double at, const Vec3 &move, double weight) {
    const double squares = at * at + (1.0 - at) * (1.0 - at);
    for (const auto &[end, share] : {std::pair(point, 1.0 - at), std::pair(point + 1, at)}) {
        target_[end] += weight * share * share / squares * move;
        weight_[end] += weight * share;
    }
}

void Repair::solve_moves() {
#pragma omp parallel
    {
        SmoothestMoves smoothest_moves;
#pragma omp for schedule(dynamic, 16)
        for (int i = 0; i < curves().count(); ++i) {
            const size_t first = offsets_[i], count = offsets_[i + 1] - first;
            const std::span<const double> weight = std::span(weight_).subspan(first, count);
            if (std::none_of(weight.begin(), weight.end(), [](double w) { return w > 0.0; })) continue;
            const std::span<Vec3> points = std::span(points_).subspan(first, count);
            double length = 0.0;
            for (size_t k = 1; k < count; ++k) length += (points[k] - points[k - 1]).norm();
            const double spacing = std::max(length / static_cast<double>(count - 1), 1e-9);
            smoothest_moves(std::span(target_).subspan(first, count), weight, std::pow(smoothing_length / spacing, 4), points);
        }
    }
}

} // namespace ringlet
