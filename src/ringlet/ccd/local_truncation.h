// Local truncation: vertices that cannot complete a move lag behind; all others complete it.
#pragma once

#include "ringlet/ccd/advected_move.h"

namespace ringlet {

// Corrects a move until it has no impacts. A vertex with an impact makes a fraction of its move, none of it where the pair
// begins close: a pinch does not tighten. Prescribed vertices too, so that a body is dented where it pinches something. Along
// strands and over cloths that spreads so far that no edge is strained by much; objects that are `whole` keep one fraction of
// their move. Vertices that make none of it have no impacts, so this ends.
void truncate_locally(AdvectedMove &move, View<unsigned char> whole = {});

} // namespace ringlet
