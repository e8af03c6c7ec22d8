// Factorisation by PARDISO of Intel's MKL: supernodal and parallel, many times faster than the built-in one for strands in
// contact. Ringlet is neither built nor shipped with it; the library is opened at run time, when it is first requested.
#pragma once

#include "ringlet/linear/direct.h"

#include <string>

namespace ringlet {

// Opens libmkl_rt at this path, or by its name if the path is empty. Returns whether PARDISO can be used; once it can, later
// calls have no effect.
bool open_pardiso(const std::string &path = {});
bool pardiso_available(); // open_pardiso() by name

// Requires pardiso_available().
std::unique_ptr<Factorisation> make_pardiso(const SparsePattern &pattern);

} // namespace ringlet
