// A cloth alone: a scene of one block, without contact.
#pragma once

#include "ringlet/scene/scene.h"

namespace ringlet {

class ClothAlone {
public:
    // Borrows model and state, which must outlive it.
    ClothAlone(const ClothModel &model, ClothState &state);

    // One step from the state as it is. `targets` and `forces` are those of the cloth's vertices.
    ClothReport step(const SceneInput &input, const SceneStep &step);

private:
    StrandModel no_strands_{.offsets = {0}};
    StrandState no_state_;
    Scene scene_;
};

} // namespace ringlet
