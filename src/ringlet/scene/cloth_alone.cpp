#include "ringlet/scene/cloth_alone.h"

namespace ringlet {

ClothAlone::ClothAlone(const ClothModel &model, ClothState &state)
    : scene_(no_strands_, no_state_, {{&model, &state}}, {}, {}, {.enabled = false}) {}

ClothReport ClothAlone::step(const SceneInput &input, const SceneStep &step) {
    std::vector<StrandReport> of_strands;
    std::vector<ClothReport> of_cloths;
    scene_.place();
    scene_.step(input, step, of_strands, of_cloths);
    return of_cloths.front();
}

} // namespace ringlet
