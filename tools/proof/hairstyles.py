"""Hairstyles on the example head, with which rest shapes are compared."""

from __future__ import annotations

import tempfile
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from ringlet.data.groom import Groom
from ringlet.data.mesh import Clip
from ringlet.shot import Collider, Shot, parse_shot
from ringlet.sim import Motion, Obstacle
from ringlet.sim.hair_pins import held_vertices

import ringlet
from ringlet import _core

Array = NDArray[np.float64]

HEAD = Path(__file__).parents[2] / "examples" / "child" / "head.usdc"
TIE, IN_TIE = np.array([0.0, 0.44, -0.102]), 0.02  # [m] centre of the bun on the example head, and reach of its pins
MODES = ("none", "lofted", "equilibrium")
SAG_TIME = 3.0  # [s] by then a lock without equilibrium has sagged
FPS, BOUNCE_FPS = 24.0, 96.0  # [1/s] step rates of the drift and of the bounce
WEIGHTLESS = 0.5  # [s] duration without gravity
DROP, DROP_TIME, BOUNCE_TIME = 0.05, 0.1, 1.2  # drop [m], its duration [s], and the duration of the measurement [s]

BASE = """
ringlet = 2
seed = 7
unit = "cm"
[scalp]
file = "{head}"
{mesh}region = "{region}"
[guides]
count = 110
length = {{ value = {length}, vary = 0.08, noise = 0.13, noise_wavelength = 4 }}
lift = {{ value = {lift}, noise = 0.12 }}
gravity_bend = {gravity_bend}
zone = [{{ toward = [0, 0.4, 1], angle = 50, length = 0.5, lift = 0.85, gravity_bend = 1.6 }}]
[locks]
count = {locks}
points = {points}
[[shape]]
op = "scraggle"
magnitude = 0.5
wavelength = 3
{more}
[hairs]
per_lock = 60
lock_radius = "3.4 mm"
root_radius = "9 mm"
"""

PITCH = "[curl]\nwidth = 0.3\npitch = { value = 3.3, vary = 0.1 }\n"  # of the bun, whose curls begin at its tie
CURL = "[curl]\nwidth = {}\ncurls = {{ value = {}, vary = 0.1 }}\n"
BUN = """
[[shape]]
op = 'tie'
curve = 'bun'
radius = 1.5
rise = 0.2
[curves.bun]
points = [[0, 44, -10.2], [0, 46, -12], [2, 45, -13.5], [1, 43, -13.5], [-1, 43, -12.5], [-1, 45, -12]]
"""
STYLES = {
    "demo": {"length": 8.4, "lift": 0.86, "gravity_bend": 0.48, "points": 72, "more": CURL.format(1.12, 6)},
    "afro 4A": {"length": 5, "lift": 0.9, "gravity_bend": 0.2, "points": 96, "more": CURL.format(0.5, 9)},
    "long 3B": {"length": 20, "lift": 0.4, "gravity_bend": 2.6, "points": 96, "more": CURL.format(1.5, 8)},
    "down": {"length": 17, "lift": 0.3, "gravity_bend": 2.2, "points": 72, "more": CURL.format(0.8, 6)},
    "lying": {"length": 9, "lift": 0.02, "gravity_bend": 3, "points": 72, "more": CURL.format(0.15, 6)},
    "bun": {"length": 20, "lift": 0.3, "gravity_bend": 1.0, "points": 72, "more": BUN + PITCH},
}

SHOT = """
ringlet = 2
groom = "style.recipe.toml"
frames = [1, 2]
preroll = 0
[strands]
bend_scale = 6
damping = 0.004
[rest]
mode = {mode}
[forces]
gravity = [0, {gravity}, 0]
[contact]
radius = 4e-4
separation_speed = 0
"""
SKIN = Collider(thickness=2e-3)  # distance of grooms from the skin


@dataclass
class Style:
    """A groom on its head, simulated from given rest shapes."""

    groom: Groom

    def shot(self, mode: str, gravity: float = -9.81, spring: float | None = None) -> Shot:
        more = "" if spring is None else f"\nspring = {spring}"
        return parse_shot(SHOT.format(mode=f'"{mode}"{more}', gravity=gravity))

    def head(self, heights: Array, fps: float) -> Obstacle:
        """The head in vertical motion; ``heights``: its displacement in each frame [m]."""
        scalp = self.groom.scalp
        moving = np.asarray(scalp.points) + heights[:, None, None] * [0.0, 1.0, 0.0]
        return Obstacle(scalp, Clip(np.arange(len(heights)) + 1.0, moving, fps), SKIN)

    def motion(self, shot: Shot, rest: ringlet.Curves | None, head: Obstacle) -> Motion:
        return Motion(shot, self.groom, head.clip, rest, [head], [], 1.0)

    def at_rest(self, shot: Shot, rest: ringlet.Curves | None, seconds: float) -> Iterator[Array]:
        """Positions of the locks in each step while the head stands still."""
        motion = self.motion(shot, rest, self.head(np.zeros(1), FPS))
        for _ in range(round(seconds * FPS)):
            motion.advance(1, 1)
            yield motion.strands.positions

    def bounce(self, shot: Shot, rest: ringlet.Curves | None, begin: Array) -> tuple[Array, Array]:
        """Dominant frequency [1/s] and amplitude [m] of each tip relative to the head after the drop."""
        fraction = np.clip(np.arange(round(BOUNCE_TIME * BOUNCE_FPS) + 1) / (BOUNCE_FPS * DROP_TIME), 0, 1)
        height = -DROP * fraction**2 * (3 - 2 * fraction)
        motion, tips = self.motion(shot, rest, self.head(height, BOUNCE_FPS)), self.groom.locks.offsets[1:] - 1
        motion.strands.place(begin)
        motion.scene.place()
        up = []
        for k in range(1, len(height)):
            motion.advance(k, k + 1)
            up.append(motion.strands.positions[tips, 1] - begin[tips, 1] - height[k])
        up = np.array(up)
        fade = np.hanning(2 * len(up))[len(up) :, None]
        spectrum = np.abs(np.fft.rfft((up - up.mean(axis=0)) * fade, 16 * len(up), axis=0))
        return np.fft.rfftfreq(16 * len(up), 1 / BOUNCE_FPS)[spectrum.argmax(axis=0)], np.abs(up).max(axis=0)

    def weightless(self, mode: str, rest: ringlet.Curves | None) -> Array:
        """Positions of the locks after ``WEIGHTLESS`` seconds without gravity."""
        *_, end = self.at_rest(self.shot(mode, 0.0), rest, WEIGHTLESS)
        return end

    def on_head(self) -> NDArray[np.bool_]:
        """Marks the free vertices that touch the head, shape (n,)."""
        scalp, locks = self.groom.scalp, self.groom.locks
        reach = SKIN.thickness + self.shot("none").contact.radius
        _, _, distance = _core.bind_roots(
            np.asarray(scalp.points, np.float64), scalp.triangles, np.asarray(locks.points, np.float64)
        )
        return (distance < reach) & ~held_vertices(locks, self.shot("none").held)


def make_style(name: str, locks: int, head: Path, region: str) -> Style:
    """Grows the groom of a style."""
    mesh = 'mesh = "/child/skin"\n' if head == HEAD else ""
    with tempfile.TemporaryDirectory() as folder:
        recipe = Path(folder) / "style.recipe.toml"
        recipe.write_text(BASE.format(head=head.as_posix(), mesh=mesh, region=region, locks=locks, **STYLES[name]))
        groom = ringlet.build_groom(recipe)
    if name == "bun":
        inside = np.linalg.norm(groom.locks.points - TIE, axis=1) < IN_TIE
        groom.locks.point["pin"] = inside.astype(np.float32)
    return Style(groom)
