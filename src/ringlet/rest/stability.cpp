#include "ringlet/rest/stability.h"

#include <algorithm>
#include <vector>

namespace ringlet {

void stabilising_stiffness(int count, const StaticStrands &strands, const double *left, double most, double *factors) {
    int longest = 0;
    for (int s = 0; s < count; ++s) longest = std::max(longest, strands.offsets[s + 1] - strands.offsets[s]);
    const size_t room = RINGLET_DISPATCH(stability_scratch, longest);
#pragma omp parallel
    {
        std::vector<double> memory(room);
#pragma omp for schedule(dynamic, 16)
        for (int s = 0; s < count; ++s)
            factors[s] = RINGLET_DISPATCH(stabilising_stiffness, strands, s, left[s], most, memory.data());
    }
}

} // namespace ringlet
