"""A take of live hair: some seconds of its rods and of its head, to be kept and played again.

Vertices of rods are stored in the frame of their head, from where they were groomed. Each coordinate is a whole number
of parts of a length, of which the farthest has 32767: finer than what is seen, and small.
"""

from __future__ import annotations

import io
import zipfile
from dataclasses import dataclass, fields
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ringlet.data.errors import UserError
from ringlet.viewer import protocol
from ringlet.viewer.wire import pack, split

Array = NDArray[np.float64]
Vector = tuple[float, float, float]

SECONDS, LEAD = 5.0, 1.0  # of a take, and for how long the motion of the head before it is kept too [s]
STILL = 1e-4  # way that is no motion [m]
MOST = 2**15 - 1  # parts of a length
MOST_STEPS, MOST_BYTES = 10_000, 500_000_000  # of a take that is read


@dataclass(frozen=True, eq=False)
class LiveTake:
    """Some seconds of live hair. Places are relative to ``origin`` [m].

    fps:     steps a second
    origin:  of places, shape (3,)
    pivot:   about which the head turns on its neck, shape (3,)
    points, along, axis, rise, ids, carrier: rods as groomed, as in ``protocol.Rods``
    steps:   numbers of the steps, from 0; those that were left out are missing; shape (n,)
    heads:   motion of the head since it was groomed, the rows of a 3 × 4 matrix, shape (n, 12)
    trunks:  shift of what is below the neck, shape (n, 3)
    before:  head and trunk in the steps before the first, in order, shape (m, 15)
    unit:    length of a part [m], shape ()
    moved:   way of the vertices of rods in the frame of the head, in parts, shape (n, 3 × vertices)
    worn:    points of what the hair wears in the frame of the head, in parts, shape (n, 3 × points)
    wind:    mean velocity of the air [m/s], shape (3,)
    """

    fps: Array
    origin: Array
    pivot: Array
    points: NDArray[np.float32]
    along: NDArray[np.float32]
    axis: NDArray[np.float32]
    rise: NDArray[np.float32]
    ids: Array
    carrier: NDArray[np.uint32]
    steps: NDArray[np.int32]
    heads: Array
    trunks: Array
    before: Array
    unit: Array
    moved: NDArray[np.int16]
    worn: NDArray[np.int16]
    wind: Array

    @classmethod
    def of(cls, rods: bytes, steps: list[tuple[bytes, Vector]], fps: float, origin: Array) -> LiveTake:
        """The take of messages of rods and of their steps, each with the wind; raises UserError where nothing moves."""
        still, groomed = split(rods)
        messages, winds = zip(*steps, strict=True)
        headers, arrays = zip(*map(split, messages), strict=True)
        numbers = np.array([header["step"] for header in headers], np.int32)
        heads = np.array([header["head"] for header in headers])
        trunks = np.array([header["trunk"] for header in headers])
        first = int(np.searchsorted(numbers, numbers[-1] - round(SECONDS * fps) + 1))
        turns, shifts = heads.reshape(-1, 3, 4)[..., :3], heads.reshape(-1, 3, 4)[..., 3]

        def in_head(name: str) -> Array:
            places = np.stack([one[name] for one in arrays]).astype(np.float64)[first:]
            return (places.reshape(len(places), -1, 3) - shifts[first:, None]) @ turns[first:]

        moved, worn = in_head("points") - groomed["points"].reshape(-1, 3), in_head("worn")
        way = max(np.ptp(moved, axis=0).max(initial=0.0), np.ptp(heads[first:], axis=0).max())
        if way < STILL:
            raise UserError(f"take: nothing has moved in the last {SECONDS:g} s; move the head, and keep the take then")
        unit = max(np.abs(moved).max(initial=0.0), np.abs(worn).max(initial=0.0)) / MOST
        return cls(
            fps=np.array(fps),
            origin=np.asarray(origin, np.float64),
            pivot=np.array(still["pivot"]),
            points=groomed["points"],
            along=groomed["along"],
            axis=groomed["axis"],
            rise=groomed["rise"],
            ids=groomed["ids"],
            carrier=groomed["carrier"],
            steps=numbers[first:] - numbers[first],
            heads=heads[first:],
            trunks=trunks[first:],
            before=np.concatenate([heads, trunks], axis=1)[:first],
            unit=np.array(unit),
            moved=_parts(moved, unit),
            worn=_parts(worn, unit),
            wind=np.mean(winds[first:], axis=0),
        )

    @property
    def seconds(self) -> float:
        """How long it is [s]."""
        return float((self.steps[-1] + 1) / self.fps)

    def rods_at(self, row: int) -> Array:
        """Where the vertices of the rods are in a step [m], shape (vertices, 3)."""
        head = self.heads[row].reshape(3, 4)
        places = self.points.reshape(-1, 3) + self.unit * self.moved[row].reshape(-1, 3)
        return places @ head[:, :3].T + head[:, 3]

    def message(self, side: protocol.Side, id: str, first: int | None) -> bytes:
        """Message that lets pages play it. id: of its snapshot; first: the frame of the open shot that it begins at"""
        names = ("points", "along", "axis", "rise", "ids", "carrier", "steps", "heads", "trunks", "moved", "worn")
        head = protocol.LiveTake(
            side=side, id=id, fps=float(self.fps), first=first, pivot=tuple(self.pivot.tolist()), unit=float(self.unit)
        )
        return pack(head, **{name: getattr(self, name).ravel() for name in names})

    def to_bytes(self) -> bytes:
        """The take as a file, an archive of arrays (.npz)."""
        arrays = {one.name: getattr(self, one.name) for one in fields(self)}
        arrays |= {name: np.diff(arrays[name], axis=0, prepend=np.int16(0)) for name in ("moved", "worn")}
        file = io.BytesIO()
        np.savez_compressed(file, **arrays)
        return file.getvalue()

    @classmethod
    def from_bytes(cls, data: bytes) -> LiveTake:
        """The take of a file; raises ValueError for another one."""
        try:
            with np.load(io.BytesIO(data), allow_pickle=False) as file:
                _check_sizes(file.zip)
                arrays: dict[str, Any] = {one.name: file[one.name] for one in fields(cls)}
        except (KeyError, OSError, zipfile.BadZipFile, EOFError) as error:
            raise ValueError(str(error)) from error
        for name in ("moved", "worn"):
            arrays[name] = np.cumsum(arrays[name], axis=0, dtype=np.int16)
        take = cls(**arrays)
        take._check()
        return take

    def _check(self) -> None:
        """Raises ValueError where arrays do not fit one another."""
        count, vertices = len(self.steps), self.points.size
        shapes = {name: getattr(self, name).shape for name in ("heads", "trunks", "moved", "worn", "before")}
        rods = vertices / (3 * max(self.along.size, 1))
        fits = (
            shapes["heads"] == (count, 12)
            and shapes["trunks"] == (count, 3)
            and shapes["moved"] == (count, vertices)
            and len(shapes["worn"]) == len(shapes["before"]) == 2
            and shapes["worn"][0] == count
            and shapes["before"][1] == 15
            and self.axis.size == 3 * rods == 3 * self.rise.size
            and self.ids.shape == self.carrier.shape
            and (self.carrier < rods).all()
            and count > 0
            and (np.diff(self.steps, prepend=-1) > 0).all()
            and self.steps[-1] < MOST_STEPS
        )
        finite = all(np.isfinite(getattr(self, one.name)).all() for one in fields(self))
        if not fits or not finite or not self.fps > 0.0:
            raise ValueError("its arrays do not fit one another")


def _parts(places: Array, unit: float) -> NDArray[np.int16]:
    """Places in whole parts of a length, a row for each step."""
    parts = np.rint(places / max(unit, 1e-12)).astype(np.int16)
    return parts.reshape(len(parts), -1)


def _check_sizes(file: zipfile.ZipFile) -> None:
    """Raises ValueError for an archive that would fill the memory."""
    if (size := sum(one.file_size for one in file.infolist())) > MOST_BYTES:
        raise ValueError(f"it has {size} bytes, must have at most {MOST_BYTES}")
