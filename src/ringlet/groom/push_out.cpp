#include "ringlet/groom/push_out.h"

#include <algorithm>
#include <cmath>

namespace ringlet {
namespace {

constexpr double coming = 6e-3; // [m] length over which a move begins before it is needed
constexpr double going = 0.1;   // [m] length over which it dies away after

// Finds the moves of the points of one curve that keep it out; returns whether any moves. From the first that does, its edges
// are drawn to the lengths that are given, if they are: edge k ends in point k.
bool follow(std::span<const Vec3> points, std::span<const double> lengths, const Solid &body, const NearCells &cells,
            double margin, const Allowed &allowed, std::span<Vec3> moves) {
    bool any = false;
    Sounding sounding(body, cells);
    Vec3 move = Vec3::Zero(), before = points[0];
    double along = 0.0;
    moves[0].setZero();
    for (size_t k = 1; k < points.size(); ++k) {
        const Vec3 edge = points[k] - points[k - 1];
        const double length = edge.norm();
        const int steps = std::max(1, static_cast<int>(std::ceil(length / stride)));
        const double step = length / steps, fade = 1.0 - std::min(1.0, step / going);
        for (int i = 1; i <= steps; ++i) {
            along += step;
            move *= fade;
            const Vec3 unmoved = points[k - 1] + (static_cast<double>(i) / steps) * edge;
            Vec3 place = unmoved + move;
            const double wanted = along <= allowed.root_length ? -allowed.root_depth : std::min(margin, 0.5 * along);
            Above above;
            if (sounding.below(place, margin, above) && above.height < wanted) {
                place = above.foot + wanted * above.smooth;
                any = true;
            }
            if (any && !lengths.empty()) { // where the way goes straight in, little of it is left: it is not drawn out at once
                const Vec3 way = place - before;
                place = before + std::min(2.0, lengths[k] / steps / std::max(way.norm(), 1e-12)) * way;
            }
            if (any) move = place - unmoved;
            before = place;
        }
        moves[k] = move;
    }
    return any;
}

// Lets moves begin before they are needed, and smooths where they end.
void ease(std::span<const Vec3> points, std::span<Vec3> moves, std::vector<Vec3> &scratch) {
    for (size_t k = points.size() - 1; k-- > 1;) {
        const double fade = std::exp(-(points[k + 1] - points[k]).norm() / coming);
        if (const Vec3 before = fade * moves[k + 1]; before.squaredNorm() > moves[k].squaredNorm()) moves[k] = before;
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
            for (int round = 1; round <= rounds; ++round) {
                const bool last = round == rounds; // what is left by then is little; it is only cleared
                if (!follow(points, last ? std::span<double>() : lengths, body, cells, margin, allowed, moves)) break;
                if (!last) ease(points, moves, scratch);
                for (size_t k = 1; k < points.size(); ++k) points[k] += moves[k];
            }
        }
    }
    return result;
}

} // namespace ringlet
