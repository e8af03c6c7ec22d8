#include "ringlet/rest/standing.h"

#include <algorithm>
#include <vector>

namespace ringlet {

void stiffness_to_stand(int count, const StillStrands &strands, const double *left, double most, double *factors) {
    int longest = 0;
    for (int s = 0; s < count; ++s) longest = std::max(longest, strands.offsets[s + 1] - strands.offsets[s]);
    const size_t room = RINGLET_DISPATCH(standing_room, longest);
#pragma omp parallel
    {
        std::vector<double> memory(room);
#pragma omp for schedule(dynamic, 16)
        for (int s = 0; s < count; ++s)
            factors[s] = RINGLET_DISPATCH(stiffness_to_stand, strands, s, left[s], most, memory.data());
    }
}

} // namespace ringlet
