"""Triangle meshes of the contact trials: sheets, rods, spheres and bands."""

import numpy as np
from ringlet.data.mesh import Mesh
from ringlet.sim.obstacle import Body


def sheet(corner, first, second, squares, **body):
    """A parallelogram of squares × squares cells, two triangles each."""
    u, v = (x.ravel()[:, None] for x in np.meshgrid(*2 * [np.linspace(0, 1, squares + 1)], indexing="ij"))
    at = np.arange((squares + 1) ** 2).reshape(squares + 1, -1)
    a, b, c, d = (x.ravel() for x in (at[:-1, :-1], at[1:, :-1], at[1:, 1:], at[:-1, 1:]))
    return Body(corner + u * first + v * second, np.concatenate([np.c_[a, b, c], np.c_[a, c, d]]), **body)


def rod(start, axis, radius):
    """A three-sided prism from ``start`` to ``start + axis``, its cross-section in the plane of x and y."""
    turn = 2 * np.pi * np.arange(3) / 3
    ring = start + radius * np.c_[np.cos(turn), np.sin(turn), 0 * turn]
    sides = [[k, (k + 1) % 3, k + 3, (k + 1) % 3 + 3] for k in range(3)]
    triangles = [[a, b, d] for a, b, c, d in sides] + [[a, d, c] for a, b, c, d in sides] + [[0, 2, 1], [3, 4, 5]]
    return Body(np.concatenate([ring, ring + axis]), np.array(triangles))


def sphere(radius, rows, columns):
    """Points and triangles of a sphere about the origin."""
    polar, around = np.meshgrid(
        np.linspace(0, np.pi, rows + 1)[1:-1], 2 * np.pi * np.arange(columns) / columns, indexing="ij"
    )
    points = np.c_[
        (np.sin(polar) * np.cos(around)).ravel(), np.cos(polar).ravel(), (np.sin(polar) * np.sin(around)).ravel()
    ]
    points = radius * np.concatenate([points, [[0.0, 1, 0], [0, -1, 0]]])
    at = np.arange((rows - 1) * columns).reshape(rows - 1, columns)
    a, b, c, d = (x.ravel() for x in (at[:-1], np.roll(at, -1, axis=1)[:-1], np.roll(at, -1, axis=1)[1:], at[1:]))
    top, bottom = len(points) - 2, len(points) - 1
    fans = [
        np.c_[np.full(columns, top), np.roll(at[0], -1), at[0]],
        np.c_[np.full(columns, bottom), at[-1], np.roll(at[-1], -1)],
    ]
    return points, np.concatenate([np.c_[a, b, c], np.c_[a, c, d], *fans])


def as_mesh(body):
    """The surface of a body as the mesh of a cloth."""
    return Mesh("cloth", np.asarray(body.points, float), np.asarray(body.triangles, np.int32))


def band(centre, radius, height, columns, rows):
    """An upright cylinder of cloth: ``columns`` squares around, ``rows`` high."""
    turn, up = np.meshgrid(2 * np.pi * np.arange(columns) / columns, np.linspace(0, height, rows + 1), indexing="ij")
    points = np.c_[radius * np.cos(turn).ravel(), up.ravel(), radius * np.sin(turn).ravel()] + centre
    at = np.arange(len(points)).reshape(columns, rows + 1)
    a, b, c, d = (x.ravel() for x in (at[:, :-1], np.roll(at, -1, 0)[:, :-1], np.roll(at, -1, 0)[:, 1:], at[:, 1:]))
    return Mesh("band", points, np.concatenate([np.c_[a, b, c], np.c_[a, c, d]]).astype(np.int32))


def edges_of(triangles):
    """The unique edges of triangles, shape (k, 2)."""
    return np.unique(
        np.sort(np.concatenate([triangles[:, [0, 1]], triangles[:, [1, 2]], triangles[:, [2, 0]]])), axis=0
    )
