"""Sheets of cloth for the tests."""

import numpy as np
from ringlet.data.mesh import Mesh


def sheet(width, height, columns, rows):
    """A flat sheet in the plane of x and y: ``columns`` × ``rows`` squares, cut along alternating diagonals."""
    x, y = np.meshgrid(np.linspace(0, width, columns + 1), np.linspace(0, height, rows + 1))
    points = np.c_[x.ravel(), y.ravel(), np.zeros(x.size)]
    triangles = []
    for j in range(rows):
        for i in range(columns):
            a = j * (columns + 1) + i
            b, c, d = a + 1, a + columns + 2, a + columns + 1
            triangles += [(a, b, c), (a, c, d)] if (i + j) % 2 else [(a, b, d), (b, c, d)]
    return Mesh("sheet", points, np.array(triangles, np.int32))


def lattice(columns, width, spacing):
    """A flat strip of equilateral triangles along x: rows of vertices across it ``spacing`` apart, ragged sides."""
    edge = spacing * 2 / np.sqrt(3)
    count = max(2, round(width / edge))
    points = [(i * spacing, (j + (i % 2) / 2) * edge, 0.0) for i in range(columns + 1) for j in range(count + 1)]
    triangles = []
    for i in range(columns):
        for j in range(count):
            a, d = i * (count + 1) + j, (i + 1) * (count + 1) + j
            triangles += [(a, d, a + 1), (d, d + 1, a + 1)] if i % 2 == 0 else [(a, d, d + 1), (a, d + 1, a + 1)]
    return Mesh("lattice", np.array(points), np.array(triangles, np.int32))
