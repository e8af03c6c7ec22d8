"""The scene of a shot at its first frame: carriers, friction and initial penetration."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from ringlet.data.groom import Groom
from ringlet.shot.contact import ShotContact
from ringlet.sim.contact_radii import contact_radii
from ringlet.sim.friction import LOCKS, friction_matrix, override_pairs
from ringlet.sim.garment import SimulatedGarment
from ringlet.sim.initial_penetration import (
    refuse_intersecting,
    report_inside,
    report_intersections,
    report_overlaps,
    start_report,
)
from ringlet.sim.obstacle import Obstacle
from ringlet.sim.penetration import penetration_depths
from ringlet.sim.scene import Scene
from ringlet.sim.strands import Strands
from ringlet.sim.ties import section_ties


def scene_at_start(
    contact: ShotContact,
    groom: Groom,
    strands: Strands,
    obstacles: Sequence[Obstacle],
    garments: Sequence[SimulatedGarment],
    first: float,
) -> tuple[Scene, dict[str, Any]]:
    """The locks and cloths of a shot in a scene with its obstacles, and the report of initial penetration.

    Vertices of locks that begin inside an obstacle are tolerated until they are out; such a cloth is refused.
    """
    locks = groom.locks.with_points(strands.positions.copy())
    bodies, cloths = [obstacle.body(first) for obstacle in obstacles], [one.cloth for one in garments]
    of_bodies = [obstacle.name for obstacle in obstacles]
    for one in garments:
        refuse_intersecting(one, of_bodies, bodies)
    names = [LOCKS, *(one.name for one in garments), *of_bodies]
    scalps = [k for k, obstacle in enumerate(obstacles) if obstacle.is_surface_of(groom.scalp)]
    scene = Scene(
        strands,
        bodies,
        contact,
        rooted_in=np.full(len(locks), scalps[0] if scalps else -1),
        cloths=cloths,
        pinned_to=np.array([one.pinned_to for one in garments]),
        friction=override_pairs(friction_matrix(contact, cloths, bodies), contact.pair, names),
        radii=contact_radii(contact, locks),
        ties=section_ties(groom.locks, strands),
    )
    inside = []
    for k, (obstacle, body) in enumerate(zip(obstacles, bodies, strict=True)):
        depth = penetration_depths(locks.points, obstacle.mesh.triangles, body.points)
        depth[strands.held] = 0.0
        if depth.any():
            inside.append(report_inside(locks, obstacle.mesh, depth))
            scene.allow_penetration(np.flatnonzero(depth), k)
    return scene, start_report(inside, report_intersections(locks, garments), report_overlaps(locks, scene))
