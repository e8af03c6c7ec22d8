// The path that a Newton iteration searches along, and its limit where it would lead through a contact.
#pragma once

#include "ringlet/solver/configuration.h"
#include "ringlet/solver/objective.h"

namespace ringlet {

// At t, each object is at x + t · straight + t² · bend: within the triangle of x, x + straight and x + straight + bend.
struct SearchPath {
    AlignedVector straight; // the search direction
    AlignedVector bend;     // what makes edges turn instead of stretch at its end

    explicit SearchPath(size_t size = 0) : straight(size), bend(size) {}
};

// Sets the largest coordinate of each active object's direction [m]. The direction of the others becomes 0, and one that is not
// finite, since its system is too ill-conditioned to solve.
void measure_direction(const BlockSet &blocks, AlignedVector &direction, std::vector<double> &largest);

// Slopes of the objects' energies along a direction [J].
std::vector<double> slopes(const BlockSet &blocks, const AlignedVector &direction);

// Per object, the largest fraction of its direction that the linearisation at x is good for.
std::vector<double> max_step(const BlockSet &blocks, const AlignedVector &x, const AlignedVector &direction);

// Gives marked objects the least fraction of their cluster; clusters are named by their first objects.
void share_least(const std::vector<int> &cluster, const std::vector<unsigned char> &objects, std::vector<double> &t);

// Shortens the path of each object to the fraction t of it.
void shorten(const BlockSet &blocks, const std::vector<double> &t, SearchPath &path);

// Bends a straight path from x.
void bend(const BlockSet &blocks, const AlignedVector &x, SearchPath &path);

// Takes the bend out of the paths of marked objects.
void straighten(const BlockSet &blocks, const std::vector<unsigned char> &objects, SearchPath &path);

// Moves the blocks with objects that have `changed` to x(t), t being the objects' own.
void move_along(const BlockSet &blocks, const AlignedVector &x, const std::vector<double> &t, const SearchPath &path,
                const std::vector<unsigned char> &changed, AlignedVector &to);

// How far each object wanted to go in a move, and the least fraction of that which it went.
struct ObjectMoves {
    std::vector<double> length, fraction; // [m]; 0 and 1 of those that are not active

    // A move from `now` to `wanted` was limited to `to`.
    ObjectMoves(const BlockSet &blocks, View<Vec3> now, View<Vec3> wanted, View<Vec3> to);

    void shorten(const std::vector<double> &t); // to those fractions
    bool are_full() const;
};

struct PathLimits {
    Candidates::Serve serve;
    Yield yield;                               // of what has an impact on the shortened path, too
    const std::vector<unsigned char> &uniform; // per object: its cluster takes one fraction of the path
};

struct LimitedPath {
    PlannedMove move; // that the path leads to
    ObjectMoves moves;
};

// Shortens the path from x, which are the positions, until no pair comes closer than it may.
// Strands first take the bent path. What meets something early on it goes straight instead, and half as far: the linear system
// knows the contacts in that direction, while the bend leads the rest of a strand anywhere. What meets something later goes
// that fraction. Both are limited once more.
LimitedPath limit_path(const Objective &objective, Configuration &configuration, const AlignedVector &x,
                       const PathLimits &limits, SearchPath &path, SceneReport &report);

} // namespace ringlet
