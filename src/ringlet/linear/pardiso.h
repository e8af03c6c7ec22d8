// The factorisation PARDISO of Intel's MKL: supernodal and parallel, many times faster than the built-in one as soon as strands
// touch. Ringlet is neither built nor shipped with it: the library is opened when it is first asked for.
#pragma once

#include "ringlet/linear/factorisation.h"

#include <memory>
#include <string>

namespace ringlet {

// Opens libmkl_rt at this path, or by its name where the path is empty. Says whether PARDISO can be used now; once it can,
// later calls change nothing.
bool open_pardiso(const std::string &path = {});
bool pardiso_available(); // open_pardiso() of the name alone

// Of a pattern that keeps its upper triangle, where pardiso_available().
std::unique_ptr<Factorisation> make_pardiso(const SparsePattern &pattern);

} // namespace ringlet
