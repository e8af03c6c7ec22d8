// The built-in factorisation, L D Lᵀ of Eigen. Its ordering, of minimum degree, is that of the graph of blocks: some nine or
// sixteen times smaller than the graph of unknowns, and no worse.
#pragma once

#include "ringlet/linear/factorisation.h"

#include <memory>

namespace ringlet {

std::unique_ptr<Factorisation> make_simplicial(const SparsePattern &pattern);

} // namespace ringlet
