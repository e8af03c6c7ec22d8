"""Three strands above a floor, and colliders, for tests of contact in shots."""

import numpy as np
from ringlet.data.curves import Curves
from ringlet.data.groom import Groom
from ringlet.data.mesh import Clip, Mesh

from ringlet import _core

SHOT = 'ringlet = 2\ngroom = "groom.usdc"\nframes = [1, 12]\npreroll = 0\n[strands]\nbend_scale = 0.2\n'
CONTACT = "[contact]\nradius = 1e-3\n"
POINTS = 31


def floor():
    """A square of 20 cm in the plane y = 0, facing up."""
    points = 0.1 * np.array([[-1.0, 0, -1], [1, 0, -1], [1, 0, 1], [-1, 0, 1]])
    return Mesh("floor", points, np.array([[0, 2, 1], [0, 3, 2]], np.int32))


def ball(radius=0.01, centre=(0.0, 0.0, 0.0), name="ball"):
    """A closed sphere of 168 triangles."""
    points, triangles = [[0, 1, 0]], []
    for polar in np.linspace(0, np.pi, 9)[1:-1]:
        for around in np.linspace(0, 2 * np.pi, 12, endpoint=False):
            points.append([np.sin(polar) * np.sin(around), np.cos(polar), np.sin(polar) * np.cos(around)])
    points.append([0, -1, 0])
    last = len(points) - 1
    for k in range(12):
        following = (k + 1) % 12
        triangles += [[0, 1 + k, 1 + following], [last, last - 12 + following, last - 12 + k]]
        for row in range(6):
            a, b = 1 + 12 * row + k, 1 + 12 * row + following
            triangles += [[a, a + 12, b + 12], [a, b + 12, b]]
    return Mesh(name, radius * np.array(points) + centre, np.array(triangles, np.int32))


def groom(apart=0.01):
    """Straight strands of 6 cm along x, inclined by 17° to the floor, with roots ``apart`` along z."""
    along = np.linspace(0, 0.06, POINTS)[:, None] * [np.cos(0.3), np.sin(0.3), 0]
    locks = Curves.from_list([along + [-0.03, 0, apart * k] for k in range(3)], ids=[11, 12, 13])
    mesh = floor()
    triangle, barycentric, _ = _core.bind_roots(mesh.points, mesh.triangles, locks.roots)
    locks.curve |= {"root_triangle": triangle, "root_barycentric": barycentric}
    return Groom(locks, locks, mesh)


def still(mesh):
    return Clip(np.array([1.0]), mesh.points[None], 24.0)
