// The configuration of a scene: where all vertices are, with the candidate pairs that move along with them.
#pragma once

#include "ringlet/collision/near_pairs.h"
#include "ringlet/collision/vertex_lists.h"
#include "ringlet/solver/report.h"
#include "ringlet/solver/vertex_table.h"

#include <vector>

namespace ringlet {

// How vertices hang together, for corrections that spread from one to the next.
struct Connectivity {
    View<int> strands;      // where each strand begins among the vertices, and the end
    View<int> cloths;       // likewise; objects of cloths follow those of strands
    VertexLists neighbours; // of the vertices of cloths
};

// A move of all dynamic vertices while prescribed ones stay.
struct Move {
    std::vector<Vec3> to;   // where it ends
    std::vector<Vec3> apex; // the path is in the triangle of the start, this and the end; empty: it is straight
};

class Configuration {
public:
    Configuration(const VertexTable &table, Connectivity connectivity, std::vector<Vec3> positions, double strand_radius);

    std::vector<Vec3> positions;
    NearPairs pairs;
    const Connectivity connectivity;

    // Shortens a move so that no pair comes closer than it may. Strands keep their shape and take a fraction of the whole move
    // (`whole`), or may be limited near the pair alone where else they could hardly move. `lasts`: candidates serve later
    // moves.
    struct LimitSettings {
        bool whole = true, lasts = true;
        bool few = false; // vertices move: candidates need not be bounded for later moves
    };
    void limit(Move &move, const LimitSettings &settings, SceneReport &report);
    // The same where some vertices of the last limited move end elsewhere.
    void limit_again(Move &move, bool whole, View<unsigned char> changed, SceneReport &report);

    // Takes the last limited move, or any fraction of it.
    void commit(const std::vector<Vec3> &to);
    void commit_rigid(const std::vector<Vec3> &to); // all of an advection

    // Keeps the positions after each move of a step; no pair meets while vertices go straight from one to the next.
    void record(bool on) { recording_ = on; }
    void begin_record();
    void add_to_record();
    const std::vector<std::vector<Vec3>> &recorded() const { return recorded_; }

private:
    void limit(Move &move, bool whole, View<unsigned char> changed, SceneReport &report);

    const VertexTable &table_;
    double strand_radius_;
    bool recording_ = false;
    std::vector<std::vector<Vec3>> recorded_;
};

} // namespace ringlet
