"""Scenes that try to make things pass through one another. As a program it prints the table of the documents.

python tests/physics/contact_scenes.py [wound_coils …] [--runs 8]
"""

from __future__ import annotations

import argparse
import itertools
from collections.abc import Callable
from dataclasses import dataclass, field, replace

import numpy as np
from coils import helix, rotation
from crossings import Judge
from linking import closed, linking
from ringlet.data.curves import Curves
from ringlet.data.mesh import Mesh
from ringlet.shot import Material, Solver
from ringlet.shot.cloth import ClothMaterial
from ringlet.shot.contact import Contact
from ringlet.sim import Strands
from ringlet.sim.cloth import Cloth
from ringlet.sim.obstacle import Body
from ringlet.sim.scene import Scene
from scipy.interpolate import CubicSpline

FRAME = 1 / 24
AWAY = 10.0  # [m] where the ends of strands are joined to make loops of them


@dataclass
class Play:
    """A scene and what is done to it.

    targets: where all vertices of strands are told to be at a time [s], shape (n, 3) [m]; only held ones follow
    bodies:  where each body's points are at a time [s]; None: they stay
    scale:   how large the rest shapes of cloths are at a time [s], by their meshes; None: as these
    loops:   per strand the direction in which its ends are joined far away, to count linking; None: open
    """

    scene: Scene
    dt: float
    steps: int
    targets: Callable[[float], np.ndarray] | None = None
    bodies: Callable[[float], list[np.ndarray]] | None = None
    scale: Callable[[float], float] | None = None
    loops: list[np.ndarray] = field(default_factory=list)
    gravity: tuple[float, float, float] = (0.0, -9.81, 0.0)
    wind: tuple[float, float, float] = (0.0, 0.0, 0.0)

    def step(self, k, solver):
        """Step k = 1, 2 …; the scene's report."""
        start = self.scene.strands.curves.points
        for cloth in self.scene.cloths if self.scale else ():
            cloth.scale_rest(self.scale(k * self.dt))
        return self.scene.step(
            start if self.targets is None else self.targets(k * self.dt),
            self.dt,
            bodies=None if self.bodies is None else self.bodies(k * self.dt),
            gravity=self.gravity,
            wind=self.wind,
            solver=solver,
        )[0]

    def moved(self, speed):
        """The same while all of it, the air included, moves at a speed [m/s], shape (3,)."""
        rest = self.scene.strands.curves.points
        bodies = [body.points for body in self.scene.bodies]
        targets = self.targets or (lambda _: rest)
        places = self.bodies or (lambda _: bodies)
        return replace(
            self,
            targets=lambda t: targets(t) + speed * t,
            bodies=lambda t: [points + speed * t for points in places(t)],
            wind=tuple(np.add(self.wind, speed)),
        )

    def jittered(self, seed):
        """The same with velocities of strands that differ by about 10⁻⁶ m/s at the start, as rounding might."""
        velocities = self.scene.strands.velocities
        velocities += 1e-6 * np.random.default_rng(seed).standard_normal(velocities.shape)
        return self

    def links(self):
        """Linking numbers of all pairs of strands, shape (pairs,)."""
        curves, at = self.scene.strands.curves, self.scene.strands.positions
        strands = [at[curves.offsets[s] : curves.offsets[s + 1]] for s in range(len(curves))]
        loops = [closed(strand, AWAY * way) for strand, way in zip(strands, self.loops, strict=False)]
        return np.array([linking(a, b) for k, a in enumerate(loops) for b in loops[:k]])

    def stretch(self):
        """The longest edge by its length at rest; of cloths, by that in their meshes."""
        curves, at = self.scene.strands.curves, self.scene.strands.positions
        first = np.delete(np.arange(len(at)), curves.offsets[1:] - 1)
        edges = [(np.c_[first, first + 1], at, curves.points)]
        edges += [(sides_of(c.mesh.triangles), c.positions, c.mesh.points) for c in self.scene.cloths]
        lengths = ([np.linalg.norm(x[pair[:, 1]] - x[pair[:, 0]], axis=1) for x in of] for pair, *of in edges)
        return max(float((now / rest).max(initial=0.0)) for now, rest in lengths)


@dataclass
class Outcome:
    """What became of it.

    crossings:  pairs that passed through each other on the way of any step, as the independent judge sees it
    links:      linking numbers of all pairs of strands at the start, and at the end, shape (2, pairs)
    stretch:    the longest any edge ever was, by its length at rest
    closest:    the least distance of two that touched [m]
    violations: pairs that would have passed through each other, had they not been held back
    contacts:   the most there were at a time
    finite:     whether all positions always were
    """

    crossings: int
    links: np.ndarray
    stretch: float
    closest: float
    violations: int
    contacts: int
    finite: bool


def act(play: Play, newton: int = 5) -> Outcome:
    """Plays it, and looks at every move of every step."""
    judge, solver, scene = Judge(play.scene), Solver(newton=newton), play.scene
    scene.record()
    links, crossings, stretch, finite, reports = play.links(), 0, 1.0, True, []
    for k in range(1, play.steps + 1):
        reports.append(play.step(k, solver))
        finite = bool(np.isfinite(scene.path).all() and np.isfinite(scene.positions).all())
        if not finite:
            break
        crossings += sum(judge.crossings(*move) for move in itertools.pairwise(scene.path))
        stretch = max(stretch, play.stretch())
    return Outcome(
        crossings,
        np.array([links, play.links()]),
        stretch,
        min(report["closest"] for report in reports),
        int(sum(report["violations"] for report in reports)),
        int(max(report["contacts"] for report in reports)),
        finite,
    )


def ends_held(strands, count=3):
    """Of each strand its first and last vertices, shape (n,)."""
    return np.concatenate([np.minimum(k := np.arange(len(p)), k[::-1]) < count for p in strands])


def hooked_strands():
    """Two U-strands hooked into each other, pulled apart at 5 m/s to twice their length."""
    legs, turn = np.linspace(0.04, 0, 15)[:-1], np.linspace(0, np.pi, 13)
    u = np.concatenate([
        np.c_[np.full(14, -0.01), legs, 0 * legs],
        np.c_[-0.01 * np.cos(turn), -0.01 * np.sin(turn), 0 * turn],
        np.c_[np.full(14, 0.01), legs[::-1], 0 * legs],
    ])  # fmt: skip
    other = np.c_[0 * u[:, 0], -0.014 - u[:, 1], u[:, 0]]
    scene = Scene(Strands(Curves.from_list([u, other]), Material(), ends_held([u, other])))
    rest, up = scene.strands.curves.points, np.repeat([[0.0, 1, 0], [0, -1, 0]], len(u), axis=0)
    return Play(scene, FRAME / 8, 16, lambda t: rest + 0.5 * 5.0 * min(t, 0.02) * up, loops=[UP, -UP])


def chain_of_loops():
    """Five interlinked loops, each held at one place, shaken at up to 2 m/s."""
    turn = np.linspace(0, 2 * np.pi, 41)
    ring = 0.01 * np.c_[np.sin(turn), np.cos(turn), 0 * turn]
    loops = [ring[:, [0, 2, 1] if k % 2 else [0, 1, 2]] + [0.013 * k, 0, 0] for k in range(5)]
    scene = Scene(Strands(Curves.from_list(loops), Material(), ends_held(loops)), contact=Contact(radius=2.5e-4))
    rest, place = scene.strands.curves.points, np.repeat(np.arange(5), len(turn))[:, None]

    def shaken(t):
        return rest + 0.005 * np.sin(400 * t) * (-1.0) ** place * np.array([0.8, 0.5, 0.3])

    return Play(scene, FRAME / 10, 60, shaken, loops=5 * [0 * UP])


def wound_coils():
    """Two coils wound six times round each other, torn apart sideways at 2 m/s."""
    first = helix(73, radius=5e-3, pitch=8e-3)
    second = first @ rotation(UP, np.pi).T
    scene = Scene(Strands(Curves.from_list([first, second]), Material(), ends_held([first, second])))
    rest, side = scene.strands.curves.points, np.repeat([[1.0, 0, 0], [-1, 0, 0]], len(first), axis=0)
    return Play(scene, FRAME / 4, 20, lambda t: rest + 0.5 * 2.0 * min(t, 0.05) * side, loops=[SIDE, -SIDE])


def knotted_coils():
    """Two coils tied into each other, over and under in turn, pulled tight at 1 m/s."""
    width, reach, leg = 0.01, 0.012, 0.045
    half = np.array([[-leg, 0.5], [-2 * reach, 0.5], [-reach, 0.6], [0.0, 1.0], [0.8 * reach, 1.3], [reach, 0.5]])
    x, y = np.r_[half[:, 0], half[::-1, 0]], width * np.r_[half[:, 1], -half[::-1, 1]]
    over = 4e-3 * np.array([0, 0, 1, -1, 0, 1, -1, 0, 1, -1, 0, 0])  # where it crosses the other
    first = coiled(np.c_[x, y, over], radius=1.2e-3, pitch=4e-3)
    second = coiled(np.c_[-x, -y, over], radius=1.2e-3, pitch=4e-3)
    scene = Scene(
        Strands(Curves.from_list([first, second]), Material(), ends_held([first, second])), contact=Contact(radius=2e-4)
    )
    rest, side = scene.strands.curves.points, np.repeat([-SIDE, SIDE], len(first), axis=0)
    return Play(scene, FRAME / 4, 24, lambda t: rest + 0.5 * 1.0 * min(t, 0.1) * side, loops=[-SIDE, SIDE])


def thrown(strands, moving, held, bodies=()):
    """The first ``moving`` vertices fly down at 20 m/s; what is held of them stops 5 cm below."""
    scene = Scene(Strands(Curves.from_list(strands), Material(), held), bodies)
    rest = scene.strands.curves.points
    falls = (np.arange(len(rest)) < moving)[:, None] * -UP
    scene.strands.velocities[:] = 20.0 * falls
    return Play(scene, FRAME / 4, 20, lambda t: rest + min(20.0 * t, 0.05) * falls)


def onto_a_sheet():
    """A strand at 20 m/s onto two triangles that have no inside; its root goes past them."""
    along = np.linspace(0, 0.1, 51)
    strand = np.c_[along, 0.03 + 0 * along, 0.3 * along]
    return thrown([strand], 51, np.arange(51) < 3, [sheet([0.02, 0, -0.1], [0.3, 0, 0], [0, 0, 0.2], 1)])


def onto_a_strand():
    """A strand at 20 m/s onto another, which is held at both ends."""
    along = np.linspace(0, 0.1, 51)
    strand = np.c_[along, 0.03 + 0 * along, 0 * along]
    other = np.c_[0.06 + 0 * along, 0 * along, along - 0.05]
    held = np.concatenate([np.arange(51) < 3, ends_held([other])])
    return thrown([strand, other], 51, held)


def cloth_thrown(onto, bodies=(), steps=12):
    """A tilted sheet of cloth flies at 20 m/s onto what is below it."""
    mesh = as_mesh(sheet([-0.04, 0.03, -0.04], [0.08, 0.012, 0], [0, 0.005, 0.08], 8))
    cloth = Cloth(mesh, ClothMaterial(thickness=2e-3))
    scene = Scene(cloths=[cloth, *onto], bodies=bodies)
    cloth.velocities[:] = -20.0 * UP
    return Play(scene, FRAME / 4, steps)


def cloth_onto_cloth():
    """A sheet of cloth at 20 m/s onto another, whose corners are held."""
    mesh = as_mesh(sheet([-0.06, 0, -0.06], [0.12, 0, 0], [0, 0, 0.12], 9))
    return cloth_thrown([Cloth(mesh, ClothMaterial(thickness=2e-3), [0, 9, 90, 99])])


def cloth_onto_a_body():
    """A sheet of cloth at 20 m/s onto the corner of a block."""
    return cloth_thrown([], bodies=[rod([-0.015, 0.0, -0.03], [0, 0, 0.05], 0.02)])


def strand_onto_cloth():
    """A strand at 20 m/s onto a sheet of cloth whose corners are held; its root goes past it."""
    along = np.linspace(0, 0.1, 51)
    play = thrown([np.c_[along - 0.05, 0.03 + 0.1 * along, 0.3 * along]], 51, np.arange(51) < 3)
    mesh = as_mesh(sheet([-0.03, 0, -0.06], [0.12, 0, 0], [0, 0, 0.12], 9))
    cloth = Cloth(mesh, ClothMaterial(thickness=2e-3), [0, 9, 90, 99])
    return replace(play, scene=Scene(play.scene.strands, cloths=[cloth]))


def tightened():
    """Seven curls through a ring of elastic that draws together to a quarter."""
    around = np.linspace(0, 2 * np.pi, 7)[:-1]
    middles = np.c_[np.zeros(7), np.zeros(7), np.zeros(7)]
    middles[1:] = 0.011 * np.c_[np.cos(around), 0 * around, np.sin(around)]
    curls = [helix(80, radius=4e-3, pitch=5e-3) + middle for middle in middles]
    mesh = band([0, -0.02, 0], 0.02, 5e-3, 36, 3)
    elastic = ClothMaterial(stretch_warp=100, stretch_weft=100, friction=0.5)
    ring = Cloth(mesh, elastic, attachment=np.full(len(mesh.points), 0.05))  # it does not fall before it has hold
    ring.scale_rest(0.25)  # as near as it may then come to itself
    scene = Scene(Strands(Curves.from_list(curls), Material(), 3), cloths=[ring], contact=Contact(radius=3e-4))
    return Play(scene, FRAME / 2, 24, scale=lambda t: max(1.0 - 2.0 * t, 0.25))


def combed():
    """Six curls of type 4A and a comb of 20 rods that is pushed into them and drawn down at 0.5 m/s."""
    curls = [helix(100, radius=2e-3, pitch=2e-3) + [0.008 * k, 0, 0] for k in range(6)]
    rods = [rod([0.0025 * k - 0.004, -0.004, 0.006], [0, 0, 0.04], 4e-4) for k in range(20)]
    points = np.concatenate([body.points for body in rods])
    triangles = np.concatenate([body.triangles + 6 * k for k, body in enumerate(rods)])
    comb = Body(points, triangles, thickness=2e-4, friction=0.2)
    scene = Scene(Strands(Curves.from_list(curls), Material(), 3), [comb], Contact(radius=2e-4))

    def drawn(t):
        into, down = min(0.5 * t, 0.02), max(0.5 * t - 0.02, 0.0)
        return [points - [0, down, into]]

    return Play(scene, FRAME / 4, 20, None, drawn)


def spun_head():
    """Curls on a head that spins up to 2 m/s at its surface and stops dead."""
    head, curls = head_of_curls(60, spread=0.03, vertices=120)
    scene = Scene(Strands(Curves.from_list(curls), Material(), 3), [head], rooted_in=np.zeros(len(curls), int))
    rest = scene.strands.curves.points

    def turned(t):
        spin = min(t, 0.25)
        return rotation(UP, 0.5 * (2.0 / HEAD) / 0.25 * spin**2).T

    return Play(scene, FRAME / 2, 24, lambda t: rest @ turned(t), lambda t: [head.points @ turned(t)])


def run_through():
    """Curls and a ball of 50 000 triangles that flies through them at 20 m/s and changes its shape all the way."""
    rows, columns = 125, 201
    points, triangles = sphere(0.03, rows, columns)
    around = np.arctan2(points[:, 2], points[:, 0])

    def moved(t):
        swollen = points * (1.0 + 0.1 * np.sin(5 * around + 600 * t) * (1.0 - (points[:, 1] / 0.03) ** 2))[:, None]
        return [swollen + [20.0 * t - 0.15, -0.04, 0]]

    curls = [helix(100, radius=2e-3, pitch=8e-3) + [0, 0, 0.008 * k - 0.02] for k in range(6)]
    ball = Body(moved(0.0)[0], triangles, friction=0.2)
    scene = Scene(Strands(Curves.from_list(curls), Material(), 3), [ball], Contact(radius=2e-4))
    return Play(scene, FRAME / 8, 3, None, moved)


def squeezed():
    """Curls between a head and a hand that comes at 1 m/s to 4 mm from the skin, stays, and goes."""
    head, curls = head_of_curls(9, spread=0.2)
    hand = sheet([-0.03, -0.03, HEAD + 0.03], [0.06, 0, 0], [0, 0.06, 0], 4)
    scene = Scene(Strands(Curves.from_list(curls), Material(), 3), [head, hand], rooted_in=np.zeros(len(curls), int))

    def moved(t):
        near = min(t, 0.026) - max(t - 0.15, 0.0)
        return [head.points, hand.points - [0, 0, 1.0 * near]]

    return Play(scene, FRAME / 4, 20, None, moved)


def over_an_edge():
    """A coil that lies on a table, drawn over its sharp edge at 2 m/s."""
    coil = helix(100, radius=3e-3, pitch=6e-3)[:, [1, 0, 2]] + [0.01, 4.5e-3, 0]
    corner = np.array(
        [[0, 0, -0.1], [0, 0, 0.1], [-0.2, 0, 0.1], [-0.2, 0, -0.1], [-0.02, -0.2, 0.1], [-0.02, -0.2, -0.1]]
    )
    table = Body(corner, np.array([[0, 2, 1], [0, 3, 2], [0, 1, 4], [0, 4, 5]]), friction=0.3)
    scene = Scene(Strands(Curves.from_list([coil]), Material(), 3), [table])
    rest = scene.strands.curves.points
    return Play(scene, FRAME / 4, 24, lambda t: rest - 2.0 * min(t, 0.05) * UP)


UP, SIDE = np.array([0.0, 1, 0]), np.array([1.0, 0, 0])
HEAD = 0.1  # [m] its radius


def sheet(corner, first, second, squares, **body):
    """squares × squares squares of two triangles each."""
    u, v = (x.ravel()[:, None] for x in np.meshgrid(*2 * [np.linspace(0, 1, squares + 1)], indexing="ij"))
    at = np.arange((squares + 1) ** 2).reshape(squares + 1, -1)
    a, b, c, d = (x.ravel() for x in (at[:-1, :-1], at[1:, :-1], at[1:, 1:], at[:-1, 1:]))
    return Body(corner + u * first + v * second, np.concatenate([np.c_[a, b, c], np.c_[a, c, d]]), **body)


def rod(start, way, radius):
    """A prism of three sides that goes along z."""
    turn = 2 * np.pi * np.arange(3) / 3
    ring = start + radius * np.c_[np.cos(turn), np.sin(turn), 0 * turn]
    sides = [[k, (k + 1) % 3, k + 3, (k + 1) % 3 + 3] for k in range(3)]
    triangles = [[a, b, d] for a, b, c, d in sides] + [[a, d, c] for a, b, c, d in sides] + [[0, 2, 1], [3, 4, 5]]
    return Body(np.concatenate([ring, ring + way]), np.array(triangles))


def sphere(radius, rows, columns):
    """Points and triangles of a ball about the origin."""
    polar, around = np.meshgrid(
        np.linspace(0, np.pi, rows + 1)[1:-1], 2 * np.pi * np.arange(columns) / columns, indexing="ij"
    )
    points = np.c_[
        (np.sin(polar) * np.cos(around)).ravel(), np.cos(polar).ravel(), (np.sin(polar) * np.sin(around)).ravel()
    ]
    points = radius * np.concatenate([points, [UP, -UP]])
    at = np.arange((rows - 1) * columns).reshape(rows - 1, columns)
    a, b, c, d = (x.ravel() for x in (at[:-1], np.roll(at, -1, axis=1)[:-1], np.roll(at, -1, axis=1)[1:], at[1:]))
    top, bottom = len(points) - 2, len(points) - 1
    fans = [
        np.c_[np.full(columns, top), np.roll(at[0], -1), at[0]],
        np.c_[np.full(columns, bottom), at[-1], np.roll(at[-1], -1)],
    ]
    return points, np.concatenate([np.c_[a, b, c], np.c_[a, c, d], *fans])


def as_mesh(body):
    """The surface of a body, to make cloth of."""
    return Mesh("cloth", np.asarray(body.points, float), np.asarray(body.triangles, np.int32))


def band(centre, radius, height, columns, rows):
    """An upright ring of cloth: ``columns`` around, ``rows`` of triangles high."""
    turn, up = np.meshgrid(2 * np.pi * np.arange(columns) / columns, np.linspace(0, height, rows + 1), indexing="ij")
    points = np.c_[radius * np.cos(turn).ravel(), up.ravel(), radius * np.sin(turn).ravel()] + centre
    at = np.arange(len(points)).reshape(columns, rows + 1)
    a, b, c, d = (x.ravel() for x in (at[:, :-1], np.roll(at, -1, 0)[:, :-1], np.roll(at, -1, 0)[:, 1:], at[:, 1:]))
    return Mesh("band", points, np.concatenate([np.c_[a, b, c], np.c_[a, c, d]]).astype(np.int32))


def sides_of(triangles):
    """Every edge of triangles once, shape (k, 2)."""
    return np.unique(
        np.sort(np.concatenate([triangles[:, [0, 1]], triangles[:, [1, 2]], triangles[:, [2, 0]]])), axis=0
    )


def coiled(knots, radius, pitch, per_turn=10):
    """A coil along the smooth curve through points [m], shape (n, 3)."""
    spline = CubicSpline(np.arange(len(knots)), knots)
    fine = np.linspace(0, len(knots) - 1, 4000)
    way = np.r_[0, np.cumsum(np.linalg.norm(np.diff(spline(fine), axis=0), axis=1))]
    at = np.interp(np.arange(0, way[-1], pitch / per_turn), way, fine)
    along = spline(at, 1) / np.linalg.norm(spline(at, 1), axis=1)[:, None]
    out = np.cross(along, [0.0, 0.0, 1.0])
    out /= np.linalg.norm(out, axis=1)[:, None]
    turn = 2 * np.pi * np.arange(len(at))[:, None] / per_turn
    return spline(at) + radius * (np.cos(turn) * out + np.sin(turn) * np.cross(along, out))


def head_of_curls(count, spread=1.0, vertices=60):
    """A ball and curls that stand on it; ``spread``: how far they are around it from +z, 1: all around."""
    head = Body(*sphere(HEAD, 16, 24))
    # Fibonacci's spiral: evenly over the part of the sphere that is left.
    k = np.arange(count) + 0.5
    z, turn = 1 - spread * 2 * k / count, np.pi * (3 - np.sqrt(5)) * k
    out = np.c_[np.sqrt(1 - z**2) * np.cos(turn), np.sqrt(1 - z**2) * np.sin(turn), z]
    coil = helix(vertices, radius=3e-3, pitch=3e-3)
    coil = np.c_[coil[:, 0], coil[:, 2], -coil[:, 1]]  # along +z
    curls = []
    for n in out:
        side = np.cross(n, UP if abs(n[1]) < 0.9 else SIDE)
        side /= np.linalg.norm(side)
        curls.append((HEAD + 1.5e-3) * n + coil @ np.array([side, np.cross(n, side), n]))
    return head, curls


SCENES = {
    make.__name__: make
    for make in (
        hooked_strands,
        chain_of_loops,
        wound_coils,
        knotted_coils,
        onto_a_sheet,
        onto_a_strand,
        strand_onto_cloth,
        cloth_onto_cloth,
        cloth_onto_a_body,
        combed,
        spun_head,
        run_through,
        squeezed,
        tightened,
        over_an_edge,
    )
}


def print_spread(names, runs):
    """Prints how much rounding decides: of runs with a jitter, what passed through and how far they stretched."""
    for name, newton in itertools.product(names, (1, 5)):
        results = [act(SCENES[name]().jittered(seed), newton) for seed in range(1, runs + 1)]
        crossings = sum(result.crossings for result in results)
        unlinked = sum(np.abs(result.links[1] - result.links[0]).max(initial=0.0) > 0.5 for result in results)
        stretches = " ".join(f"{stretch:.3g}" for stretch in sorted(result.stretch for result in results))
        print(f"{name}, newton {newton}: {crossings} crossings, {unlinked} other linkings; stretch {stretches}")


def main():
    """Prints a table in Markdown, of the scenes that are named, or of all."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("scenes", nargs="*", default=list(SCENES))
    parser.add_argument("--runs", type=int, default=0, help="in place of the table, that many runs with a jitter each")
    options = parser.parse_args()
    if options.runs:
        return print_spread(options.scenes, options.runs)
    print("| scene | newton | crossings | linking | worst stretch | closest [mm] | held back | contacts |")
    print("|---|---|---|---|---|---|---|---|")
    for name in options.scenes:
        for newton in (1, 5):
            result = act(SCENES[name](), newton)
            before, after = (" ".join(f"{abs(n):.0f}" for n in links if abs(n) > 0.5) for links in result.links)
            numbers = f"{result.stretch:.3g} | {1e3 * result.closest:.2g} | {result.violations} | {result.contacts}"
            finite = "" if result.finite else ", then NaN"
            linking = f"{before} → {after}" if before or after else "–"
            title = name.replace("_", " ")
            print(f"| {title} | {newton} | {result.crossings}{finite} | {linking} | {numbers} |")


if __name__ == "__main__":
    main()
