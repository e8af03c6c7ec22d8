"""Benchmark of direct solvers: factorisation of the Newton system of strands in contact."""

from __future__ import annotations

from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from ringlet import Clock, Curves, DirectSolver, Material, Strands

DOFS = 3  # degrees of freedom per vertex: positions only
FPS = 24.0
SPACING = 4e-3  # distance of the roots [m]; coils of radius 2.5 mm interpenetrate


def run(
    strands: int = 100,
    vertices: int = 100,
    contacts: float = 0.5,
    method: Literal["automatic", "builtin", "pardiso"] = "automatic",
    repeat: int = 3,
) -> dict[str, Any]:
    """Factors and solves the Newton system of coils in mid-swing: 3 · strands · vertices unknowns.

    contacts: contacts per vertex, between the nearest edges of different strands, of stiffness 0.1 to 100 N/m
    method:   builtin, pardiso or automatic
    repeat:   timed evaluations, after one to warm up
    """
    points, hessians, masses = swinging(strands, vertices)
    i, j, blocks = strand_triplets(hessians, vertices)
    pushes, i_contact, j_contact, contact_blocks = contact_triplets(points, vertices, round(contacts * len(points)))
    i, j = np.concatenate([i, i_contact]), np.concatenate([j, j_contact])
    triplets = np.concatenate([blocks, contact_blocks])
    weight = np.array([0.0, -9.81, 0.0])
    b = (masses[:, None] * weight + pushes).ravel()

    clock = Clock()
    for _ in range(repeat + 1):
        with clock("whole"):
            with clock("analyse"):
                solver = DirectSolver(i, j, len(points), DOFS, method)
            with clock("factor"):
                definite = solver.factor(triplets)
            with clock("solve"):
                _, residual = solver.solve(b)
    return clock.result(
        "direct",
        {"strands": strands, "vertices": vertices, "contacts": contacts, "method": method, "repeat": repeat},
        per="whole",
        warm_up=1,
        method=solver.method,
        strands=strands,
        vertices=len(points),
        unknowns=len(b),
        contacts=len(i_contact) // 10,
        positive_definite=definite,
        residual=residual,
        factor_megabytes=8e-6 * solver.entries,
        fill=solver.entries / (0.5 * DOFS**2 * len(np.unique(i.astype(np.int64) * len(points) + j))),
    )


def swinging(strands: int, vertices: int) -> tuple[NDArray[np.float64], list[NDArray[np.float64]], NDArray[np.float64]]:
    """Positions of swinging coils [m], the Newton matrix of each strand there [N/m], and masses [kg]."""
    side = int(np.ceil(np.sqrt(strands)))
    rest = np.concatenate([coil(k, vertices) + SPACING * np.array([k % side, 0, k // side]) for k in range(strands)])
    offsets = np.arange(strands + 1, dtype=np.int32) * vertices
    material = Material()
    moving = Strands(Curves(rest, offsets, np.arange(strands)), material)
    for step in range(6):
        moving.step(rest + (0.02 * np.sin(step), 0, 0), 1 / FPS, gravity=(0.0, -9.81, 0.0))
    points = moving.positions.copy()

    hessians = []
    masses = np.zeros(len(points))
    for k in range(strands):
        own = slice(vertices * k, vertices * (k + 1))
        single = Strands(Curves(rest[own], offsets[:2], np.arange(1)), material)
        _, _, hessian = single.energy(points[own], continuation="least_energy", hessian=True)
        half = 0.5 * material.density * np.pi * material.radius**2 * np.linalg.norm(np.diff(rest[own], axis=0), axis=1)
        masses[own] = np.r_[half, 0] + np.r_[0, half]
        free = np.repeat(np.arange(vertices) >= 3, DOFS)
        inertia = np.repeat(masses[own], DOFS) * FPS**2
        hessians.append(
            hessian + np.diag(np.where(free, inertia, 0.0))
        )  # the row of a prescribed vertex is the identity
    return points, hessians, masses


def coil(index: int, vertices: int) -> NDArray[np.float64]:
    """A hanging 4A curl with its own phase [m], shape (vertices, 3)."""
    turn = 2 * np.pi * np.arange(vertices) / 12 + index
    return np.c_[2.5e-3 * np.cos(turn), -3e-3 * (turn - index) / (2 * np.pi), 2.5e-3 * np.sin(turn)]


def strand_triplets(
    hessians: list[NDArray[np.float64]], vertices: int
) -> tuple[NDArray[np.intp], NDArray[np.intp], NDArray[np.float64]]:
    """Blocks of the upper band of every strand's matrix: rows, columns and values of shape (k, 3, 3)."""
    i, j = np.nonzero(np.triu(np.ones((vertices, vertices))) - np.triu(np.ones((vertices, vertices)), 4))
    blocks = [hessian.reshape(vertices, DOFS, vertices, DOFS).swapaxes(1, 2)[i, j] for hessian in hessians]
    first = np.repeat(vertices * np.arange(len(hessians)), len(i))
    return first + np.tile(i, len(hessians)), first + np.tile(j, len(hessians)), np.concatenate(blocks)


def contact_triplets(
    points: NDArray[np.float64], vertices: int, count: int
) -> tuple[NDArray[np.float64], NDArray[np.intp], NDArray[np.intp], NDArray[np.float64]]:
    """Contacts of the ``count`` nearest pairs of edges of different strands: forces [N], shape (n, 3), and triplets.

    A contact couples the four vertices of its edges by n nᵀ ⊗ w wᵀ, with a random stiffness from 0.1 to 100 N/m.
    """
    random = np.random.default_rng(1)
    forces = np.zeros_like(points)
    edge = np.setdiff1d(np.arange(len(points) - 1), np.arange(vertices - 1, len(points), vertices))
    edge = edge[edge % vertices >= 3]  # free edges
    middle = 0.5 * (points[edge] + points[edge + 1])
    neighbours = min(24, len(edge))
    distance, near = cKDTree(middle).query(middle, neighbours)
    a, b = np.repeat(np.arange(len(edge)), neighbours), near.ravel()
    valid = (a < b) & (edge[a] // vertices != edge[b] // vertices)
    a, b, distance = a[valid], b[valid], distance.ravel()[valid]
    chosen = np.argsort(distance, kind="stable")[:count]
    a, b = a[chosen], b[chosen]

    corners = np.stack([edge[a], edge[a] + 1, edge[b], edge[b] + 1], axis=1)
    s, t = random.uniform(size=(2, len(a)))
    weights = np.stack([1 - s, s, t - 1, -t], axis=1)
    normal = middle[a] - middle[b]
    normal /= np.linalg.norm(normal, axis=1, keepdims=True)
    stiffness = 10 ** random.uniform(-1, 2, len(a))
    np.add.at(forces, corners, (1e-5 * stiffness)[:, None, None] * weights[:, :, None] * normal[:, None])
    p, q = np.triu_indices(4)
    scale = stiffness[:, None] * weights[:, p] * weights[:, q]
    blocks = scale[:, :, None, None] * (normal[:, :, None] * normal[:, None, :])[:, None]
    return forces, corners[:, p].ravel(), corners[:, q].ravel(), blocks.reshape(-1, DOFS, DOFS)
