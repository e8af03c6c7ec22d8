"""The groom that a recipe makes: guides, locks and the scalp they grow on."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from ringlet.data.curves import Curves
from ringlet.data.mesh import Mesh
from ringlet.data.stage import StageSpace


@dataclass
class Groom:
    """The final groom guides with everything that later stages need.

    guides:     the artist's low-resolution curves
    locks:      groom guides, one per lock. Curve attributes: ``root_triangle`` (count,) int32 into ``scalp.triangles``,
                ``root_barycentric`` (count, 3) float64. Their points are the groomed shape in the rest pose [m].
                Point attribute, where something is nailed: ``nail`` (n,), how firmly the skin holds a point, 0 to 1.
    scalp:      the mesh they grow on, in its rest pose
    scalp_file: the USD file it came from (None for a mesh made in memory)
    scalp_prim: its prim path in that file
    region:     the named region that carries roots (None for all of it)
    space:      unit, up-axis and rate of that file
    hairs:      the ``[hairs]`` settings of the recipe, as plain values
    recipe:     the text of the recipe, kept with the groom
    shapes:     the locks before they were curled (None for a groom that was read from a file)
    unsculpted: the guides before they were sculpted by hand (None for a groom that was read from a file)
    variant:    which variant of the file it was read from (None where that has none)
    conflicts:  a sentence for every edit of a guide or a lock that is not there, for a head of an odd size, and for
                locks that start into it
    """

    guides: Curves
    locks: Curves
    scalp: Mesh
    scalp_file: Path | None = None
    scalp_prim: str | None = None
    region: str | None = None
    space: StageSpace = field(default_factory=StageSpace)
    hairs: dict[str, Any] = field(default_factory=dict)
    recipe: str | None = None
    shapes: Curves | None = None
    unsculpted: Curves | None = None
    variant: str | None = None
    conflicts: list[str] = field(default_factory=list)
