// Strands gathered from the arrays into SIMD lanes, one strand per lane, and scattered back.
// Strands of a group have different lengths. Behind the tip of a shorter one follow vertices that nothing acts on.
#pragma once

#include "ringlet/math/pack.h"
#include "ringlet/strand/kernel.h"

namespace ringlet::RINGLET_SIMD {

// The strand in one lane.
struct StrandLane {
    int index;           // of the lane
    int strand;          // in the arrays
    int first, vertices; // its first row in the arrays, and how many it has

    int row(int i) const { return first + i; }
    bool has_vertex(int i) const { return i < vertices; }
    bool has_edge(int i) const { return i + 1 < vertices; } // from vertex i to i + 1
    bool has_corner(int i) const { return i > 0 && i + 1 < vertices; }
    bool has_hinge(int i) const { return i > 0 && i + 2 < vertices; }
};

class LaneGather {
public:
    // Lanes behind the last strand of the group repeat the first; they are never scattered.
    LaneGather(const int *offsets, StrandGroup group) : strands_(group.count) {
        for (int k = 0; k < lanes; ++k) {
            const int strand = group.strands[k < group.count ? k : 0];
            lane_[k] = {k, strand, offsets[strand], offsets[strand + 1] - offsets[strand]};
            vertices_ = lane_[k].vertices > vertices_ ? lane_[k].vertices : vertices_;
        }
    }

    int strands() const { return strands_; }
    int vertices() const { return vertices_; } // of the longest strand
    const StrandLane &lane(int index) const { return lane_[index]; }

    // Row i of an array of one number per vertex, or `behind_tip`.
    Pack scalar(const double *values, int i, double behind_tip) const {
        Pack result{};
        for (const StrandLane &strand : lane_)
            set_lane(result, strand.index, strand.has_vertex(i) ? values[strand.row(i)] : behind_tip);
        return result;
    }

    // Row i of an array of one vector per vertex; that of the tip behind it.
    Vec<Pack> vector(const double *values, int i) const {
        Vec<Pack> result{};
        for (const StrandLane &strand : lane_) {
            const double *row = values + 3 * strand.row(strand.has_vertex(i) ? i : strand.vertices - 1);
            for (int k = 0; k < 3; ++k) set_lane(result[k], strand.index, row[k]);
        }
        return result;
    }

    // The same of positions. Behind the tip they lie on a straight line, one metre apart, so that no edge is degenerate.
    Vec<Pack> position(const double *values, int i) const {
        Vec<Pack> result = vector(values, i);
        for (const StrandLane &strand : lane_) {
            const double behind = strand.has_vertex(i) ? 0.0 : i - strand.vertices + 1;
            set_lane(result.x, strand.index, result.x[strand.index] + behind);
        }
        return result;
    }

    // Writes what one lane has at vertex i.
    static void scatter(Vec<Pack> value, const StrandLane &strand, int i, double *values) {
        for (int k = 0; k < 3; ++k) values[3 * strand.row(i) + k] = value[k][strand.index];
    }

    // Writes one number per lane, zero in lanes without a strand.
    void scatter(Pack value, double *values) const {
        for (int k = 0; k < lanes; ++k) values[k] = k < strands_ ? value[k] : 0.0;
    }

private:
    int strands_, vertices_ = 3;
    StrandLane lane_[lanes];
};

} // namespace ringlet::RINGLET_SIMD
