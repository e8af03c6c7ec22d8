// The path that a Newton iteration searches along.
#pragma once

#include "ringlet/solver/block_set.h"

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

} // namespace ringlet
