"""The groom that a recipe makes: guides, locks and the scalp they grow on."""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import dataclass, field
from html import escape
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ringlet.data.accessory import Accessory
from ringlet.data.curves import Curves
from ringlet.data.errors import UserError
from ringlet.data.mesh import Mesh
from ringlet.data.precision import origin_of
from ringlet.data.sketch import sketch
from ringlet.data.stage import StageSpace

# Attributes of locks that groom operators write and a run reads.
SECTION = "section"  # of a lock: the id of its section of the scalp; −1: none
STRAND_RADIUS = "strand_radius"  # of a lock: the radius that it has of its own, as a strand of a braid [m]; 0: none
CORE = "core"  # of a lock: 1 where the locks of its section are simulated as one rod, 0 elsewhere
HAIR_SHARE = "hair_share"  # of a lock: part of its hairs that grow, where there is a mask
STRAND_PROFILE = "strand_profile"  # of a lock: factors on that radius at even steps from root to tip, shape (count, k)
TIED = "tied"  # of a point: 1 where a band ties the locks of a section, 0 elsewhere
WORN_MASS = "worn_mass"  # of a point: mass of what it carries, such as a part of a bead [kg]
WORN_RADIUS = "worn_radius"  # of a point: distance from it to the outside of what it carries [m]

GROOM = "groom"  # of a lock, a guide or a hair: the row of its groom among those of the head, where there are several

FLAT = 1e-9  # twice the area of a triangle, relative to its longest edge squared, at which it has no frame


ADOPTED = "adopted_"  # begins the names of what was fitted to locks of finished hair
# Of a lock: what its curl does not fit, in the frames of its shape [m], shape (count, 3 · points).
OFFSETS = f"{ADOPTED}offsets"


@dataclass
class HairOffsets:
    """Hairs that were made elsewhere, each by its offsets from its lock.

    lock:             id of the lock of each hair, shape (hairs,), int64; the first hair of each lock is the lock
    tip:              place on the lock where the hair ends, 0 root … 1 tip, shape (hairs,), float32
    across:           offsets at even steps from root to tip, in the lock's frame [m], shape (hairs, points, 2), float32
    width:            diameters at even steps [m], shape (hairs, k), float32
    root_triangle:    triangle of the root, shape (hairs,), int32
    root_barycentric: weights of the root, shape (hairs, 3), float64
    root_falloff:     part of a hair over which it comes from its root to its offset
    """

    lock: NDArray[np.int64]
    tip: NDArray[np.float32]
    across: NDArray[np.float32]
    width: NDArray[np.float32]
    root_triangle: NDArray[np.int32]
    root_barycentric: NDArray[np.float64]
    root_falloff: float

    def take(self, rows: NDArray) -> HairOffsets:
        """The chosen hairs."""
        arrays = {name: values[rows] for name, values in vars(self).items() if isinstance(values, np.ndarray)}
        return HairOffsets(**arrays, root_falloff=self.root_falloff)

    def check(self, what: str) -> HairOffsets:
        """Raises UserError for arrays that do not fit one another or are not finite. Returns self."""
        count = len(self.lock)
        arrays = {name: values for name, values in vars(self).items() if isinstance(values, np.ndarray)}
        shaped = self.across.ndim == 3 and self.across.shape[1] >= 2 and self.across.shape[2] == 2
        if not count or any(len(values) != count for values in arrays.values()) or not shaped:
            raise UserError(f"{what}: its arrays of hairs do not fit one another; adopt the hair again")
        if not all(np.isfinite(values).all() for values in arrays.values()) or not 0.0 < self.root_falloff <= 1.0:
            raise UserError(f"{what}: holds values that are not finite or out of range; adopt the hair again")
        return self


@dataclass
class Groom:
    """The final groom guides with everything that later stages need.

    guides:     the artist's low-resolution curves
    locks:      groom guides, one per lock. Curve attributes: ``root_triangle`` (count,) int32 into ``scalp.triangles``,
                ``root_barycentric`` (count, 3) float64. Their points are the groomed shape in the rest pose [m].
                Point attributes: ``pin`` (n,), where something is pinned: how firmly the skin holds a point, 0 to 1;
                ``tied`` (n,), where something is tied. Locks with a thickness of their own have ``strand_radius`` [m].
    scalp:      the mesh they grow on, in its rest pose
    scalp_file: the USD file it came from (None for a mesh made in memory)
    scalp_prim: its prim path in that file
    region:     the named region that carries roots (None for all of it)
    space:      unit, up-axis and rate of that file
    hairs:      the ``[hairs]`` settings of the recipe, as plain values
    color:      the ``[color]`` settings, as plain values (None without them)
    fiber:      the ``[fiber]`` settings, as plain values (None without them)
    recipe:     the text of the recipe, kept with the groom
    shapes:     the locks before they were curled (None for a groom that was read from a file)
    unsculpted: the guides before they were sculpted by hand (None for a groom that was read from a file)
    variant:    which variant of the file it was read from (None where that has none)
    conflicts:  a sentence for every edit of a guide or a lock that is not there, for a head or hair of an odd size, for
                what is in the files of the recipe but not used, for locks that start into the head, and for those that
                a displacement makes much longer
    accessories: what the hair wears, such as bands of ties and beads, which locks carry
    edge:       length of the lines that carry hair, as for lashes [m] (None for hair on an area)
    hidden:     paths of the meshes of the head's file that the hair replaces: not shown, and touched by nothing
    offsets:    hairs in place of those that the settings make (None for a groom whose hairs are made)
    cage:       whether hair grows on the cage of a subdivision surface, instead of on its limit surface
    grooms:     settings by name where this is several grooms on one head, such as hair, brows and lashes: ``region``,
                ``edge``, ``hairs``, ``color`` and ``fiber`` as above, and ``absent``: attributes that only others have.
                Curves have the attribute ``groom``, the row of their groom here. Empty for one groom.
    """

    guides: Curves
    locks: Curves
    scalp: Mesh
    scalp_file: Path | None = None
    scalp_prim: str | None = None
    region: str | None = None
    space: StageSpace = field(default_factory=StageSpace)
    hairs: dict[str, Any] = field(default_factory=dict)
    color: dict[str, Any] | None = None
    fiber: dict[str, Any] | None = None
    recipe: str | None = None
    shapes: Curves | None = None
    unsculpted: Curves | None = None
    variant: str | None = None
    conflicts: list[str] = field(default_factory=list)
    cage: bool = False
    accessories: list[Accessory] = field(default_factory=list)
    edge: float | None = None
    hidden: list[str] = field(default_factory=list)
    grooms: dict[str, dict[str, Any]] = field(default_factory=dict)
    offsets: HairOffsets | None = None

    def __repr__(self) -> str:
        grooms = f" of {', '.join(self.grooms)}" if self.grooms else ""
        return f"Groom({len(self.locks):,} locks{grooms} and {len(self.guides):,} guides on {self.scalp.name})"

    def _repr_html_(self) -> str:
        return f"<p>{escape(repr(self))}</p>{sketch(self.locks.points, self.locks.offsets)}"

    def check_bound(self, what: str) -> None:
        """Refuses locks that are not bound to the scalp; ``what`` asks, for messages."""
        if not {"root_triangle", "root_barycentric"} <= self.locks.curve.keys():
            raise UserError(f"{what}: the locks are not bound to a scalp; make the groom again from its recipe")

    def check_roots(self, scalp_points: NDArray[np.floating], when: str, what: str) -> None:
        """Refuses locks without roots on the scalp, and a scalp on which a root has no frame.

        scalp_points: positions of the scalp [m], shape (n, 3)
        when, what:   which positions these are, and who asks, for messages
        """
        self.check_bound(what)
        scalp, bound = self.scalp, self.locks.curve
        if scalp_points.shape != scalp.points.shape:
            raise UserError(
                f"{scalp.name}: has {len(scalp_points)} points at {when}, but the groom was made on one with "
                f"{len(scalp.points)}; make the groom again on this mesh"
            )
        a, b, c = np.asarray(scalp_points, np.float64)[scalp.triangles[bound["root_triangle"]]].transpose(1, 0, 2)
        with np.errstate(invalid="ignore", over="ignore"):
            longest = np.maximum(np.sum((b - a) ** 2, axis=1), np.sum((c - a) ** 2, axis=1))
            flat = ~(np.linalg.norm(np.cross(b - a, c - a), axis=1) > FLAT * longest)
        flat |= ~np.isfinite(longest)
        if flat.any():
            lock = int(flat.argmax())
            raise UserError(
                f"{scalp.name}: at {when} triangle {bound['root_triangle'][lock]}, where lock {self.locks.ids[lock]} "
                "is rooted, has no area or is not finite; mend the mesh or its animation"
            )

    @property
    def regions(self) -> list[str | None]:
        """The named regions that carry roots, one for each groom; None for all of the scalp."""
        return [settings["region"] for settings in self.grooms.values()] or [self.region]

    def shows(self, mesh: str) -> bool:
        """Whether a mesh of the head's file, by its name, is not replaced by hair."""
        return shows(mesh, self.hidden)

    @property
    def origin(self) -> NDArray[np.float64]:
        """The origin near the head [m], relative to which single precision is exact, shape (3,); 0 up to 8 m away."""
        return origin_of(self.scalp.points if len(self.scalp.points) else self.locks.points)


def shows(mesh: str, hidden: Collection[str]) -> bool:
    """Whether a mesh of the head's file, by its name, is none of the hidden prims."""
    return mesh.rpartition(" ")[2] not in hidden
