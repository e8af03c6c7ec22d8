"""Stretch, shear and bend of cloth."""

from __future__ import annotations

import numpy as np
from ringlet.data.mesh import Mesh
from ringlet.shot import ClothMaterial
from ringlet.sim import Cloth

from theory.answer import Answer, Panel
from theory.strand import elastica

STILL = {"damping": 0.0, "drag": 0.0}


def lattice(columns: int, width: float, spacing: float) -> Mesh:
    """A flat strip of equilateral triangles along x: rows of vertices across it ``spacing`` apart, ragged sides."""
    edge = spacing * 2 / np.sqrt(3)
    across = max(2, round(width / edge)) + 1
    points = [(i * spacing, (j + (i % 2) / 2) * edge, 0.0) for i in range(columns + 1) for j in range(across)]
    triangles = []
    for i in range(columns):
        for j in range(across - 1):
            a, d = i * across + j, (i + 1) * across + j
            triangles += [(a, d, a + 1), (d, d + 1, a + 1)] if i % 2 == 0 else [(a, d, d + 1), (a, d + 1, a + 1)]
    return Mesh("lattice", np.array(points), np.array(triangles, np.int32))


def membrane() -> Answer:
    """Long strips, cut at an angle to the warp, that are pulled at both ends."""
    warp, weft, shear, pull = 1000.0, 400.0, 150.0, 0.5  # [N/m]
    mesh = lattice(60, 0.06, 0.004)
    x = mesh.points[:, 0]
    ends = np.isclose(x, x.min()), np.isclose(x, x.max())
    width = np.ptp(mesh.points[ends[0], 1])
    forces = np.zeros_like(mesh.points)
    for sign, end in zip((-1.0, 1.0), ends, strict=True):
        forces[end, 0] = sign * pull * width / end.sum()
    middle = [int(np.abs(x - part * x.max()).argmin()) for part in (0.3, 0.7)]

    def strain(angle: float) -> float:
        material = ClothMaterial(stretch_warp=warp, stretch_weft=weft, shear=shear, bend=1e-4, **STILL)
        strip = Cloth(mesh, material, [middle[0]], warp=(np.cos(angle), np.sin(angle), 0.0))
        strip.settle(forces=forces, tolerance=1e-9)
        rows = [strip.positions[np.isclose(x, x[k])].mean(axis=0) for k in middle]
        return float(np.linalg.norm(rows[1] - rows[0]) / (x[middle[1]] - x[middle[0]]) - 1)

    def compliance(angle: float | np.ndarray) -> np.ndarray:
        c, s = np.cos(angle) ** 2, np.sin(angle) ** 2
        return c**2 / warp + s**2 / weft + c * s / shear

    angles, between = np.radians(np.arange(0, 91, 15)), np.radians(np.linspace(0, 90, 91))
    got = np.array([strain(float(angle)) for angle in angles])
    name = f"{pull} N/m"
    return Answer(
        [
            Panel(
                "angle from the warp [°]",
                "strain",
                {name: (np.degrees(between), pull * compliance(between))},
                {name: (np.degrees(angles), got)},
            )
        ],
        [
            (f"strain at {np.degrees(angle):.0f}°", float(pull * compliance(angle)), float(one))
            for angle, one in zip(angles, got, strict=True)
        ],
    )


def hinge() -> Answer:
    """A wide strip, clamped by its first two rows, that sags under its own weight; and sheets on cylinders."""
    length, bend, density, columns = 0.1, 1e-5, 0.15, 10
    spacing = length / (columns - 0.5)
    mesh = lattice(columns, 0.2, spacing)
    mesh.points = mesh.points[:, [0, 2, 1]] - [0.5 * spacing, 0, 0]
    x = mesh.points[:, 0]
    stiff = {"stretch_warp": 1000.0, "stretch_weft": 1000.0, "shear": 1000.0}
    lines, shapes, rows = {}, {}, []
    for gamma in (1, 4, 20):
        material = ClothMaterial(bend=bend, density=density, **stiff, **STILL)
        strip = Cloth(mesh, material, np.flatnonzero(x < length / columns))
        strip.settle(gravity=(0.0, -gamma * bend / (density * length**3), 0.0), tolerance=1e-8)
        across = [np.isclose(x, at) for at in np.unique(x.round(9))]
        means = np.array([strip.positions[row].mean(axis=0) for row in across]) / length
        lines[f"Γ = {gamma}"], shapes[f"Γ = {gamma}"] = elastica(gamma), (means[:, 0], means[:, 1])
        rows.append(
            (f"drop / L, Γ = {gamma}, {columns} rows", float(-lines[f"Γ = {gamma}"][1][-1]), float(-means[-1, 1]))
        )
    flat = lattice(40, 0.1, 0.1 / 40)
    area = Cloth(flat, ClothMaterial(density=1.0)).masses.sum()
    curvatures, turns = np.array([2.0, 4.0, 8.0, 16.0]), (0, 15, 30)
    rolled = {
        f"rolled at {turn}°": (curvatures, [on_cylinder(flat, bend, k, np.radians(turn)) / area for k in curvatures])
        for turn in turns
    }
    rows += [
        (f"{name}, 8/m: energy by area [J/m²]", 0.5 * bend * 64.0, energies[2])
        for name, (_, energies) in rolled.items()
    ]
    kappa = np.geomspace(2.0, 16.0, 20)
    return Answer(
        [
            Panel("x / L", "y / L", lines, shapes, equal=True),
            Panel(
                "curvature [1/m]",
                "energy per area [J/m²]",
                {"½ D κ²": (kappa, 0.5 * bend * kappa**2)},
                rolled,
                log=True,
            ),
        ],
        rows,
    )


def on_cylinder(flat: Mesh, bend: float, curvature: float, turn: float) -> float:
    """Energy [J] of a sheet rolled onto a cylinder whose axis is turned in the sheet, without the rim."""
    c, s = np.cos(turn), np.sin(turn)
    along, across = flat.points[:, :2] @ [c, s], flat.points[:, :2] @ [-s, c]
    rolled = np.c_[np.sin(curvature * along) / curvature, across, (1 - np.cos(curvature * along)) / curvature]
    soft = ClothMaterial(bend=bend, stretch_warp=1e-9, stretch_weft=1e-9, shear=0.0)
    return float(Cloth(flat, soft).energy(rolled)[0])
