"""Random hairs that fall onto plates."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from ringlet.data.curves import Curves
from ringlet.shot import Material, Solver
from ringlet.shot.contact import Contact
from ringlet.sim import Strands
from ringlet.sim.obstacle import Body
from ringlet.sim.scene import Scene

GRAVITY = (0.0, -9.81, 0.0)
DT = 1 / 24  # [s]
TRIANGLES = np.array(
    [0, 1, 3, 0, 3, 2, 4, 6, 7, 4, 7, 5, 0, 4, 5, 0, 5, 1, 2, 3, 7, 2, 7, 6, 0, 2, 6, 0, 6, 4, 1, 5, 7, 1, 7, 3],
    np.int32,
).reshape(-1, 3)


@dataclass(frozen=True)
class Fall:
    """One to five hairs above a plate without friction: ``hairs`` are held by their first edge, ``plate`` rests."""

    hairs: Curves
    plate: Body
    radius: float  # of contact [m]
    bend_scale: float

    def begin(self, contact: bool = True) -> "Falling":
        """The hairs at rest, with the plate below them or without it."""
        strands = Strands(self.hairs, Material(bend_scale=self.bend_scale, damping=0.02), 2)
        touching = Contact(radius=self.radius, friction=0.0)
        return Falling(strands, Scene(strands, bodies=[self.plate], contact=touching) if contact else None)


@dataclass
class Falling:
    """A fall as it goes on."""

    strands: Strands
    scene: Scene | None

    def play(self, solver: Solver, frames: int, substeps: int = 1) -> NDArray[np.float64]:
        """Where the hairs are after more frames [m], shape (n, 3)."""
        held = self.strands.curves.points
        for _ in range(frames * substeps):
            step = self.strands.step if self.scene is None else self.scene.step
            report = step(held, DT / substeps, gravity=GRAVITY, solver=solver)
            assert not np.any((report if self.scene is None else report[0])["stalled"])
        return self.strands.positions.copy()


def box(centre: NDArray[np.float64], half: tuple[float, float, float], tilt: float) -> Body:
    """A closed box, turned by ``tilt`` [rad] about z."""
    corners = np.array([(x, y, z) for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)]) * half
    turn = np.array([[np.cos(tilt), np.sin(tilt), 0], [-np.sin(tilt), np.cos(tilt), 0], [0, 0, 1]])
    return Body(corners @ turn + centre, TRIANGLES, friction=0.0)


def fall(seed: int) -> Fall:
    """Straight, waved or coiled hairs, soft or stiff, level or tilted, apart from one another and above a plate."""
    random = np.random.default_rng(seed)
    count, points, length = int(random.integers(1, 6)), int(random.integers(12, 40)), random.uniform(0.03, 0.09)
    kind = random.choice(["straight", "waved", "coiled"])
    pitch = random.uniform(0.005, 0.02)
    width = {"straight": 0.0, "waved": random.uniform(2e-4, 2e-3), "coiled": random.uniform(5e-4, 2e-3)}[kind]
    if kind == "coiled":
        points = int(max(points, 10 * length / pitch))
    along = np.linspace(0, length, points)
    wave = width * np.clip(along / 0.005, 0, 1)
    phase = 2 * np.pi * along / pitch
    hair = np.c_[along, wave * np.sin(phase), wave * np.cos(phase) * (kind == "coiled")]
    rise = random.choice([0.0, random.uniform(-0.5, 0.5)])
    hair[:, :2] = hair[:, :2] @ np.array([[np.cos(rise), np.sin(rise)], [-np.sin(rise), np.cos(rise)]])
    radius = float(random.choice([2e-4, 4e-4, 8e-4]))
    gap = radius + width + random.uniform(0.5e-3, 15e-3)
    tilt = float(random.choice([0.0, random.uniform(-0.4, 0.4)]))
    lowest = hair[:, 1].min() - gap - 0.4 * length * abs(np.sin(tilt))
    plate = box(np.array([0.75 * length, lowest - 0.005, 0.0]), (0.5 * length, 0.005, 0.06), tilt)
    hairs = [hair + [0, 0, (k - 0.5 * (count - 1)) * (7e-3 + 2 * width)] for k in range(count)]
    return Fall(Curves.from_list(hairs), plate, radius, 10 ** random.uniform(-1.3, 0.8))


def level_fall(gap: float, bend_scale: float) -> Fall:
    """One level hair ``gap`` [m] above a plate."""
    hair = np.c_[np.linspace(0, 0.06, 16), np.zeros((16, 2))]
    plate = box(np.array([0.038, -gap - 0.005, 0.0]), (0.02, 0.005, 0.02), 0.0)
    return Fall(Curves.from_list([hair]), plate, 4e-4, bend_scale)
