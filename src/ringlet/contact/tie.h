// A tie between vertices of two objects. It couples them as a contact does, and takes the place of one in the ContactSet: a
// spring ½ k (‖s‖ − L)² of the separation s stands in for barrier and friction.
#pragma once

#include "ringlet/contact/contact.h"

namespace ringlet {

struct Tie {
    std::array<int, 2> vertex;
    double length;    // at rest [m]
    double stiffness; // [N/m]
};

// Names of ties are larger than those of contacts.
inline Contact as_contact(const Tie &tie, int number) {
    const auto [a, b] = tie.vertex;
    Contact contact{};
    contact.vertex = {a, b, b, b}, contact.weight = {1.0, -1.0, 0.0, 0.0}, contact.first = 1;
    contact.tied_length = tie.length;
    contact.stiffness = tie.stiffness;
    contact.loaded_fraction = 1.0;
    contact.pair = ~uint64_t(0) << 32 | uint64_t(number);
    return contact;
}

} // namespace ringlet
