#include "ringlet/groom/push_out.h"

#include "ringlet/groom/keep_form.h"

#include <algorithm>
#include <cmath>
#include <memory>

namespace ringlet {
namespace {

constexpr double decay_to_root = 6e-3; // [m] decay length of a move towards the root
constexpr double decay_to_tip = 0.1;   // [m] decay length of a move towards the tip
constexpr double largest_stretch_pushed_out = 2.0;

// Outward direction of a push: smooth from triangle to triangle, but never against the side that the sign of the distance
// names.
const Vec3 &outward(const SignedDistance &above) {
    return above.smooth_normal.dot(above.normal) > 0.0 ? above.smooth_normal : above.normal;
}

// A piece of a curve with at most its length. One that heads straight into a body has lost most of that; it gets at most twice
// what is left, and the rest of its length along the surface.
class LengthLimit {
public:
    // `normal`: of the surface out of which the piece was pushed, or null
    Vec3 operator()(const Vec3 &piece, double length, const Vec3 &heading, const Vec3 *normal) {
        Vec3 longest = std::min(2.0, length / std::max(piece.norm(), 1e-12)) * piece;
        const double missing = length * length - longest.squaredNorm();
        if (!normal || missing <= 1e-9 * length * length) {
            slide_.setZero();
            return longest;
        }
        slide_ = orthogonal(sliding() ? slide_ : heading.stableNormalized(), *normal);
        const double along = longest.dot(slide_);
        return longest + (std::sqrt(along * along + missing) - along) * slide_;
    }

    bool sliding() const { return !slide_.isZero(0.0); }

private:
    Vec3 slide_ = Vec3::Zero(); // unit direction along the surface: that of the heading where the curve reaches it
};

// Bodies with the grids of their surroundings.
class Bodies {
public:
    Bodies(View<const Solid *> bodies, double reach) : bodies_(bodies) {
        grids_.reserve(bodies.size());
        for (const Solid *body : bodies) grids_.push_back(body->cells_within(reach));
    }

    // One probe for each body, for a curve from a root.
    std::vector<SurfaceProbe> probes(const Vec3 &root) const {
        std::vector<SurfaceProbe> result;
        result.reserve(grids_.size());
        for (size_t k = 0; k < grids_.size(); ++k) result.emplace_back(*bodies_[k], *grids_[k], root);
        return result;
    }

private:
    View<const Solid *> bodies_;
    std::vector<std::shared_ptr<const ProximityGrid>> grids_;
};

// Whether the signed distance of a place to the union of bodies is below `most` [m]; then `above` is that to the body in which
// the place is deepest.
bool below_any(std::span<SurfaceProbe> probes, const Vec3 &place, double most, SignedDistance &above) {
    above = {};
    for (SurfaceProbe &probe : probes)
        if (SignedDistance one; probe.below(place, most, one) && one.distance < above.distance) above = one;
    return above.distance < most;
}

// Computes the moves of the points of one curve. Returns whether any place is too near a body. `lengths`, if not empty, are
// target lengths of edges; edge k ends in point k.
bool find_moves(std::span<const Vec3> points, std::span<const double> lengths, const Bodies &bodies, double margin,
                const Allowed &allowed, std::span<Vec3> moves) {
    bool near = false;
    std::vector<SurfaceProbe> probes = bodies.probes(points[0]);
    LengthLimit limited;
    Vec3 move = Vec3::Zero(), before = points[0];
    double along = 0.0;
    moves[0].setZero();
    for (size_t k = 1; k < points.size(); ++k) {
        const Vec3 edge = points[k] - points[k - 1];
        const double length = edge.norm();
        const int steps = std::max(1, static_cast<int>(std::ceil(length / largest_spacing)));
        const double step = length / steps, wanted_step = lengths.empty() ? 0.0 : lengths[k] / steps;
        for (int i = 1; i <= steps; ++i) {
            along += step;
            if (!limited.sliding() && !move.isZero(0.0)) move *= std::exp(-step / decay_to_tip);
            const Vec3 unmoved = points[k - 1] + (static_cast<double>(i) / steps) * edge;
            Vec3 place = unmoved + move;
            const double wanted = along <= allowed.root_length ? -allowed.root_depth : std::min(margin, 0.5 * along);
            SignedDistance above;
            const bool pushed = below_any(probes, place, margin, above) && above.distance < wanted;
            if (pushed) {
                place += (wanted - above.distance) * outward(above); // only the missing distance, so that the move starts at 0
                near = true;
            }
            if (!lengths.empty())
                place = before + limited(place - before, wanted_step, edge, pushed ? &outward(above) : nullptr);
            move = place - unmoved;
            before = place;
        }
        moves[k] = move;
    }
    return near;
}

// Extends moves towards the root, with decay, and smooths them.
void smooth_moves(std::span<const Vec3> points, std::span<Vec3> moves, std::vector<Vec3> &scratch) {
    for (size_t k = points.size() - 1; k-- > 1;) {
        const Vec3 before = std::exp(-(points[k + 1] - points[k]).norm() / decay_to_root) * moves[k + 1];
        const double length = before.norm(), more = length - moves[k].norm();
        if (more > 0.0) moves[k] += more / length * before;
    }
    for (int pass = 0; pass < 3; ++pass) {
        scratch.assign(moves.begin(), moves.end());
        for (size_t k = 1; k + 1 < moves.size(); ++k) moves[k] = 0.25 * (scratch[k - 1] + scratch[k + 1]) + 0.5 * scratch[k];
    }
}

} // namespace

std::vector<Vec3> push_out(const CurveView &curves, View<const Solid *> solids, double margin, const Allowed &allowed) {
    constexpr int rounds = 4;
    const Bodies bodies(solids, std::max(margin, least_probe_distance));
    std::vector<Vec3> result(curves.points.begin(), curves.points.end());
#pragma omp parallel
    {
        std::vector<Vec3> moves, scratch;
        std::vector<double> lengths;
#pragma omp for schedule(dynamic, 16)
        for (int i = 0; i < curves.count(); ++i) {
            const std::span<Vec3> points = std::span(result).subspan(curves.offsets[i], curves[i].size());
            moves.resize(points.size());
            lengths.assign(points.size(), 0.0);
            for (size_t k = 1; k < points.size(); ++k) lengths[k] = (points[k] - points[k - 1]).norm();
            // Either no round or all of them, so that the result is continuous in the input.
            if (!find_moves(points, {}, bodies, margin, allowed, moves)) continue;
            for (int round = 1; round <= rounds; ++round) {
                const bool last = round == rounds; // the last round only clears what little is left
                find_moves(points, last ? std::span<double>() : lengths, bodies, margin, allowed, moves);
                if (!last) smooth_moves(points, moves, scratch);
                for (size_t k = 1; k < points.size(); ++k) points[k] += moves[k];
            }
            keep_form(curves[i], largest_stretch_pushed_out, points);
        }
    }
    return result;
}

} // namespace ringlet
