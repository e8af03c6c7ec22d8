"""What rest shapes keep of hairstyles in contact: none, lofted and equilibrium beside one another.

.venv/bin/python tests/physics/rest_shapes.py [STYLE …] [--locks 100] [--pictures FOLDER] [--head FILE --region NAME]
.venv/bin/python tests/physics/rest_shapes.py [STYLE …] --locks 30 --springs 0.1 0.5 0.72

Every style grows on a head that stands still while the drift is measured: in equilibrium for 10 s, otherwise for 3 s,
when it hangs. Then the head drops by 5 cm in a tenth of a second and the tips go on: for each lock its main frequency
and how far it goes, beside those of the plain shape that hangs as it sags, and of the plain shape without weight, which
looks like the groom. Last, nothing weighs any more for half a second: what lay on the head and was bent too far against
gravity rises. With ``--springs`` only the drop is looked at, in equilibrium with each of these ``rest.spring``.
Not a test: a style takes a minute and more.
"""

from __future__ import annotations

import argparse
import tempfile
import time
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from ringlet.data.groom import Groom
from ringlet.data.mesh import Clip
from ringlet.rest.update import to_curves
from ringlet.shot import Collider, Shot, parse_shot
from ringlet.sim import Motion, Obstacle
from ringlet.sim.nails import held_vertices

import ringlet
from ringlet import _core
from ringlet.rest import solve_rest_shape

Array = NDArray[np.float64]

HEAD = Path(__file__).parents[2] / "examples" / "child" / "head.usdc"
TIE, IN_TIE = np.array([0.0, 0.44, -0.102]), 0.02  # of the bun, on the example head, and how far its nails reach [m]
MODES = ("none", "lofted", "equilibrium")
HANGS = 3.0  # what does not stay has sagged by then [s]
FPS, FINE = 24.0, 96.0  # steps a second for the drift and for the bounce
WEIGHTLESS = 0.5  # so long nothing weighs [s]
DROP, FALL, SWING = 0.05, 0.1, 1.2  # how far [m] and how long [s] the head drops, and how long tips are looked at [s]

BASE = """
ringlet = 1
seed = 7
unit = "cm"
[scalp]
file = "{head}"
{mesh}region = "{region}"
[guides]
count = 110
length = {{ value = {length}, vary = 0.08, noise = 0.13, noise_size = 4 }}
lift = {{ value = {lift}, noise = 0.12 }}
droop = {droop}
zone = [{{ toward = [0, 0.4, 1], spread = 50, length = 0.5, lift = 0.85, droop = 1.6 }}]
[locks]
count = {locks}
points = {points}
[[shape]]
op = "scraggle"
amount = 0.5
size = 3
{more}
[hairs]
per_lock = 60
radius = "3.4 mm"
spread = "9 mm"
"""

CURL = "[curl]\nwidth = {}\ncurls = {{ value = {}, vary = 0.1 }}\n"
BUN = """
[[shape]]
op = 'gather'
tie = 'bun'
radius = 1.5
rise = 0.2
[curves.bun]
points = [[0, 44, -10.2], [0, 46, -12], [2, 45, -13.5], [1, 43, -13.5], [-1, 43, -12.5], [-1, 45, -12]]
"""
STYLES = {
    "demo": {"length": 8.4, "lift": 0.86, "droop": 0.48, "points": 72, "more": CURL.format(1.12, 6)},
    "afro 4A": {"length": 5, "lift": 0.9, "droop": 0.2, "points": 96, "more": CURL.format(0.5, 9)},
    "long 3B": {"length": 20, "lift": 0.4, "droop": 2.6, "points": 96, "more": CURL.format(1.5, 8)},
    "down": {"length": 17, "lift": 0.3, "droop": 2.2, "points": 72, "more": CURL.format(0.8, 6)},
    "lying": {"length": 9, "lift": 0.02, "droop": 3, "points": 72, "more": CURL.format(0.15, 6)},
    "bun": {"length": 20, "lift": 0.3, "droop": 1.0, "points": 72, "more": BUN + CURL.format(0.3, 6)},
}

SHOT = """
ringlet = 1
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
parting_speed = 0
"""
LYING = Collider(thickness=2e-3)  # as far as grooms keep from the skin


@dataclass
class Style:
    """A groom on its head, simulated from one rest shape after the other."""

    groom: Groom

    def shot(self, mode: str, gravity: float = -9.81, spring: float | None = None) -> Shot:
        more = "" if spring is None else f"\nspring = {spring}"
        return parse_shot(SHOT.format(mode=f'"{mode}"{more}', gravity=gravity))

    def head(self, heights: Array, fps: float) -> Obstacle:
        """The head as it moves up and down: how much higher it is frame by frame [m]."""
        scalp = self.groom.scalp
        moving = np.asarray(scalp.points) + heights[:, None, None] * [0.0, 1.0, 0.0]
        return Obstacle(scalp, Clip(np.arange(len(heights)) + 1.0, moving, fps), LYING)

    def start(self, shot: Shot, rest: ringlet.Curves | None, head: Obstacle) -> Motion:
        return Motion(shot, self.groom, head.clip, rest, [head], [], 1.0)

    def still(self, shot: Shot, rest: ringlet.Curves | None, seconds: float) -> Iterator[Array]:
        """Where the locks are while the head stands still, step by step."""
        motion = self.start(shot, rest, self.head(np.zeros(1), FPS))
        for _ in range(round(seconds * FPS)):
            motion.advance(1, 1)
            yield motion.strands.positions

    def bounce(self, shot: Shot, rest: ringlet.Curves | None, begin: Array) -> tuple[Array, Array]:
        """How often the tips go up and down [1/s] and how far from where they began [m], seen from the head."""
        part = np.clip(np.arange(round(SWING * FINE) + 1) / (FINE * FALL), 0, 1)
        height = -DROP * part**2 * (3 - 2 * part)
        motion, tips = self.start(shot, rest, self.head(height, FINE)), self.groom.locks.offsets[1:] - 1
        motion.strands.place(begin)
        up = []
        for k in range(1, len(height)):
            motion.advance(k, k + 1)
            up.append(motion.strands.positions[tips, 1] - begin[tips, 1] - height[k])
        up = np.array(up)
        fade = np.hanning(2 * len(up))[len(up) :, None]
        spectrum = np.abs(np.fft.rfft((up - up.mean(axis=0)) * fade, 16 * len(up), axis=0))
        return np.fft.rfftfreq(16 * len(up), 1 / FINE)[spectrum.argmax(axis=0)], np.abs(up).max(axis=0)

    def weightless(self, mode: str, rest: ringlet.Curves | None) -> Array:
        """Where the locks are when nothing has weighed for a while."""
        *_, end = self.still(self.shot(mode, 0.0), rest, WEIGHTLESS)
        return end

    def lying(self) -> NDArray[np.bool_]:
        """The vertices that touch the head, shape (n,), but those that are held."""
        scalp, locks = self.groom.scalp, self.groom.locks
        reach = LYING.thickness + self.shot("none").contact.radius
        _, _, distance = _core.bind_roots(
            np.asarray(scalp.points, np.float64), scalp.triangles, np.asarray(locks.points, np.float64)
        )
        return (distance < reach) & ~held_vertices(locks, self.shot("none").held)


def grown(name: str, locks: int, head: Path, region: str) -> Style:
    """The groom of a style."""
    mesh = 'mesh = "/child/skin"\n' if head == HEAD else ""
    with tempfile.TemporaryDirectory() as folder:
        recipe = Path(folder) / "style.recipe.toml"
        recipe.write_text(BASE.format(head=head.as_posix(), mesh=mesh, region=region, locks=locks, **STYLES[name]))
        groom = ringlet.build_groom(recipe)
    if name == "bun":
        inside = np.linalg.norm(groom.locks.points - TIE, axis=1) < IN_TIE
        groom.locks.point["nail"] = inside.astype(np.float32)
    return Style(groom)


def table(name: str, style: Style, seconds: float, picture: Path | None) -> None:
    """Prints the rows of a style, one for each kind of rest shape."""
    groomed, ends, swings = np.asarray(style.groom.locks.points, np.float64), {}, {}
    lying, risen = style.lying(), {}
    for mode in MODES:
        shot, began = style.shot(mode), time.process_time()
        made = None if mode == "none" else solve_rest_shape(shot, style.groom, obstacles=[style.head(np.zeros(1), FPS)])
        took = time.process_time() - began
        rest = made and to_curves(made, shot)
        for points in style.still(shot, rest, seconds if mode == "equilibrium" else min(seconds, HANGS)):
            ends[mode] = points.copy()
        off = np.linalg.norm(ends[mode] - groomed, axis=1)
        if mode != "lofted":
            swings[mode] = style.bounce(shot, rest, ends[mode])
        if rest is not None and lying.any():
            risen[f"{mode}, weightless"] = style.weightless(mode, rest)
            remembered = 1e3 * np.linalg.norm(rest.points - groomed, axis=1)[lying].mean()
            print(
                f"{name}, {mode}: {lying.mean():.2%} lie on the head, and remember {remembered:.3g} mm away", flush=True
            )
        stiffened = 0 if made is None or made.stiffened is None else int((made.stiffened > 1).sum())
        away = 0.0 if rest is None else np.linalg.norm(rest.points - groomed, axis=1).mean()
        columns = [1e3 * off.mean(), *(1e6 * np.percentile(off, [99, 100])), 1e3 * away, took]
        print(f"| {name} | {mode} |", *(f"{value:.3g} |" for value in columns), f"{stiffened} |", flush=True)
    swings["weightless"] = style.bounce(style.shot("none", 0.0), None, groomed)
    for plain in ("none", "weightless"):
        ratios = (mine / theirs for mine, theirs in zip(swings["equilibrium"], swings[plain], strict=True))
        often, far = (float(np.median(ratio)) for ratio in ratios)
        print(f"{name}, bounce beside {plain}: frequency x {often:.2f}, amplitude x {far:.2f}", flush=True)
    for told, points in risen.items():
        rise = 1e3 * np.linalg.norm(points - groomed, axis=1)[lying].mean()
        print(f"{name}, {told}: what lay on the head is {rise:.3g} mm away", flush=True)
    if picture is not None:
        draw(name, style.groom, {"groomed": groomed, **ends}, picture)
        if risen:
            draw(f"{name} weightless", style.groom, {"groomed": groomed, **risen}, picture)


def springs(name: str, style: Style, values: list[float], seconds: float) -> None:
    """Prints how the tips swing in equilibrium, beside the plain shape without weight, for each value of `spring`.

    The frequency of the slowest tenth of the locks, of the median and of the fastest tenth; the median of how far they
    go; how many times stiffer locks become on average.
    """
    groomed, cells = np.asarray(style.groom.locks.points, np.float64), []
    plainly, so_far = style.bounce(style.shot("none", 0.0), None, groomed)
    for spring in values:
        shot = style.shot("equilibrium", spring=spring)
        made = solve_rest_shape(shot, style.groom, obstacles=[style.head(np.zeros(1), FPS)])
        rest = to_curves(made, shot)
        *_, begin = style.still(shot, rest, seconds)
        often, far = style.bounce(shot, rest, begin.copy())
        often = ", ".join(f"{ratio:.2f}" for ratio in np.percentile(often / plainly, [10, 50, 90]))
        cells.append(f"{often}; {np.median(far / so_far):.2f}; {made.stiffened.mean():.3g}")
    print(f"| {name} |", *(f"{cell} |" for cell in cells), flush=True)


def draw(name: str, groom: Groom, shapes: dict[str, Array], folder: Path) -> None:
    """The groom and what becomes of it, on one page."""
    from ringlet import picture

    hairs = ringlet.build_hairs(groom)
    drawn = {told: hairs.curves.with_points(hairs.at(points, groom.scalp.points)) for told, points in shapes.items()}
    head = [picture.PosedBody(groom.scalp, groom.scalp.points)]
    folder.mkdir(parents=True, exist_ok=True)
    picture.compare(drawn, head, folder / f"rest_{name.replace(' ', '_')}.png", title="")


if __name__ == "__main__":
    reader = argparse.ArgumentParser()
    reader.add_argument("styles", nargs="*", default=list(STYLES))
    reader.add_argument("--locks", type=int, default=100)
    reader.add_argument("--seconds", type=float, default=10.0)
    reader.add_argument("--pictures", type=Path)
    reader.add_argument("--head", type=Path, default=HEAD)
    reader.add_argument("--region", default="scalp")
    reader.add_argument("--springs", type=float, nargs="+", metavar="SPRING")
    asked = reader.parse_args()
    if asked.springs:
        print("| style |", *(f"spring = {spring} |" for spring in asked.springs))
    else:
        columns = "away, mean [mm] | 99 % [µm] | most [µm] | rest from groom, mean [mm] | CPU [s] | stiffer"
        print(f"| style | rest | {columns} |")
    for name in asked.styles or STYLES:
        style = grown(name, asked.locks, asked.head, asked.region)
        if asked.springs:
            springs(name, style, asked.springs, asked.seconds)
        else:
            table(name, style, asked.seconds, asked.pictures)
