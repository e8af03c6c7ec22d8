// The module ringlet._core. Each folder of the core binds itself in a file of its own.
#include "arrays.h"

#include "ringlet/math/parallel.h"
#include "ringlet/math/simd.h"

#include <nanobind/stl/string.h>
#include <omp.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>

namespace nb = nanobind;

// More threads than that are a mistake in the environment, and their stacks do not fit in memory.
constexpr int max_threads = 1024;

namespace {

// What it has recorded so far: (loops, chunks); a loop is (file, function, line, serial, inside, dynamic, end).
nb::tuple recorded(const ringlet::LoopRecorder &recorder) {
    nb::list loops;
    for (const ringlet::RecordedLoop &loop : recorder.loops())
        loops.append(nb::make_tuple(loop.site.file, loop.site.function, loop.site.line, loop.serial, loop.inside, loop.dynamic,
                                    loop.end));
    std::vector<float> chunks = recorder.chunks();
    const size_t count = chunks.size();
    return nb::make_tuple(loops, ringlet::bindings::to_numpy<float>(std::move(chunks), {count}));
}

// How long a parallel loop of nothing takes [s]: nine tenths take longer, since other processes keep threads waiting.
double empty_loop_time(int turns) {
    using Clock = std::chrono::steady_clock;
    std::vector<double> times(std::max(turns, 1));
    for (double &time : times) {
        const Clock::time_point begin = Clock::now();
        ringlet::parallel_for(omp_get_max_threads(), [](int) {});
        time = std::chrono::duration<double>(Clock::now() - begin).count();
    }
    std::nth_element(times.begin(), times.begin() + times.size() / 10, times.end());
    return times[times.size() / 10];
}

} // namespace

void bind_cloth(nb::module_ &module);
void bind_geometry(nb::module_ &module);
void bind_groom(nb::module_ &module);
void bind_linear(nb::module_ &module);
void bind_live(nb::module_ &module);
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
    nb::class_<ringlet::LoopRecorder>(module, "LoopRecorder",
                                      "Records the parallel loops of scenes' steps in this thread, until it is deleted.")
        .def(nb::init<>())
        .def("recorded", &recorded,
             "(loops, chunks): each loop with its file, function and line, processor time before it and in it [s], whether "
             "its chunks go to free threads, and the end of its chunks; how long each chunk took [s].");
    module.def("empty_loop_time", &empty_loop_time, nb::arg("turns"), "What a parallel loop costs [s], by as many.");
    bind_geometry(module);
    bind_groom(module);
    bind_linear(module);
    bind_rest(module);
    bind_strand(module);
    bind_live(module);
    bind_cloth(module);
    bind_scene(module);
}
