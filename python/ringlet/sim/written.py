"""What a simulation writes, judged frame by frame: stretch, folds and penetration of the locks that leave it."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ringlet.data.braids import Braids
from ringlet.data.curves import Curves, offsets_from_counts
from ringlet.sim.cores import Cores
from ringlet.sim.entangled import Entangled
from ringlet.sim.garment import SimulatedGarment
from ringlet.sim.obstacle import Obstacle
from ringlet.sim.penetration import depths_beyond, penetration_depths

LEAST_DEPTH = 5e-4  # at which a strand counts as inside [m]; twice the thickness of skin in contact
OTHER_BRAIDS = "other braids"


class Written:
    """The locks of a groom as a run writes them: those that are simulated, and the strands that cores carry.

    cores: the braids that are simulated as one rod each
    rest:  the rest shape of all locks; the groomed one by default
    held:  the vertices of simulated locks that follow the scalp, shape (n,)
    """

    def __init__(self, cores: Cores, rest: Curves | None, held: NDArray[np.bool_]) -> None:
        self.locks, self._carried = cores.whole.locks, cores.of_core >= 0
        of_carried = np.repeat(self._carried, self.locks.counts)
        lengths = self.locks.edge_lengths()
        self._lengths = lengths if rest is None else np.where(of_carried, lengths, rest.edge_lengths())
        ends_free = np.append(~np.asarray(cores.spread(held), bool)[1:], False) | of_carried
        self._edges = np.flatnonzero(ends_free & (lengths > 0.0))
        self._braids = Braids.of(self.locks)
        self._groomed_folds = self._braids.folded(self.locks.points)
        self._entangled = Entangled(self._braids, of_carried) if self._carried.any() else None

    def statistics(
        self,
        points: NDArray[np.floating],
        obstacles: Sequence[Obstacle],
        frame: float,
        garments: Sequence[SimulatedGarment] = (),
    ) -> dict[str, Any]:
        """Of the locks at positions [m], shape (n, 3), at a frame: ``max_stretch`` and its ``worst_lock``.

        Where there are any, also ``folds``, the points at which braids fold that did not in the groom, with their
        ``folded_locks``; and ``inside``, what carried strands are in: bodies, cloths where they are, other braids.
        """
        at = np.asarray(points, np.float64)
        ends = at[self._edges + 1] - at[self._edges]
        strain = np.abs(np.sqrt(np.einsum("ni,ni->n", ends, ends)) / self._lengths[self._edges] - 1.0)
        worst = int(strain.argmax())
        folded = self._braids.folded(at) & ~self._groomed_folds
        inside = self._inside(at, obstacles, frame, garments)
        return {
            "max_stretch": float(strain[worst]),
            "worst_lock": self._locks_of(self._edges[[worst]])[0],
            **(
                {"folds": int(folded.sum()), "folded_locks": self._locks_of(np.flatnonzero(folded))}
                if folded.any()
                else {}
            ),
            **({"inside": inside} if inside else {}),
        }

    def _inside(
        self,
        at: NDArray[np.float64],
        obstacles: Sequence[Obstacle],
        frame: float,
        garments: Sequence[SimulatedGarment],
    ) -> list[dict[str, Any]]:
        """Name, depth [m], number of points and locks of the carried strands in each thing, the deepest first."""
        if self._entangled is None:
            return []
        rows, offsets = self.locks.point_rows(self._carried), offsets_from_counts(self.locks.counts[self._carried])
        strands = at[rows]
        depths = [(OTHER_BRAIDS, self._entangled.depths(at, LEAST_DEPTH)[rows])]
        for body in obstacles:
            depth = penetration_depths(strands, body.mesh.triangles, body.at(frame), LEAST_DEPTH)
            depths.append((body.name, depth))
        for worn in garments:
            depth = depths_beyond(strands, offsets, worn.garment.mesh.triangles, worn.cloth.positions, LEAST_DEPTH)
            depths.append((worn.name, depth))
        found = [
            {"what": name, "depth": float(depth.max()), "points": int(deep.sum()), "locks": self._locks_of(rows[deep])}
            for name, depth in depths
            if (deep := depth > 0.0).any()
        ]
        return sorted(found, key=lambda entry: -entry["depth"])

    def _locks_of(self, points: NDArray[np.integer]) -> list[int]:
        """Ids of the locks of points, ascending."""
        return [
            int(lock) for lock in self.locks.ids[np.unique(np.searchsorted(self.locks.offsets, points, "right") - 1)]
        ]
