// A cloth alone: a scene of one block, without contact.
#pragma once

#include "ringlet/scene/scene.h"

namespace ringlet {

class ClothAlone {
public:
    // Borrows model and state, which must outlive it.
    ClothAlone(const ClothModel &model, ClothState &state)
        : scene_(no_strands_, no_state_, {{&model, &state}}, {}, {}, {.enabled = false}) {}

    // One step from the state as it is. `targets` and `forces` are those of the cloth's vertices.
    ClothReport step(const SceneInput &input, const SceneStep &step) {
        std::vector<StrandReport> of_strands;
        std::vector<ClothReport> of_cloths;
        scene_.place();
        scene_.step(input, step, of_strands, of_cloths);
        return of_cloths.front();
    }

private:
    StrandModel no_strands_{.offsets = {0}};
    StrandState no_state_;
    Scene scene_;
};

} // namespace ringlet
