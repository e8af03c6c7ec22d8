// What a vertex gives up of its motion, its neighbours give up in part, so that no edge between them is strained by much.
#pragma once

#include "ringlet/ccd/filter_scene.h"

#include <vector>

namespace ringlet {

// How much a vertex gives up of its own motion for another.
struct Pull {
    double part = 0.0;
    Vec3 motion = Vec3::Zero();
};

inline constexpr double most_strain = 0.05;

// How much an edge may be strained by what its vertices give up.
struct FadeStrain {
    double strand, cloth;
};

// Along the strands that are named from vertex to vertex, in both directions, and over all cloths.
void fade(const FilterScene &scene, View<Vec3> start, View<Vec3> end, const FadeStrain &most, View<int> strands,
          std::vector<Pull> &pulls);

} // namespace ringlet
