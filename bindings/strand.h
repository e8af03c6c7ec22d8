// Strands as Python holds them: a model with its state.
#pragma once

#include "ringlet/strand/state.h"

#include <optional>

namespace ringlet::bindings {

class Strands {
public:
    Strands(StrandModel model, View<Vec3> rest) : model(std::move(model)), rest_(rest.begin(), rest.end()) {}

    StrandModel model;
    std::vector<StrandReport> reports;

    // At rest to begin with; finding that takes longer than all of the model, of which more is often not asked for.
    StrandState &state() {
        if (!state_) place(rest_);
        return *state_;
    }

    // directors: of the material frames; found by default
    void place(View<Vec3> positions, View<Vec3> directors = {}) {
        state_ = make_strand_state(model, positions, directors);
        rest_ = {};
    }

    // A state to be overwritten.
    StrandState &any_state() {
        if (!state_) place(rest_, rest_);
        return *state_;
    }

private:
    std::optional<StrandState> state_;
    std::vector<Vec3> rest_;
};

} // namespace ringlet::bindings
