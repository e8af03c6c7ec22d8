#include "arrays.h"

namespace nb = nanobind;

void bind_scene(nb::module_ &module) { (void)module; }
