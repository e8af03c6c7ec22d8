"""Scenes in which bodies close on hair, and a table of what they do to it.

python tools/proof/pinches.py
"""

from __future__ import annotations

import time
from dataclasses import dataclass, field

import numpy as np
from coils import helix
from crossings import Judge
from numpy.typing import NDArray
from surfaces import sphere

from ringlet import Body, Contact, Curves, Material, Scene, Solver, Strands

FRAME = 1 / 24  # s
GRAVITY = (0.0, -9.81, 0.0)
RADIUS = 0.08  # of a head [m]
NEAR = 25  # locks on the side of the head that a ball goes into; as many are on the other side


@dataclass
class Played:
    """What a scene did, frame by frame; ``crossings`` of all its moves by ipctk."""

    positions: list[NDArray[np.float64]] = field(default_factory=list)
    lag: list[float] = field(default_factory=list)
    stretch: list[float] = field(default_factory=list)
    speed: list[float] = field(default_factory=list)
    seconds: list[float] = field(default_factory=list)
    crossings: int = 0


def play(scene: Scene, motion, frames: int, newton: int, after: int = 0) -> Played:
    """``motion`` gives the targets of strands and bodies at a frame; the first is that after ``after``."""
    played, judge = Played(), Judge(scene)
    scene.record()
    for frame in range(after + 1, frames + 1):
        targets, bodies = motion(frame)
        start, before = scene.positions.copy(), time.perf_counter()
        report, of_strands = scene.step(targets, FRAME, bodies=bodies, gravity=GRAVITY, solver=Solver(newton=newton))
        played.seconds.append(time.perf_counter() - before)
        played.positions.append(scene.strands.positions.copy())
        played.lag.append(report["lag"])
        played.stretch.append(float(of_strands["max_stretch"].max()))
        played.speed.append(float(np.abs(scene.strands.velocities).max()))
        played.crossings += judge.crossings_of_step(start, scene.path)
    return played


def jaws(frames: int = 24) -> Played:
    """Four coils between two jaws that close until they have passed each other."""
    curves = Curves.from_list([helix(60) + [0.012 * k, 0.0, 0.0] for k in range(4)])
    points, triangles = sphere(0.03, 10, 16)
    begin = [points + [0.018, -0.015, side * 0.045] for side in (1.0, -1.0)]
    scene = Scene(Strands(curves, Material(), 4), [Body(jaw, triangles) for jaw in begin], Contact(radius=5e-4))
    return play(scene, lambda k: (None, [begin[0] - [0, 0, 4e-3 * k], begin[1] + [0, 0, 4e-3 * k]]), frames, 3)


def ball(moves: str | None, frames: int = 30, broken_off: int = 0) -> Played:
    """A head with coils on both sides nods; a ball goes into it through those of one side, and leaves.

    moves:      ``"with the head"``, ``"by itself"``, or None without the ball
    broken_off: the frame after which another scene goes on from the memory of the first; 0: none does
    """
    head, triangles = sphere(RADIUS, 14, 22)
    points, faces = sphere(0.05, 10, 16)
    curves = _coils_on_both_sides()
    bodies = [Body(head, triangles), *([Body(points + [0.3, 0.0, 0.0], faces)] if moves else [])]

    def scene():
        strands = Strands(curves, Material(bend_scale=6.0, damping=0.004), 3)
        return Scene(strands, bodies, Contact(radius=4e-4), np.zeros(len(curves), np.int32))

    def motion(frame):
        shift, angle = np.array([0.0, 0.0, 4e-3 * frame]), 0.2 * np.sin(0.2 * frame)
        at = points + [0.3 - 0.012 * min(frame, 30 - frame), 0.0, 0.0]  # 5 cm inside the head at frame 15
        places = [_turned(at, angle) + shift if moves == "with the head" else at + shift] if moves else []
        return _turned(curves.points, angle) + shift, [_turned(head, angle) + shift, *places]

    if not broken_off:
        return play(scene(), motion, frames, 4)
    before, after = scene(), scene()
    play(before, motion, broken_off, 4)
    after.strands.recall(before.strands.memory)
    after.recall(before.memory)
    return play(after, motion, frames, 4, broken_off)


def _coils_on_both_sides() -> Curves:
    locks, along = [], np.linspace(0.0, 0.06, 40)[:, None]
    wide, turn = 3e-3 * np.clip(along / 0.01, 0.0, 1.0), 2 * np.pi * along / 0.01
    for side in (1.0, -1.0):
        for row in np.linspace(-0.3, 0.3, 5):
            for column in np.linspace(-0.3, 0.3, 5):
                out = np.array([side * np.cos(row) * np.cos(column), np.sin(row), np.sin(column)])
                out /= np.linalg.norm(out)
                across, up = np.cross(out, [0.0, 1.0, 0.0]), np.array([0.0, 1.0, 0.0])
                locks.append((1.02 * RADIUS + along) * out + wide * (np.cos(turn) * across + np.sin(turn) * up))
    return Curves.from_list(locks)


def _turned(points: NDArray[np.float64], angle: float) -> NDArray[np.float64]:
    c, s = np.cos(angle), np.sin(angle)
    return points @ np.array([[c, s, 0.0], [-s, c, 0.0], [0.0, 0.0, 1.0]])


def coil(x: float, z: float) -> NDArray[np.float64]:
    """A hanging coil of 8 cm and 40 vertices."""
    s = np.linspace(0.0, 0.08, 40)
    wide, turn = 4e-3 * np.clip(s / 0.01, 0.0, 1.0), 2 * np.pi * s / 0.012
    return np.c_[x + wide * np.cos(turn), -s, z + wide * np.sin(turn)]


def shaken(locks: list[NDArray[np.float64]], frames: int = 8) -> tuple[Played, Scene]:
    """Locks whose roots are shaken."""
    curves = Curves.from_list(locks)
    scene = Scene(Strands(curves, Material(bend_scale=6.0), 3), contact=Contact(radius=4e-4))
    return play(scene, lambda k: (curves.points + [0.01 * np.sin(0.5 * k), 0.0, 0.0], None), frames, 5), scene


def main() -> None:
    """Prints the table."""
    print("| scene | crossings | lag, most [mm] | frames that lag | strain, worst | after | ms, median | most |")
    print("|---|---|---|---|---|---|---|---|")
    alone = ball(None)
    for name, played in (
        ("jaws that close on four coils for good", jaws()),
        ("a ball into a head, moving with it", ball("with the head")),
        ("the same, moving by itself", ball("by itself")),
    ):
        lag, ms = 1e3 * np.array(played.lag), 1e3 * np.array(played.seconds)
        print(
            f"| {name} | {played.crossings} | {lag.max():.3g} | {(lag > 0).sum()} | {max(played.stretch):.2g} "
            f"| {played.stretch[-1]:.1g} | {np.median(ms):.0f} | {ms.max():.0f} |"
        )
    far = [np.array(played.positions)[:, 40 * NEAR :] for played in (ball("with the head"), ball("by itself"), alone)]
    differ = " and ".join(f"{abs(one - far[2]).max():.3g}" for one in far[:2])
    print(f"\nLocks on the other side of the head differ from those without the ball by {differ} m.")


if __name__ == "__main__":
    main()
