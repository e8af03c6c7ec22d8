// What happened in a step of a scene.
#pragma once

#include "ringlet/math/row.h"

#include <chrono>

namespace ringlet {

RINGLET_ROW(SceneReport, newton, cuts, residual, unconverged,
            stalled, // objects that are not at rest in the step, and yet have not moved
            linear_iterations, linear_residual, candidates, contacts, // candidate pairs, and contacts
            closest,                                                  // smallest gap of a contact at the end [m]
            violations, zone_vertices, // pairs that would have met, vertices whose motion was limited for them
            moved, left, // Σ m · m and Σ m · l of the vertices' motions m and what is left of the last search direction, l [m²]
            lag,         // largest distance of a prescribed vertex from where it was to be [m]
            time_pairs, time_assemble, time_solve, time_search, time_filter); // [s]

class Stopwatch {
public:
    explicit Stopwatch(double &sum) : sum_(sum), start_(std::chrono::steady_clock::now()) {}
    ~Stopwatch() { sum_ += std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count(); }

private:
    double &sum_;
    std::chrono::steady_clock::time_point start_;
};

} // namespace ringlet
