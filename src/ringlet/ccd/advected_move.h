// A move on which kinematic vertices move, corrected round by round until it has no impacts: by impact zones, by truncation.
#pragma once

#include "ringlet/ccd/impact.h"

#include <functional>
#include <utility>
#include <vector>

namespace ringlet {

// Borrows all that it is made of; `end` is what corrections change. No pair has an impact when impacts() is empty, while every
// vertex moves straight from `start` to `end`.
class AdvectedMove {
public:
    AdvectedMove(MoveCandidates &pairs, View<Vec3> start, std::vector<Vec3> &end);

    const Candidates &candidates;
    const CollisionMesh &mesh;
    const View<Vec3> start; // [m]
    std::vector<Vec3> &end; // [m]

    const std::vector<Impact> &impacts() const { return impacts_; }

    // One round: correct(impacts) changes ends, and finds the impacts that are left.
    template <class Correct> void round(const Correct &correct) {
        correct(std::as_const(impacts_));
        find_impacts();
    }

    CcdReport report() const;

private:
    void find_impacts();

    MoveCandidates &pairs_;
    std::vector<unsigned char> corrected_; // per vertex
    std::vector<Impact> impacts_;
    CcdReport report_;
};

struct ImpactZonesInput {
    View<double> mass; // per vertex [kg]
    // Where a point ends that is advected with a kinematic vertex.
    std::function<Vec3(int vertex, const Vec3 &point)> advect;
};

// Impact zones (Provot 1997; Harmon et al. 2008): vertices of impacts share one motion where kinematic bodies leave no choice.
// Corrects a move by zones for some rounds; impacts may be left. A zone moves as the body that it touches, or by its mean
// motion. Zones grow while there are impacts at their border. Only relative motion counts.
void resolve_impact_zones(const ImpactZonesInput &input, AdvectedMove &move);

// Local truncation: vertices that cannot complete a move lag behind; all others complete it. The move has no impacts then. A
// vertex with an impact makes a fraction of its move, none of it where the pair begins close: a pinch does not tighten.
// Prescribed vertices too, so that a body is dented where it pinches something. Along curves and over surfaces that spreads so
// far that no edge is strained by much; objects that are `uniform` keep one fraction of their move. Vertices that make none of
// it have no impacts, so this ends.
void truncate_locally(AdvectedMove &move, View<unsigned char> uniform = {});

} // namespace ringlet
