// Which strands need more iterations of Newton's method than were asked for: those that something in their way held back, until
// they fit. The others are done, so that what is violent costs only where it is.
#pragma once

#include "ringlet/solver/scene_system.h"

#include <vector>

namespace ringlet {

class SceneProgress {
public:
    explicit SceneProgress(const SceneSystem &system);

    // A move from `now` to `wanted` was filtered: it ends at `to`. Where that is not told, nothing was held back.
    void moved(View<Vec3> now, View<Vec3> wanted, View<Vec3> to);
    void cut(const std::vector<double> &step); // by the search: how much of its move each part went
    void judge(double tolerance);              // after each iteration; or after a guess

    bool all_went() const; // in the last move all parts went all of their way

    // Those that were held back and are stretched by more than a few per cent; with what touches them they alone are active
    // from now on. False: there are none.
    bool narrow(SceneSystem &system, View<Vec3> now);

private:
    bool is_stretched(int strand, View<Vec3> now) const;

    const SceneSystem &system_;
    std::vector<double> way_, left_;  // per part: how far it was to go [m], and the part of it that it went
    std::vector<double> edge_;        // of each strand at rest, on average [m]
    std::vector<unsigned char> held_; // per part
};

} // namespace ringlet
