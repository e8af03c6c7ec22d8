// Two lists in the order of contacts' names, walked through together.
#pragma once

#include <cstdint>

namespace ringlet {

// Calls work(known, found) for each of `found` whose name one of `known` has.
template <class Known, class Found, class NameOf, class Work>
void for_known(Known &known, Found &found, const NameOf &name_of, const Work &work) {
    auto next = known.begin();
    for (auto &now : found) {
        const uint64_t name = name_of(now);
        while (next != known.end() && next->name < name) ++next;
        if (next == known.end()) return;
        if (next->name == name) work(*next, now);
    }
}

template <class Known, class Found, class Work> void for_known(Known &known, Found &found, const Work &work) {
    for_known(known, found, [](const auto &now) { return now.name; }, work);
}

} // namespace ringlet
