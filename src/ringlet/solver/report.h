// What happened in a step of a scene.
#pragma once

#include <chrono>

namespace ringlet {

struct SceneReport {
    double newton = 0, cuts = 0, residual = 0, unconverged = 0;
    double stalled = 0; // objects that are not at rest in the step, and yet have not moved
    double linear_iterations = 0, linear_residual = 0;
    double candidates = 0, contacts = 0;      // candidate pairs, and contacts
    double closest = 0;                       // smallest gap of a contact at the end [m]
    double violations = 0, zone_vertices = 0; // pairs that would have met, vertices whose motion was limited for them
    double moved = 0, left = 0;               // Σ m · m and Σ m · l of the vertices' motions m and what is left of the last
                                              // search direction, l [m²]
    double lag = 0;                           // largest distance of a prescribed vertex from where it was to be [m]
    double time_pairs = 0, time_assemble = 0, time_solve = 0, time_search = 0, time_filter = 0; // [s]
};
inline constexpr int scene_report_columns = sizeof(SceneReport) / sizeof(double);

inline constexpr const char *scene_report_names[] = {
    "newton",          "cuts",       "residual", "unconverged", "stalled",       "linear_iterations",
    "linear_residual", "candidates", "contacts", "closest",     "violations",    "zone_vertices",
    "moved",           "left",       "lag",      "time_pairs",  "time_assemble", "time_solve",
    "time_search",     "time_filter"};
static_assert(sizeof(scene_report_names) / sizeof(*scene_report_names) == scene_report_columns);

class Stopwatch {
public:
    explicit Stopwatch(double &sum) : sum_(sum), start_(std::chrono::steady_clock::now()) {}
    ~Stopwatch() { sum_ += std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count(); }

private:
    double &sum_;
    std::chrono::steady_clock::time_point start_;
};

} // namespace ringlet
