// How stiff contacts are: as stiff as what they have to bear asks for.
#pragma once

#include "ringlet/solver/scene_system.h"

#include <vector>

namespace ringlet {

// A contact has to bear what strands are pulled with; were it always as hard, hair that lies in hair would stand still: nearly
// every direction leads into a contact that was not known, whose energy is thousands of times that of the motion. So a vertex
// is a hundredth as hard as it may have to be, a tenth where it bears more than that can, and all of it where it has to be.
// With few such levels a step has one solution, whatever way leads there.
class ContactStiffness {
public:
    explicit ContactStiffness(int vertices) : borne_(vertices, 0.0) {}

    // A step of dt begins [s]. What vertices bore is forgotten slowly: hair that rests on hair is not to become soft, sink in
    // and become hard again. `scale` is that of all that is hard.
    void begin(const SceneSystem &system, double scale, double dt);

    // Contacts may turn out to bear more than before; whether one does. Nothing becomes softer within a step.
    bool bear(const ContactSet &contacts);

    // Per vertex, where it has to be [N/m]; what is kinematic: infinity.
    const std::vector<double> &hardest() const { return hardest_; }

    // Per vertex [N/m], where strands touch at that distance [m].
    std::vector<double> needed(const SceneVertices &vertices, double distance) const;

    // Per vertex: the most that a contact of it had to bear, as far as it is not forgotten [N].
    const std::vector<double> &borne() const { return borne_; }
    void recall(std::vector<double> borne) { borne_ = std::move(borne); }

private:
    std::vector<double> hardest_, borne_;
};

} // namespace ringlet
