// Built-in factorisation, Eigen's simplicial L D Lᵀ. The minimum-degree ordering is that of the graph of blocks, which is nine
// or sixteen times smaller than the graph of scalars and gives no more fill-in.
#pragma once

#include "ringlet/linear/factorisation.h"

#include <memory>

namespace ringlet {

std::unique_ptr<Factorisation> make_simplicial(const SparsePattern &pattern);

} // namespace ringlet
