#include "ringlet/solver/plane_search.h"

#include <algorithm>
#include <functional>

namespace ringlet {

bool search_by_planes(Objective &objective, const AlignedVector &x, bool converged, SearchPath &path) {
    std::vector<unsigned char> accepted(objective.table.objects, 1);
    if (!converged) {
        const std::vector<unsigned char> searched = with_touched(objective, objective.by_planes());
        std::transform(searched.begin(), searched.end(), accepted.begin(), std::logical_not<>());
    }
    PlaneModel model(objective, accepted);
    AlignedVector end = x.copy();
    const LineSearchResult result = line_search(objective, model, path, accepted, end);
    if (!result.moved) return false;
    shorten(objective.blocks, result.step, path);
    objective.return_to(x);
    return true;
}

} // namespace ringlet
