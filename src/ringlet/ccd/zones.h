// What would meet where bodies leave it no choice: it moves as one.
#pragma once

#include "ringlet/ccd/filter_scene.h"
#include "ringlet/ccd/meeting.h"

#include <algorithm>
#include <vector>

namespace ringlet {

// Zones of vertices that would meet; they grow from round to round. A zone is named by its smallest member, so that the order
// of joining does not matter.
class Zones {
public:
    explicit Zones(const FilterScene &scene);

    // What is kinematic does not join zones: one body would tie together all that touches it.
    void join(const std::vector<Met> &met);

    // Zones in which a pair would still meet move as one. Of what a pair's motions differ by only as much is taken as lets the
    // two touch, while that is hoped to do: only then do they push each other away.
    void move_as_one(View<Vec3> start, const std::vector<Met> &met, bool to_touch, std::vector<Vec3> &end);

private:
    int find(int v) {
        while (parent_[v] != v) v = parent_[v] = parent_[parent_[v]];
        return v;
    }
    void join(int a, int b) {
        a = find(a), b = find(b);
        parent_[std::max(a, b)] = std::min(a, b);
    }

    const FilterScene &scene_;
    std::vector<int> parent_;
    std::vector<unsigned char> in_zone_;
    std::vector<int> carrier_; // a kinematic vertex that it met
    std::vector<int> strands_; // all
};

} // namespace ringlet
