// The module ringlet._core. Each folder of the core binds itself in a file of its own.
#include "arrays.h"

#include "ringlet/math/simd.h"

#include <nanobind/stl/string.h>
#include <omp.h>

#include <algorithm>
#include <cstdlib>

namespace nb = nanobind;

// More threads than that are a mistake in the environment, and their stacks do not fit in memory.
constexpr int max_threads = 1024;

void bind_cloth(nb::module_ &module);
void bind_geometry(nb::module_ &module);
void bind_groom(nb::module_ &module);
void bind_linear(nb::module_ &module);
void bind_rest(nb::module_ &module);
void bind_scene(nb::module_ &module);
void bind_strand(nb::module_ &module);

NB_MODULE(_core, module) {
    // A program that ends in the midst of work in another thread leaks what that thread holds, which is no mistake.
    nb::set_leak_warnings(std::getenv("RINGLET_DEBUG") != nullptr);
    omp_set_num_threads(std::min(omp_get_max_threads(), max_threads));
    module.doc() = "Ringlet's core: arrays in, arrays out. SI units.";
    module.def(
        "simd", [] { return std::string(ringlet::simd_name(ringlet::simd())); },
        "The instruction set in use: baseline, avx2 or avx512.");
    module.def("thread_count", [] { return omp_get_max_threads(); }, "Threads that the core uses.");
    module.def("set_thread_count", [](int count) { omp_set_num_threads(std::clamp(count, 1, max_threads)); }, nb::arg("count"));
    bind_geometry(module);
    bind_groom(module);
    bind_linear(module);
    bind_rest(module);
    bind_strand(module);
    bind_cloth(module);
    bind_scene(module);
}
