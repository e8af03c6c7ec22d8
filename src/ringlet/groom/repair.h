// Repair of a groom: moves curves out of bodies and out of one another with the least change of form.
#pragma once

#include "ringlet/geometry/frames.h"
#include "ringlet/groom/places.h"

#include <array>
#include <memory>
#include <vector>

namespace ringlet {

// Place on a curve inside a body; its depth counts from the depth that is allowed [m].
struct Penetration {
    int body, point, triangle;
    Vec3 place;
    double depth;
};

// Two segments nearer than the sum of their radii.
struct Overlap {
    int a, b;        // their first points
    double s, t;     // fractions of the closest points along them
    Vec3 separation; // vector from the closest point on a to that on b [m]
    double distance; // its length [m]
};

std::vector<Penetration> find_penetrations(const CurveView &curves, const std::vector<const Solid *> &bodies,
                                           const Allowed &allowed);
// Overlaps of curves that have a radius at each point [m].
std::vector<Overlap> find_overlaps(const CurveView &curves, View<double> radius);

// Iterative repair. It begins with curves that are pushed out of the bodies (push_out.h). Each round finds all violations and
// gives each a target move: to the closest point of the surface, or by half of the missing distance away from another curve.
// The move δ of a curve minimises Σ w |δ − target|² + λ (s⁴ |δ″|² + |δ|²), with s the smoothing length and δ = 0 at the root.
class Repair {
public:
    Repair(const CurveView &curves, std::vector<const Solid *> bodies, const Allowed &allowed);

    // Returns the number of violations, and moves the curves if there are any.
    int round();

    // The points with the fewest violations so far. A curve that this stretches, or shortens, by a quarter keeps its form.
    std::vector<Vec3> points() const;

private:
    CurveView curves() const { return {points_, offsets_}; }
    int push_apart();
    int push_out_of_bodies();
    void add_target(int point, double at, const Vec3 &move, double weight);
    void solve_moves();

    std::vector<int> offsets_;
    std::vector<const Solid *> bodies_;
    std::vector<std::shared_ptr<const ProximityGrid>> grids_; // of each body
    Allowed allowed_;
    std::vector<Vec3> before_, points_, best_;
    size_t fewest_;
    std::vector<Vec3> target_;
    std::vector<double> weight_;
    std::vector<std::array<int, 2>> pairs_; // candidate pairs, valid until a point has moved by `skin` from `searched_`
    std::vector<Vec3> searched_;
};

} // namespace ringlet
