// A replacement of the functions of GCC's OpenMP runtime that the core uses, visible to the thread sanitizer.
//
// libgomp synchronises by futexes that the sanitizer does not know, so it would report every loop as a race. This runtime
// uses mutexes and condition variables. A relaxed counter distributes the chunks of a loop, which adds no order between
// iterations.

#include <algorithm>
#include <atomic>
#include <condition_variable>
#include <cstdlib>
#include <deque>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

namespace {

int max_threads = [] {
    const char *given = std::getenv("OMP_NUM_THREADS");
    const int count = given != nullptr ? std::atoi(given) : 0;
    return count > 0 ? count : 4;
}();

std::mutex critical;   // shared by unnamed critical sections
std::mutex reductions; // of several variables

// A loop whose chunks threads take until none is left.
struct Loop {
    std::atomic<long> next;
    long end, step;
};

// The threads of a parallel region.
struct Team {
    int size;
    std::mutex mutex;
    std::condition_variable arrival;
    int arrived = 0, barriers = 0;
    std::deque<Loop> loops;
    size_t begun_with = 0; // loops that exist before the threads start

    explicit Team(int count) : size(count) {}

    void wait_for_all() {
        std::unique_lock lock(mutex);
        const int here = barriers;
        if (++arrived == size) {
            arrived = 0;
            ++barriers;
            arrival.notify_all();
        } else {
            arrival.wait(lock, [&] { return barriers != here; });
        }
    }
};

thread_local Team *team = nullptr;
thread_local int number = 0;
thread_local size_t loops_begun = 0;
thread_local Loop *loop = nullptr;

void work(Team &in, int as, void (*body)(void *), void *data) {
    Team *const outer = team;
    const int outer_number = number;
    const size_t outer_loops = loops_begun;
    Loop *const outer_loop = loop;
    team = &in, number = as, loops_begun = in.begun_with;
    if (in.begun_with > 0) loop = &in.loops.front();
    body(data);
    team = outer, number = outer_number, loops_begun = outer_loops, loop = outer_loop;
}

// Threads that wait for parallel regions.
class Pool {
public:
    ~Pool() {
        {
            const std::scoped_lock lock(mutex_);
            over_ = true;
        }
        begun_.notify_all();
        for (std::thread &thread : threads_) thread.join();
    }

    void run(Team &here, void (*body)(void *), void *data) {
        const std::scoped_lock alone(region_); // one region at a time
        const int count = here.size;
        {
            const std::scoped_lock lock(mutex_);
            while (int(threads_.size()) < count - 1)
                threads_.emplace_back([this, as = int(threads_.size()) + 1, seen = region_count_] { serve(as, seen); });
            job_ = [&here, body, data](int as) { work(here, as, body, data); };
            wanted_ = count, left_ = count - 1;
            ++region_count_;
        }
        begun_.notify_all();
        work(here, 0, body, data);
        std::unique_lock lock(mutex_);
        ended_.wait(lock, [&] { return left_ == 0; });
    }

private:
    void serve(int as, long seen) {
        for (;;) {
            std::function<void(int)> job;
            {
                std::unique_lock lock(mutex_);
                begun_.wait(lock, [&] { return over_ || region_count_ != seen; });
                if (over_) return;
                seen = region_count_;
                if (as >= wanted_) continue;
                job = job_;
            }
            job(as);
            const std::scoped_lock lock(mutex_);
            if (--left_ == 0) ended_.notify_all();
        }
    }

    std::mutex region_, mutex_;
    std::condition_variable begun_, ended_;
    std::function<void(int)> job_;
    std::vector<std::thread> threads_;
    int wanted_ = 0, left_ = 0;
    long region_count_ = 0;
    bool over_ = false;
};

Pool pool;

bool take(long *begin, long *end) {
    *begin = loop->next.fetch_add(loop->step, std::memory_order_relaxed);
    *end = std::min(*begin + loop->step, loop->end);
    return *begin < loop->end;
}

bool begin_loop(long first, long last, long chunk, long *begin, long *end) {
    const std::scoped_lock lock(team->mutex);
    if (loops_begun == team->loops.size()) team->loops.emplace_back(first, last, chunk);
    loop = &team->loops[loops_begun++];
    return take(begin, end);
}

int size_of_team(unsigned wanted) {
    if (team != nullptr) return 1;
    return wanted != 0 ? int(wanted) : max_threads;
}

void run(Team &here, void (*body)(void *), void *data) {
    if (here.size == 1)
        work(here, 0, body, data);
    else
        pool.run(here, body, data);
}

} // namespace

extern "C" {

int omp_get_max_threads() { return max_threads; }
int omp_get_num_threads() { return team != nullptr ? team->size : 1; }
int omp_get_thread_num() { return number; }
void omp_set_num_threads(int count) { max_threads = count; }

void GOMP_parallel(void (*body)(void *), void *data, unsigned count, unsigned) {
    Team here(size_of_team(count));
    run(here, body, data);
}

// The core's loops count upwards by one.
bool GOMP_loop_nonmonotonic_dynamic_start(long first, long last, long, long chunk, long *begin, long *end) {
    return begin_loop(first, last, chunk, begin, end);
}
void GOMP_parallel_loop_nonmonotonic_dynamic(void (*body)(void *), void *data, unsigned count, long first, long last, long,
                                             long chunk, unsigned) {
    Team here(size_of_team(count));
    here.loops.emplace_back(first, last, chunk), here.begun_with = 1;
    run(here, body, data);
}
bool GOMP_loop_nonmonotonic_dynamic_next(long *begin, long *end) { return take(begin, end); }

using Count = unsigned long long;
bool GOMP_loop_ull_nonmonotonic_dynamic_start(bool, Count first, Count last, Count, Count chunk, Count *begin, Count *end) {
    return begin_loop(long(first), long(last), long(chunk), reinterpret_cast<long *>(begin), reinterpret_cast<long *>(end));
}
bool GOMP_loop_ull_nonmonotonic_dynamic_next(Count *begin, Count *end) {
    return take(reinterpret_cast<long *>(begin), reinterpret_cast<long *>(end));
}

void GOMP_critical_start() { critical.lock(); }
void GOMP_critical_end() { critical.unlock(); }
void GOMP_atomic_start() { reductions.lock(); }
void GOMP_atomic_end() { reductions.unlock(); }

void GOMP_loop_end() { team->wait_for_all(); }
void GOMP_loop_end_nowait() {}
}
