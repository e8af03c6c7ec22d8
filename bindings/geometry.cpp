#include "arrays.h"

namespace nb = nanobind;

void bind_geometry(nb::module_ &module) { (void)module; }
