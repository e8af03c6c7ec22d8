"""Sheets of cloth in the scene of ``floor_scene``."""

import numpy as np
from floor_scene import CONTACT, SHOT, floor, groom, still
from ringlet.data.mesh import Mesh
from ringlet.shot import ShotCloth, parse_shot
from ringlet.sim import Garment, Obstacle, simulate


def sheet(cells=8, size=0.08, height=0.02, name="sheet"):
    """A horizontal square sheet over the floor; its subset ``front`` has the triangles at z < 0."""
    at = np.linspace(-size / 2, size / 2, cells + 1)
    x, z = np.meshgrid(at, at, indexing="ij")
    points = np.stack([x, np.full_like(x, height), z], axis=-1).reshape(-1, 3)
    a = (np.arange(cells)[:, None] * (cells + 1) + np.arange(cells)).ravel()
    corner = np.stack([a, a + 1, a + cells + 2, a, a + cells + 2, a + cells + 1], axis=1).reshape(-1, 3)
    front = np.flatnonzero(points[corner, 2].mean(axis=1) < 0)
    stiff = np.clip(points[:, 0] / size + 0.5, 0, 1)[corner]
    return Mesh(name, points, corner.astype(np.int32), regions={"front": front}, maps={"stiff": stiff})


def garment(mesh=None, clip=None, **settings):
    mesh = mesh or sheet()
    return Garment(mesh, clip or still(mesh), ShotCloth(name=mesh.name, file="cloth.usda", **settings))


def simulated(*garments, text=SHOT + CONTACT, obstacles=None, made=None):
    made = made or groom()
    obstacles = [Obstacle(floor(), still(floor()))] if obstacles is None else obstacles
    return simulate(parse_shot(text), made, still(made.scalp), obstacles=obstacles, garments=garments)


LONG = SHOT.replace("12]", "30]") + CONTACT
WEIGHTLESS = SHOT + "[forces]\ngravity = [0, 0, 0]\n" + CONTACT
