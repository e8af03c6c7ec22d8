"""How firmly neighbours hold a lock of live hair, from a short run in contact of a sample of the groom."""

from __future__ import annotations

import hashlib
import os
import pickle
import sys
import threading
import time
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ringlet import sim
from ringlet.data.groom import Groom
from ringlet.data.mesh import Clip, Mesh
from ringlet.data.rigid import in_frame, moved, rotation_matrix
from ringlet.live.live import GRAVITY, Live, default_contact
from ringlet.live.neck import neck
from ringlet.live.rods import VERTICES, Rods
from ringlet.shot.contact import ShotContact
from ringlet.shot.material import Material
from ringlet.shot.shot import Forces, Shot
from ringlet.shot.solver import Solver
from ringlet.sim.core import Vector
from ringlet.sim.cores import Cores

Array = NDArray[np.float64]

SAMPLE = 400  # locks that are neighbours, at most
SETTLING = 6  # frames in contact before the head moves
NOD, TURN = (0.0, 0.4, 0.4), (0.3, 0.5, 0.8)  # begin and length [s], and angle [rad]
ITERATIONS = 6  # of a step in contact
LEAST_SWING = 1e-3  # of tips in contact, below which nothing is found [m]
SOFTEST, FIRMEST = 1e-5, 1e-2  # that is looked for [N/m²]
HALVINGS = 6  # of that range, on a logarithmic scale: to 6 %
POLL = 0.5  # after which a process checks again that its parent is there [s]


@dataclass(frozen=True)
class Calibration:
    """What the contact of live hair is found from; arguments as those of ``Live``.

    touching: the contact of a shot
    """

    groom: Groom
    material: Material
    clothes: Sequence[Mesh]
    gravity: Vector
    fps: float
    touching: ShotContact

    @cached_property
    def key(self) -> str:
        """The same for what gives the same result."""
        locks, arrays = self.groom.locks, hashlib.sha256()
        for array in (locks.points, locks.offsets, *locks.curve.values(), *locks.point.values()):
            arrays.update(np.ascontiguousarray(array).tobytes())
        return repr((arrays.hexdigest(), self.material, self.gravity, self.fps, self.touching))

    def contact(self) -> float:
        """The ``contact`` with which the sample swings as far live as in contact [N/m²]; see ``calibrate``."""
        sample = _sample(self.groom)
        heads = _heads(neck(self.groom), self.fps)
        expected = self._in_contact(sample, heads)
        sample = replace(sample, locks=sample.locks.with_points(expected[0]))
        tips = sample.locks.offsets[1:] - 1
        wanted = _swing(expected[:, tips])
        if wanted < LEAST_SWING:
            return default_contact(self.groom)[0]
        live = Live(sample, self.material, clothes=self.clothes, gravity=self.gravity, fps=self.fps)
        live.trunk = np.eye(4)
        softest, firmest = SOFTEST, FIRMEST
        for _ in range(HALVINGS):
            live.contact = middle = float(np.sqrt(softest * firmest))
            if _swing(_live(live, heads)[:, tips]) > wanted:
                softest = middle
            else:
                firmest = middle
        return float(np.sqrt(softest * firmest))

    def _in_contact(self, sample: Groom, heads: Array) -> Array:
        """The points of a sample in contact, relative to its head, shape (frames, n, 3) [m]."""
        frames = np.arange(1.0, len(heads) + 1.0)
        shot = Shot(
            ringlet=2,
            groom=Path("groom"),
            frames=(1, len(heads)),
            preroll=SETTLING,
            strands=self.material,
            solver=Solver(newton=ITERATIONS),
            forces=Forces(gravity=self.gravity),
            contact=self.touching,
        )
        scalp = sample.scalp
        clip = Clip(frames, moved(np.asarray(scalp.points, np.float64), heads), self.fps)
        obstacles = [sim.Obstacle(scalp, clip)]
        obstacles += [sim.Obstacle(mesh, Clip(frames[:1], mesh.points[None], self.fps)) for mesh in self.clothes]
        points = sim.simulate(shot, sample, clip, obstacles=obstacles).points.astype(np.float64)
        return in_frame(points, heads)


def calibrate(
    groom: Groom,
    material: Material | None = None,
    *,
    clothes: Sequence[Mesh] = (),
    gravity: Vector = GRAVITY,
    fps: float = 24.0,
    touching: ShotContact | None = None,
) -> float:
    """The ``contact`` of ``Live`` with which a sample of its locks swings as far as it does in contact [N/m²].

    Neighbours on one side of the head nod and turn for 0.8 s, once by the steps of a shot in contact, then live.
    Arguments are those of ``Live``, and ``touching`` the contact of a shot. It takes some seconds to some minutes.
    Where tips move by less than a millimetre the default is as good, and is returned.

    Example::

        live.contact = ringlet.calibrate(groom, material)
    """
    material, touching = material or Material(), touching or ShotContact()
    return Calibration(groom, material, tuple(clothes), gravity, fps, touching).contact()


def serve(parent: int) -> None:
    """Reads a pickled ``Calibration`` from the input, and writes its contact to the output, while the parent lives."""
    threading.Thread(target=_end_with, args=(parent,), daemon=True).start()
    with os.fdopen(os.dup(sys.stdout.fileno()), "w") as result:
        os.dup2(sys.stderr.fileno(), sys.stdout.fileno())  # what libraries print is no result
        task: Calibration = pickle.load(sys.stdin.buffer)
        result.write(repr(task.contact()))


def _sample(groom: Groom) -> Groom:
    """Locks that are neighbours, all of one side where there are many."""
    cores = Cores.of(groom)
    middles = Rods.of(cores.groom.locks).points.reshape(-1, VERTICES, 3)[:, VERTICES // 2]
    order = np.argsort(np.linalg.norm(middles - middles[_amid(middles)], axis=1))[:SAMPLE]
    rows = np.flatnonzero(np.isin(cores.simulated, order))
    return replace(groom, locks=groom.locks.take(rows))


def _amid(middles: Array) -> int:
    """The rod in the middle of those on one side of the head, away from the hairline."""
    on_side = middles[middles[:, 0] >= np.median(middles[:, 0])]
    return int(np.linalg.norm(middles - on_side.mean(axis=0), axis=1).argmin())


def _heads(pivot: Array, fps: float) -> Array:
    """The rigid motions of a head that nods and turns, shape (frames, 4, 4)."""
    times = np.arange(0.0, TURN[0] + TURN[1], 1.0 / fps)
    heads = np.tile(np.eye(4), (len(times), 1, 1))
    turns = np.zeros((len(times), 3))
    for axis, (begin, length, angle) in enumerate((NOD, TURN)):
        turns[:, axis] = angle * np.sin(np.pi * np.clip((times - begin) / length, 0.0, 1.0)) ** 2
    for head, turn in zip(heads, turns, strict=True):
        head[:3, :3] = rotation_matrix(turn)
        head[:3, 3] = pivot - head[:3, :3] @ pivot
    return heads


def _live(live: Live, heads: Array) -> Array:
    """The points of live hair, relative to its head, shape (frames, n, 3) [m]."""
    points = []
    live.head = heads[0]
    live.reset()
    for live.head in heads:
        live.step()
        points.append(live.positions)
    return in_frame(np.array(points), heads)


def _swing(tips: Array) -> float:
    """How far the median tip is from where it begins, of tips (frames, count, 3): the root of the mean square [m]."""
    return float(np.sqrt(np.mean(np.median(np.linalg.norm(tips - tips[0], axis=2), axis=1) ** 2)))


def _end_with(parent: int) -> None:
    """Ends this process once the one that started it is gone, also where that was killed."""
    while os.getppid() == parent:
        time.sleep(POLL)
    os._exit(1)
