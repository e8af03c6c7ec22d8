// What Python holds of a cloth.
#pragma once

#include "ringlet/cloth/cloth_step.h"

#include <memory>

namespace ringlet::bindings {

// A model with the state that moves on it. The objective refers to the model.
struct Cloth {
    std::unique_ptr<ClothModel> model;
    ClothObjective objective;
    ClothState state;
};

} // namespace ringlet::bindings
