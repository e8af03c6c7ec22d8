// Records how long the chunks of parallel loops take, and what runs between the loops: `ringlet bench serial` replays it.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

namespace ringlet {

// Where a loop stands in the sources.
struct LoopSite {
    const char *file, *function;
    int line;

    static LoopSite here(const char *file = __builtin_FILE(), const char *function = __builtin_FUNCTION(),
                         int line = __builtin_LINE()) {
        return {file, function, line};
    }
};

struct RecordedLoop {
    LoopSite site;
    double serial, inside; // processor time before it, since the last loop or the begin of the step, and in it [s]
    bool dynamic;          // chunks go to threads as they become free
    int64_t end;           // of its chunks
};

// The loops of the steps that one thread makes; those within chunks of others belong to these. All must run on that thread.
class LoopRecorder {
public:
    static constexpr int parts = 64; // of a loop in equal parts: there may be as many workers

    // Records until it is destroyed.
    LoopRecorder();
    ~LoopRecorder() { active_ = nullptr; }
    LoopRecorder(const LoopRecorder &) = delete;
    LoopRecorder &operator=(const LoopRecorder &) = delete;

    // That of this thread, where it is in a step and in no loop.
    static LoopRecorder *active() { return active_ != nullptr && active_->between_loops_ ? active_ : nullptr; }

    template <class Work> void record(LoopSite site, int count, int chunks, bool dynamic, const Work &work) {
        begin_loop(site, dynamic);
        chunks = std::min(chunks, count);
        for (int chunk = 0; chunk < chunks; ++chunk) {
            const int end = int(int64_t(count) * (chunk + 1) / chunks);
            for (int i = int(int64_t(count) * chunk / chunks); i < end; ++i) work(i);
            end_chunk();
        }
        end_loop();
    }

    // A step, to the end of the scope. What follows its last loop becomes a loop without chunks.
    class Step {
    public:
        explicit Step(LoopSite site = LoopSite::here());
        ~Step();

    private:
        LoopSite site_;
    };

    const std::vector<RecordedLoop> &loops() const { return loops_; }
    const std::vector<float> &chunks() const { return chunks_; } // how long each took [s]

private:
    void begin_loop(LoopSite site, bool dynamic);
    void end_chunk();
    void end_loop();

    static thread_local LoopRecorder *active_;
    bool between_loops_ = false;
    double cpu_ = 0.0, wall_ = 0.0; // when they were read last [s]
    double cpu_read_, wall_read_;   // how long reading them takes [s]
    std::vector<RecordedLoop> loops_;
    std::vector<float> chunks_;
};

} // namespace ringlet
