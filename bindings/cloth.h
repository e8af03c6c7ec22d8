// A cloth as Python holds it.
#pragma once

#include "ringlet/scene/scene.h"

#include <memory>

namespace ringlet::bindings {

class Cloth {
public:
    Cloth(ClothModel model, View<Vec3> rest)
        : model(std::make_unique<ClothModel>(std::move(model))),
          state{{rest.begin(), rest.end()}, std::vector<Vec3>(rest.size(), Vec3::Zero())} {}

    std::unique_ptr<ClothModel> model;
    ClothState state;

    ClothAlone &alone() { // as a scene of its own
        if (!alone_) alone_ = std::make_unique<ClothAlone>(*model, state);
        return *alone_;
    }

private:
    std::unique_ptr<ClothAlone> alone_;
};

} // namespace ringlet::bindings
