// Moves curves out of bodies and apart from one another, with the least change of their form.
#pragma once

#include "ringlet/geometry/frames.h"
#include "ringlet/groom/places.h"

#include <array>
#include <vector>

namespace ringlet {

// A place on a curve that is in a body, and how deep beyond what is allowed [m].
struct Sunk {
    int body, point, triangle;
    Vec3 place;
    double depth;
};

// Two segments, named by their first points, that are nearer than a thickness; where on them, 0…1, and from one to the other.
struct Crossing {
    int a, b;
    double s, t;
    Vec3 apart;
    double distance;
};

std::vector<Sunk> find_sunk(const CurveView &curves, const std::vector<const Solid *> &bodies, const Allowed &allowed);
std::vector<Crossing> find_crossings(const CurveView &curves, double thickness);

// Goes round by round. First every curve is led around the bodies (push_out.h). Then, in each round, every place that is wrong
// is told where to go, out of a body by the nearest way, or half of what is missing apart from another curve; between such
// places the move δ of a curve, whose root stays, is the least of Σ w |δ − wanted|² + ease (spread⁴ |δ″|² + |δ|²).
class Repair {
public:
    Repair(const CurveView &curves, std::vector<const Solid *> bodies, const Allowed &allowed);

    // How many places are wrong; if any are, moves what is.
    int round();
    // The points of the round that left the fewest.
    View<Vec3> points() const { return best_; }

private:
    CurveView curves() const { return {points_, offsets_}; }
    int push_apart();
    int push_out_of_bodies();
    void want(int point, double at, const Vec3 &way, double firm);
    void spread();

    std::vector<int> offsets_;
    std::vector<const Solid *> bodies_;
    std::vector<NearCells> cells_; // of each
    Allowed allowed_;
    std::vector<Vec3> points_, best_;
    size_t least_;
    std::vector<Vec3> wanted_;
    std::vector<double> weight_;
    std::vector<std::array<int, 2>> pairs_; // that may come near until a point has moved far from `seen_`
    std::vector<Vec3> seen_;
};

} // namespace ringlet
