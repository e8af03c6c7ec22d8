// Damping of the relative motion of strands in contact (Levenberg 1944), so that neighbours move together before they part.
#pragma once

#include "ringlet/solver/settings.h"

namespace ringlet {

// A part of the stiffness of contacts, which falls from iteration to iteration and comes to nothing.
class RelativeDamping {
public:
    explicit RelativeDamping(bool on) : part_(on ? solver_settings::first_damping : 0.0) {}

    double part() const { return part_; }

    void end_iteration() {
        part_ *= solver_settings::damping_decay;
        if (part_ < solver_settings::least_damping) part_ = 0.0;
    }

private:
    double part_;
};

} // namespace ringlet
