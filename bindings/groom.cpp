#include "arrays.h"

namespace nb = nanobind;

void bind_groom(nb::module_ &module) { (void)module; }
