#include "ringlet/groom/push_out.h"

#include <algorithm>
#include <cmath>

namespace ringlet {
namespace {

constexpr double coming = 6e-3; // [m] length over which a move begins before it is needed
constexpr double going = 0.1;   // [m] length over which it dies away after

// Finds the moves of the points of one curve that keep it out; returns whether it came too near anywhere. Edges are drawn to
// the lengths that are given, if they are: edge k ends in point k.
bool follow(std::span<const Vec3> points, std::span<const double> lengths, const Solid &body, const NearCells &cells,
            double margin, const Allowed &allowed, std::span<Vec3> moves) {
    bool near = false;
    Sounding sounding(body, cells);
    Vec3 move = Vec3::Zero(), before = points[0];
    double along = 0.0;
    moves[0].setZero();
    for (size_t k = 1; k < points.size(); ++k) {
        const Vec3 edge = points[k] - points[k - 1];
        const double length = edge.norm();
        const int steps = std::max(1, static_cast<int>(std::ceil(length / stride)));
        const double step = length / steps, wanted_step = lengths.empty() ? 0.0 : lengths[k] / steps;
        for (int i = 1; i <= steps; ++i) {
            along += step;
            if (!move.isZero(0.0)) move *= std::exp(-step / going);
            const Vec3 unmoved = points[k - 1] + (static_cast<double>(i) / steps) * edge;
            Vec3 place = unmoved + move;
            const double wanted = along <= allowed.root_length ? -allowed.root_depth : std::min(margin, 0.5 * along);
            Above above;
            if (sounding.below(place, margin, above) && above.height < wanted) {
                place += (wanted - above.height) * above.smooth; // only what is missing: it begins with nothing
                near = true;
            }
            if (!lengths.empty()) { // where the way goes straight in, little of it is left: it is not drawn out at once
                const Vec3 way = place - before;
                place = before + std::min(2.0, wanted_step / std::max(way.norm(), 1e-12)) * way;
            }
            move = place - unmoved;
            before = place;
        }
        moves[k] = move;
    }
    return near;
}

// Lets moves begin before they are needed, and smooths where they end.
void ease(std::span<const Vec3> points, std::span<Vec3> moves, std::vector<Vec3> &scratch) {
    for (size_t k = points.size() - 1; k-- > 1;) {
        const Vec3 before = std::exp(-(points[k + 1] - points[k]).norm() / coming) * moves[k + 1];
        const double length = before.norm(), more = length - moves[k].norm();
        if (more > 0.0) moves[k] += more / length * before;
    }
    for (int pass = 0; pass < 3; ++pass) {
        scratch.assign(moves.begin(), moves.end());
        for (size_t k = 1; k + 1 < moves.size(); ++k) moves[k] = 0.25 * (scratch[k - 1] + scratch[k + 1]) + 0.5 * scratch[k];
    }
}

} // namespace

std::vector<Vec3> push_out(const CurveView &curves, const Solid &body, double margin, const Allowed &allowed) {
    constexpr int rounds = 4;
    const NearCells cells(body.mesh(), std::max(margin, band));
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
            // All rounds or none: what changes by a little should not change how many there are.
            if (!follow(points, {}, body, cells, margin, allowed, moves)) continue;
            for (int round = 1; round <= rounds; ++round) {
                const bool last = round == rounds; // what is left by then is little; it is only cleared
                follow(points, last ? std::span<double>() : lengths, body, cells, margin, allowed, moves);
                if (!last) ease(points, moves, scratch);
                for (size_t k = 1; k < points.size(); ++k) points[k] += moves[k];
            }
        }
    }
    return result;
}

} // namespace ringlet
