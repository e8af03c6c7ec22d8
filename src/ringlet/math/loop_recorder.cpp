#include "ringlet/math/loop_recorder.h"

#include <ctime>
#include <functional>

namespace ringlet {
namespace {

double read(clockid_t clock) { // [s]
    timespec now{};
    clock_gettime(clock, &now);
    return double(now.tv_sec) + 1e-9 * double(now.tv_nsec);
}

double time_of_reading(clockid_t clock) { // [s]
    constexpr int turns = 1000;
    const double begin = read(CLOCK_THREAD_CPUTIME_ID);
    for (int turn = 0; turn < turns; ++turn) read(clock);
    return (read(CLOCK_THREAD_CPUTIME_ID) - begin) / turns;
}

// Lowers the longest to one value, so that the sum is `sum`: another process ran meanwhile.
void cap(std::vector<float>::iterator first, std::vector<float>::iterator last, double sum) {
    std::vector<float> longest(first, last);
    std::sort(longest.begin(), longest.end(), std::greater<>());
    double left = sum; // for what is no longer than the cap
    for (const float duration : longest) left -= duration;
    if (left >= 0.0) return;
    size_t capped = 0;
    double most = 0.0;
    do {
        left += longest[capped++];
        most = std::max(left / double(capped), 0.0);
    } while (capped < longest.size() && longest[capped] > most);
    for (auto duration = first; duration != last; ++duration) *duration = std::min(*duration, float(most));
}

} // namespace

thread_local LoopRecorder *LoopRecorder::active_ = nullptr;

LoopRecorder::LoopRecorder()
    : cpu_read_(time_of_reading(CLOCK_THREAD_CPUTIME_ID)), wall_read_(time_of_reading(CLOCK_MONOTONIC)) {
    active_ = this;
}

LoopRecorder::Step::Step(LoopSite site) : site_(site) {
    if (active_ == nullptr) return;
    active_->between_loops_ = true;
    active_->cpu_ = read(CLOCK_THREAD_CPUTIME_ID);
}

LoopRecorder::Step::~Step() {
    if (active() == nullptr) return;
    active_->begin_loop(site_, false);
    active_->end_loop();
    active_->between_loops_ = false;
}

void LoopRecorder::begin_loop(LoopSite site, bool dynamic) {
    const double cpu = read(CLOCK_THREAD_CPUTIME_ID);
    loops_.push_back({site, std::max(cpu - cpu_ - cpu_read_, 0.0), 0.0, dynamic, 0});
    cpu_ = cpu;
    between_loops_ = false;
    wall_ = read(CLOCK_MONOTONIC);
}

void LoopRecorder::end_chunk() {
    const double wall = read(CLOCK_MONOTONIC);
    chunks_.push_back(float(std::max(wall - wall_ - wall_read_, 0.0)));
    wall_ = wall;
}

void LoopRecorder::end_loop() {
    RecordedLoop &loop = loops_.back();
    const int64_t begin = loops_.size() > 1 ? loops_[loops_.size() - 2].end : 0;
    loop.end = int64_t(chunks_.size());
    const double cpu = read(CLOCK_THREAD_CPUTIME_ID);
    if (loop.end > begin) {
        loop.inside = std::max(cpu - cpu_ - cpu_read_ - double(loop.end - begin + 1) * wall_read_, 0.0);
        cap(chunks_.begin() + begin, chunks_.end(), loop.inside);
    }
    cpu_ = cpu;
    between_loops_ = true;
}

} // namespace ringlet
