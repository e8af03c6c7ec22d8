// Groups of strands, as many per group as the kernels have lanes.
#pragma once

#include "ringlet/linear/lane_vectors.h"
#include "ringlet/math/aligned.h"
#include "ringlet/strand/model.h"

#include <algorithm>
#include <vector>

namespace ringlet {

// Order in which strands fill the lanes: longest first, so that strands of a group have similar lengths and few rows lie behind
// a tip. The order is fixed: the result of a strand depends neither on its group nor on the number of threads.
std::vector<int> order_by_length(const StrandModel &model);

// The same; of equal length, near strands follow one another, so that strands in contact share groups.
std::vector<int> order_by_length_and_position(const StrandModel &model, View<Vec3> positions);

inline int longest_strand(const StrandModel &model) { // vertices, at least 3
    int most = 3;
    for (int s = 0; s < model.strand_count(); ++s) most = std::max(most, model.offsets[s + 1] - model.offsets[s]);
    return most;
}

// Parallel loop over all groups: calls work(group, workspace); a thread has one workspace, large enough for any group.
template <class Work> void for_each_group(const StrandModel &model, const Work &work) {
    const std::vector<int> order = order_by_length(model);
    const int strands = model.strand_count(), lanes = RINGLET_DISPATCH(strand_lanes);
    const int groups = (strands + lanes - 1) / lanes;
    const size_t bytes = RINGLET_DISPATCH(strand_workspace_bytes, longest_strand(model));
#pragma omp parallel
    {
        const AlignedMemory workspace(bytes);
#pragma omp for schedule(dynamic)
        for (int g = 0; g < groups; ++g)
            work(StrandGroup{order.data() + g * lanes, std::min(lanes, strands - g * lanes)}, workspace.get());
    }
}

} // namespace ringlet
