"""Scenes that provoke strands, cloths and bodies to pass through one another; `contact.py` prints the table."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from coils import coiled, helix, rotation
from ringlet.data.curves import Curves
from ringlet.shot import Material
from ringlet.shot.cloth import ClothMaterial
from ringlet.shot.contact import Contact
from ringlet.sim import Strands
from ringlet.sim.cloth import Cloth
from ringlet.sim.obstacle import Body
from ringlet.sim.scene import Scene
from surfaces import as_mesh, band, rod, sheet, sphere
from trial import Trial

FRAME = 1 / 24
UP, SIDE = np.array([0.0, 1, 0]), np.array([1.0, 0, 0])
HEAD = 0.1  # [m] radius


def both_ends(strands, count=3):
    """Marks the first and last ``count`` vertices of each strand, shape (n,)."""
    return np.concatenate([np.minimum(k := np.arange(len(p)), k[::-1]) < count for p in strands])


def hooked_strands():
    """Two hooked U-shaped strands, pulled apart at 5 m/s to twice their length."""
    legs, turn = np.linspace(0.04, 0, 15)[:-1], np.linspace(0, np.pi, 13)
    u = np.concatenate([
        np.c_[np.full(14, -0.01), legs, 0 * legs],
        np.c_[-0.01 * np.cos(turn), -0.01 * np.sin(turn), 0 * turn],
        np.c_[np.full(14, 0.01), legs[::-1], 0 * legs],
    ])  # fmt: skip
    other = np.c_[0 * u[:, 0], -0.014 - u[:, 1], u[:, 0]]
    scene = Scene(Strands(Curves.from_list([u, other]), Material(), both_ends([u, other])))
    rest, up = scene.strands.curves.points, np.repeat([[0.0, 1, 0], [0, -1, 0]], len(u), axis=0)
    return Trial(scene, FRAME / 8, 16, lambda t: rest + 0.5 * 5.0 * min(t, 0.02) * up, loops=[UP, -UP])


def chain_of_loops():
    """Five interlinked loops, each prescribed at one place, shaken at up to 2 m/s."""
    turn = np.linspace(0, 2 * np.pi, 41)
    ring = 0.01 * np.c_[np.sin(turn), np.cos(turn), 0 * turn]
    loops = [ring[:, [0, 2, 1] if k % 2 else [0, 1, 2]] + [0.013 * k, 0, 0] for k in range(5)]
    scene = Scene(Strands(Curves.from_list(loops), Material(), both_ends(loops)), contact=Contact(radius=2.5e-4))
    rest, place = scene.strands.curves.points, np.repeat(np.arange(5), len(turn))[:, None]

    def shaken(t):
        return rest + 0.005 * np.sin(400 * t) * (-1.0) ** place * np.array([0.8, 0.5, 0.3])

    return Trial(scene, FRAME / 10, 60, shaken, loops=5 * [0 * UP])


def wound_coils():
    """Two coils wound six times around each other, pulled apart sideways at 2 m/s."""
    first = helix(73, radius=5e-3, pitch=8e-3)
    second = first @ rotation(UP, np.pi).T
    scene = Scene(Strands(Curves.from_list([first, second]), Material(), both_ends([first, second])))
    rest, side = scene.strands.curves.points, np.repeat([[1.0, 0, 0], [-1, 0, 0]], len(first), axis=0)
    return Trial(scene, FRAME / 4, 20, lambda t: rest + 0.5 * 2.0 * min(t, 0.05) * side, loops=[SIDE, -SIDE])


def knotted_coils():
    """Two coils tied into each other with alternating crossings, pulled tight at 1 m/s."""
    width, reach, leg = 0.01, 0.012, 0.045
    half = np.array([[-leg, 0.5], [-2 * reach, 0.5], [-reach, 0.6], [0.0, 1.0], [0.8 * reach, 1.3], [reach, 0.5]])
    x, y = np.r_[half[:, 0], half[::-1, 0]], width * np.r_[half[:, 1], -half[::-1, 1]]
    over = 4e-3 * np.array([0, 0, 1, -1, 0, 1, -1, 0, 1, -1, 0, 0])  # alternates at the crossings with the other coil
    first = coiled(np.c_[x, y, over], radius=1.2e-3, pitch=4e-3)
    second = coiled(np.c_[-x, -y, over], radius=1.2e-3, pitch=4e-3)
    scene = Scene(
        Strands(Curves.from_list([first, second]), Material(), both_ends([first, second])), contact=Contact(radius=2e-4)
    )
    rest, side = scene.strands.curves.points, np.repeat([-SIDE, SIDE], len(first), axis=0)
    return Trial(scene, FRAME / 4, 24, lambda t: rest + 0.5 * 1.0 * min(t, 0.1) * side, loops=[-SIDE, SIDE])


def thrown(strands, moving, held, bodies=()):
    """The first ``moving`` vertices move down at 20 m/s; the prescribed ones stop 5 cm below."""
    scene = Scene(Strands(Curves.from_list(strands), Material(), held), bodies)
    rest = scene.strands.curves.points
    falls = (np.arange(len(rest)) < moving)[:, None] * -UP
    scene.strands.velocities[:] = 20.0 * falls
    return Trial(scene, FRAME / 4, 20, lambda t: rest + min(20.0 * t, 0.05) * falls)


def onto_a_sheet():
    """A strand at 20 m/s onto an open sheet of two triangles; its root passes beside the sheet."""
    along = np.linspace(0, 0.1, 51)
    strand = np.c_[along, 0.03 + 0 * along, 0.3 * along]
    return thrown([strand], 51, np.arange(51) < 3, [sheet([0.02, 0, -0.1], [0.3, 0, 0], [0, 0, 0.2], 1)])


def onto_a_strand():
    """A strand at 20 m/s onto another whose ends are prescribed."""
    along = np.linspace(0, 0.1, 51)
    strand = np.c_[along, 0.03 + 0 * along, 0 * along]
    other = np.c_[0.06 + 0 * along, 0 * along, along - 0.05]
    held = np.concatenate([np.arange(51) < 3, both_ends([other])])
    return thrown([strand, other], 51, held)


def cloth_thrown(onto, bodies=(), steps=12):
    """A tilted sheet of cloth at 20 m/s onto cloths or bodies below it."""
    mesh = as_mesh(sheet([-0.04, 0.03, -0.04], [0.08, 0.012, 0], [0, 0.005, 0.08], 8))
    cloth = Cloth(mesh, ClothMaterial(thickness=2e-3))
    scene = Scene(cloths=[cloth, *onto], bodies=bodies)
    cloth.velocities[:] = -20.0 * UP
    return Trial(scene, FRAME / 4, steps)


def cloth_onto_cloth():
    """A sheet of cloth at 20 m/s onto another whose corners are pinned."""
    mesh = as_mesh(sheet([-0.06, 0, -0.06], [0.12, 0, 0], [0, 0, 0.12], 9))
    return cloth_thrown([Cloth(mesh, ClothMaterial(thickness=2e-3), [0, 9, 90, 99])])


def cloth_onto_a_body():
    """A sheet of cloth at 20 m/s onto the corner of a block."""
    return cloth_thrown([], bodies=[rod([-0.015, 0.0, -0.03], [0, 0, 0.05], 0.02)])


def strand_onto_cloth():
    """A strand at 20 m/s onto a sheet of cloth with pinned corners; its root passes beside the sheet."""
    along = np.linspace(0, 0.1, 51)
    trial = thrown([np.c_[along - 0.05, 0.03 + 0.1 * along, 0.3 * along]], 51, np.arange(51) < 3)
    mesh = as_mesh(sheet([-0.03, 0, -0.06], [0.12, 0, 0], [0, 0, 0.12], 9))
    cloth = Cloth(mesh, ClothMaterial(thickness=2e-3), [0, 9, 90, 99])
    return replace(trial, scene=Scene(trial.scene.strands, cloths=[cloth]))


def tightened():
    """Seven curls through an elastic ring that shrinks to a quarter of its size."""
    around = np.linspace(0, 2 * np.pi, 7)[:-1]
    middles = np.c_[np.zeros(7), np.zeros(7), np.zeros(7)]
    middles[1:] = 0.011 * np.c_[np.cos(around), 0 * around, np.sin(around)]
    curls = [helix(80, radius=4e-3, pitch=5e-3) + middle for middle in middles]
    mesh = band([0, -0.02, 0], 0.02, 5e-3, 36, 3)
    elastic = ClothMaterial(stretch_warp=100, stretch_weft=100, friction=0.5)
    ring = Cloth(
        mesh, elastic, attachment=np.full(len(mesh.points), 0.05)
    )  # supports its weight until it touches the curls
    ring.scale_rest(0.25)  # activation distances of self-contact follow the smallest size
    scene = Scene(Strands(Curves.from_list(curls), Material(), 3), cloths=[ring], contact=Contact(radius=3e-4))
    return Trial(scene, FRAME / 2, 24, scale=lambda t: max(1.0 - 2.0 * t, 0.25))


def combed():
    """Six curls of type 4A and a comb of 20 rods that is pushed into them and pulled down at 0.5 m/s."""
    curls = [helix(100, radius=2e-3, pitch=2e-3) + [0.008 * k, 0, 0] for k in range(6)]
    rods = [rod([0.0025 * k - 0.004, -0.004, 0.006], [0, 0, 0.04], 4e-4) for k in range(20)]
    points = np.concatenate([body.points for body in rods])
    triangles = np.concatenate([body.triangles + 6 * k for k, body in enumerate(rods)])
    comb = Body(points, triangles, thickness=2e-4, friction=0.2)
    scene = Scene(Strands(Curves.from_list(curls), Material(), 3), [comb], Contact(radius=2e-4))

    def drawn(t):
        into, down = min(0.5 * t, 0.02), max(0.5 * t - 0.02, 0.0)
        return [points - [0, down, into]]

    return Trial(scene, FRAME / 4, 20, None, drawn)


def spun_head():
    """Curls on a head that accelerates to a surface speed of 2 m/s and stops within a step."""
    head, curls = head_of_curls(60, spread=0.03, vertices=120)
    scene = Scene(Strands(Curves.from_list(curls), Material(), 3), [head], rooted_in=np.zeros(len(curls), int))
    rest = scene.strands.curves.points

    def turned(t):
        spin = min(t, 0.25)
        return rotation(UP, 0.5 * (2.0 / HEAD) / 0.25 * spin**2).T

    return Trial(scene, FRAME / 2, 24, lambda t: rest @ turned(t), lambda t: [head.points @ turned(t)])


def run_through(rows=125, columns=201):
    """Curls and a deforming sphere, of 50 000 triangles by default, that flies through them at 20 m/s."""
    points, triangles = sphere(0.03, rows, columns)
    around = np.arctan2(points[:, 2], points[:, 0])

    def moved(t):
        swollen = points * (1.0 + 0.1 * np.sin(5 * around + 600 * t) * (1.0 - (points[:, 1] / 0.03) ** 2))[:, None]
        return [swollen + [20.0 * t - 0.15, -0.04, 0]]

    curls = [helix(100, radius=2e-3, pitch=8e-3) + [0, 0, 0.008 * k - 0.02] for k in range(6)]
    ball = Body(moved(0.0)[0], triangles, friction=0.2)
    scene = Scene(Strands(Curves.from_list(curls), Material(), 3), [ball], Contact(radius=2e-4))
    return Trial(scene, FRAME / 8, 3, None, moved)


def squeezed():
    """Curls between a head and a hand that approaches at 1 m/s to 4 mm from the skin, rests, and leaves."""
    head, curls = head_of_curls(9, spread=0.2)
    hand = sheet([-0.03, -0.03, HEAD + 0.03], [0.06, 0, 0], [0, 0.06, 0], 4)
    scene = Scene(Strands(Curves.from_list(curls), Material(), 3), [head, hand], rooted_in=np.zeros(len(curls), int))

    def moved(t):
        near = min(t, 0.026) - max(t - 0.15, 0.0)
        return [head.points, hand.points - [0, 0, 1.0 * near]]

    return Trial(scene, FRAME / 4, 20, None, moved)


def over_an_edge():
    """A coil on a table, pulled over its sharp edge at 2 m/s."""
    coil = helix(100, radius=3e-3, pitch=6e-3)[:, [1, 0, 2]] + [0.01, 4.5e-3, 0]
    corner = np.array(
        [[0, 0, -0.1], [0, 0, 0.1], [-0.2, 0, 0.1], [-0.2, 0, -0.1], [-0.02, -0.2, 0.1], [-0.02, -0.2, -0.1]]
    )
    table = Body(corner, np.array([[0, 2, 1], [0, 3, 2], [0, 1, 4], [0, 4, 5]]), friction=0.3)
    scene = Scene(Strands(Curves.from_list([coil]), Material(), 3), [table])
    rest = scene.strands.curves.points
    return Trial(scene, FRAME / 4, 24, lambda t: rest - 2.0 * min(t, 0.05) * UP)


def head_of_curls(count, spread=1.0, vertices=60):
    """A spherical head with curls along its normals; ``spread``: covered fraction of the sphere around +z."""
    head = Body(*sphere(HEAD, 16, 24))
    # Fibonacci spiral: uniform over the covered part of the sphere.
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
