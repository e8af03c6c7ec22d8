// What Python holds of strands: a model with the state that moves on it.
#pragma once

#include "ringlet/scene/strands.h"

namespace ringlet::bindings {

struct Strands {
    StrandModel model;
    StrandState state;
    std::vector<StrandReport> reports;
};

} // namespace ringlet::bindings
