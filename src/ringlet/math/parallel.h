// The parallel loops of a step. All go through these two, so that a recorder sees them (math/loop_recorder.h).
#pragma once

#include "ringlet/math/loop_recorder.h"

namespace ringlet {

// Calls work(i) for 0 … count − 1 in equal parts, one a thread; in one part where `count` is below `least`.
template <class Work> void parallel_for(int count, int least, const Work &work, LoopSite site = LoopSite::here()) {
    if (LoopRecorder *const recorder = LoopRecorder::active())
        return recorder->record(site, count, count < least ? 1 : LoopRecorder::parts, false, work);
#pragma omp parallel for schedule(static) if (count >= least)
    for (int i = 0; i < count; ++i) work(i);
}

template <class Work> void parallel_for(int count, const Work &work, LoopSite site = LoopSite::here()) {
    parallel_for(count, 2, work, site);
}

// The same in chunks of `chunk`, which go to threads as they become free.
template <class Work> void parallel_chunks(int count, int chunk, const Work &work, LoopSite site = LoopSite::here()) {
    if (LoopRecorder *const recorder = LoopRecorder::active())
        return recorder->record(site, count, (count + chunk - 1) / chunk, true, work);
#pragma omp parallel for schedule(dynamic, chunk) if (count > chunk)
    for (int i = 0; i < count; ++i) work(i);
}

} // namespace ringlet
