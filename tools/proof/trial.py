"""A contact trial: a scene with prescribed motion, stepped while independent judges examine every move."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field, replace

import numpy as np
from crossings import Judge
from linking import closed, linking
from ringlet.shot import Solver
from ringlet.sim.scene import Scene
from surfaces import edges_of

AWAY = 10.0  # [m] distance at which the ends of a strand are joined into a loop


@dataclass
class Trial:
    """A scene and its prescribed motion.

    targets: positions of all strand vertices at a time [s], shape (n, 3) [m]; they apply to prescribed vertices only
    bodies:  points of each body at a time [s]; None: bodies do not move
    scale:   scale of the cloths' rest shapes at a time [s], relative to their meshes; None: 1
    loops:   direction in which the ends of each strand are joined for linking numbers; empty: not counted
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
        """Takes step k = 1, 2 …; returns the report of the scene."""
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
        """The same trial in a frame of reference that moves at ``speed`` [m/s], shape (3,), air included."""
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
        """The same trial with initial strand velocities perturbed by about 10⁻⁶ m/s, larger than rounding."""
        velocities = self.scene.strands.velocities
        velocities += 1e-6 * np.random.default_rng(seed).standard_normal(velocities.shape)
        return self

    def links(self):
        """Linking numbers of all pairs of strands, shape (pairs,)."""
        curves, at = self.scene.strands.curves, self.scene.strands.positions
        strands = [at[curves.offsets[s] : curves.offsets[s + 1]] for s in range(len(curves))]
        loops = [closed(strand, AWAY * direction) for strand, direction in zip(strands, self.loops, strict=False)]
        return np.array([linking(a, b) for k, a in enumerate(loops) for b in loops[:k]])

    def stretch(self):
        """Largest ratio of an edge's length to its rest length; the rest length of a cloth is that of its mesh."""
        curves, at = self.scene.strands.curves, self.scene.strands.positions
        first = np.delete(np.arange(len(at)), curves.offsets[1:] - 1)
        edges = [(np.c_[first, first + 1], at, curves.points)]
        edges += [(edges_of(c.mesh.triangles), c.positions, c.mesh.points) for c in self.scene.cloths]
        lengths = ([np.linalg.norm(x[pair[:, 1]] - x[pair[:, 0]], axis=1) for x in of] for pair, *of in edges)
        return max(float((now / rest).max(initial=0.0)) for now, rest in lengths)


@dataclass
class Outcome:
    """The outcome of a trial.

    crossings:  pairs that passed through each other during any step, counted by the independent judge
    links:      linking numbers of all pairs of strands at the start and at the end, shape (2, pairs)
    stretch:    largest ratio of an edge's length to its rest length
    closest:    smallest gap of a contact pair [m]
    violations: pairs whose motion the filter limited
    contacts:   largest number of contact pairs in a step
    finite:     whether all positions stayed finite
    """

    crossings: int
    links: np.ndarray
    stretch: float
    closest: float
    violations: int
    contacts: int
    finite: bool


def judged_run(trial: Trial, newton: int = 5) -> Outcome:
    """Runs a trial and judges every move of every step."""
    judge, solver, scene = Judge(trial.scene), Solver(newton=newton), trial.scene
    scene.record()
    links, crossings, stretch, finite, reports = trial.links(), 0, 1.0, True, []
    for k in range(1, trial.steps + 1):
        before = scene.positions.copy()
        reports.append(trial.step(k, solver))
        finite = bool(np.isfinite(scene.path).all() and np.isfinite(scene.positions).all())
        if not finite:
            break
        crossings += judge.crossings_of_step(before, scene.path)
        stretch = max(stretch, trial.stretch())
    return Outcome(
        crossings,
        np.array([links, trial.links()]),
        stretch,
        min(report["closest"] for report in reports),
        int(sum(report["violations"] for report in reports)),
        int(max(report["contacts"] for report in reports)),
        finite,
    )
