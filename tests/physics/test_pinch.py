"""Pinched hair: bodies that close on it cut steps short, and the hair stays calm."""

import numpy as np
from coils import helix
from ringlet.data.curves import Curves
from ringlet.shot.contact import Contact
from ringlet.shot.material import Material
from ringlet.shot.solver import Solver
from ringlet.sim.obstacle import Body
from ringlet.sim.scene import Scene
from ringlet.sim.strands import Strands
from surfaces import sphere

FRAME = 1 / 24
DOWN = (0.0, -9.81, 0.0)
CLOSING = 4e-3  # of each jaw in a frame [m]


def test_coils_between_closing_jaws_are_neither_stretched_nor_thrown():
    """A substep has one length for inertia, targets and velocities, however short the bodies make it."""
    curves = Curves.from_list([helix(60) + [0.012 * k, 0.0, 0.0] for k in range(4)])
    strands = Strands(curves, Material(), 4)
    points, triangles = sphere(0.03, 10, 16)
    jaws = [points + [0.018, -0.015, side * 0.045] for side in (1.0, -1.0)]
    scene = Scene(strands, [Body(jaw, triangles) for jaw in jaws], Contact(radius=5e-4))
    substeps = []
    for frame in range(1, 25):
        ends = [jaw - [0.0, 0.0, side * CLOSING * frame] for jaw, side in zip(jaws, (1.0, -1.0), strict=True)]
        contact, report = scene.step(None, FRAME, bodies=ends, gravity=DOWN, solver=Solver(newton=3))
        substeps.append(contact["substeps"])
        assert report["nan"].sum() == 0
        assert report["max_stretch"].max() < 0.1
        assert np.abs(strands.velocities).max() < 3.0
    assert max(substeps) > 1  # the jaws left no way out
