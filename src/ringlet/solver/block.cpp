#include "ringlet/solver/block.h"

#include <algorithm>
#include <limits>
#include <stdexcept>

namespace ringlet {

void Block::multiply_add(const double *, double *) const {
    throw std::logic_error("block: multiplies only where its factor is incomplete");
}

void Block::max_step(const double *, const double *, double *of_lanes) const { std::fill_n(of_lanes, objects_.size(), 1.0); }

void Block::bend(const double *, const double *, double *bend) const { std::fill_n(bend, unknowns(), 0.0); }

bool Block::is_stretched(int, View<Vec3>) const { return false; }

double Block::settled_distance(int) const { return std::numeric_limits<double>::infinity(); }

} // namespace ringlet
