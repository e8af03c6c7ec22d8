"""Hair as Unreal's groom importer takes it: its attributes of curves, and its limits.

Attributes, with types and scopes:
https://dev.epicgames.com/documentation/en-us/unreal-engine/using-alembic-for-grooms-in-unreal-engine
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from importlib.metadata import version

import numpy as np
from numpy.typing import NDArray

from ringlet.data.attributes import fits
from ringlet.data.curves import id_halves
from ringlet.data.hair_scene import CurveSet, HairScene
from ringlet.data.resampling import Resampling

VERSION = 1, 5  # of the attributes
TOOL = f"Ringlet {version('ringlet')}"
POINTS = 255  # of a curve, which Unreal numbers by a byte
GUIDE_POINTS = 32  # of a guide: the largest "strands size" of its solvers
CURVES, GROUP_POINTS = 2**22 - 1, 2**24 - 1  # of a group, guides and hairs apart
COLORS = ("groom_color", "color", "displayColor")  # attributes that are groom_color: the first of them
CLOSEST, WEIGHTS = "groom_closest_guides", "groom_guide_weights"
ATTRIBUTES = ("groom_guide", "groom_group_id", "groom_id", "groom_root_uv", "groom_color", CLOSEST, WEIGHTS)
LOCK, *OTHER_LOCKS = ("guide_curve_index", "clumpid", "lock")  # attributes of hairs: row of their lock among the guides


def for_unreal(scene: HairScene) -> tuple[HairScene, list[str]]:
    """The scene within the limits of Unreal's importer, and a sentence for each thing that this leaves out.

    Curves of more points are resampled evenly along their length: hairs to 255, guides to the 32 that its solvers take.
    Surfaces are left out, since an archive that has any is imported as a mesh, and not as a groom.
    """
    lost, sets = list[str](), list[CurveSet]()
    if scene.bodies:
        names = ", ".join(mesh.name for mesh, _ in scene.bodies)
        lost.append(f"Unreal takes an archive with surfaces for no groom: without {names}; write them apart")
    for one in scene.sets:
        most = GUIDE_POINTS if one.guide else POINTS
        longer = one.curves.counts > most
        if not longer.any():
            sets.append(one)
            continue
        resampling = Resampling.at_most(one.curves, most)
        sets.append(resampling.curve_set(one))
        what = "simulates guides of" if one.guide else "takes curves of"
        away = resampling.deviation(one.curves) * 1e3
        lost.append(
            f"Unreal {what} at most {most} points: {longer.sum():,} of {len(longer):,} {one.name} were resampled, and "
            f"are up to {away:.2g} mm away from where they were"
        )
    for guide in (False, True):
        lost += _group_limits([one for one in sets if one.guide == guide])
    return replace(scene, sets=sets, bodies=[]), lost


def _group_limits(sets: list[CurveSet]) -> Iterator[str]:
    """A sentence for each group of more curves or points than Unreal takes."""
    groups = np.concatenate([np.empty(0, np.int32), *(one.group_ids for one in sets)])
    counts = np.concatenate([np.empty(0, np.int64), *(one.curves.counts for one in sets)])
    for group in np.unique(groups):
        chosen = groups == group
        for count, most, what in ((chosen.sum(), CURVES, "curves"), (counts[chosen].sum(), GROUP_POINTS, "points")):
            if count > most:
                yield f"Unreal takes at most {most:,} {what} a group, and group {group} has {count:,}: add --fraction"


def curve_attributes(scene: HairScene) -> Iterator[Iterator[tuple[str, NDArray, str]]]:
    """For each set of a scene the attributes of its curves: name, values, and the scope ``uniform`` or ``vertex``.

    Unreal's are first, then those that the curves have themselves.
    """
    closest = closest_guides(scene)
    for one, ids, guides in zip(scene.sets, scene.groom_ids, closest, strict=True):
        yield _attributes(one, ids, guides)


def _attributes(
    one: CurveSet, ids: NDArray[np.int32], closest: NDArray[np.int32] | None
) -> Iterator[tuple[str, NDArray, str]]:
    """Attributes of one set.

    ids:     ``groom_id`` of the curves; where these are not their own, the own ones are written in halves
    closest: ``groom_id`` of the guide of each, None where that is not known
    """
    curves, count = one.curves, len(one.curves)
    yield "groom_id", ids, "uniform"
    if (ids != curves.ids).any():
        yield from ((name, half, "uniform") for name, half in id_halves(curves.ids).items())
    yield "groom_group_id", one.group_ids, "uniform"
    yield "groom_guide", np.full(count, one.guide, np.int32), "uniform"
    if closest is not None:
        yield CLOSEST, np.repeat(closest[:, None], 3, axis=1), "uniform"
        yield WEIGHTS, np.tile(np.array([1.0, 0.0, 0.0], np.float32), (count, 1)), "uniform"
    if "st" in curves.curve:
        yield "groom_root_uv", curves.curve["st"].astype(np.float32), "uniform"
    kinds = {"vertex": curves.point, "uniform": curves.curve}
    known = [(scope, name) for name in COLORS for scope, kind in kinds.items() if name in kind]
    colors = [(scope, name) for scope, name in known if fits(kinds[scope][name], (3,))][:1]
    for scope, name in colors:
        values = kinds[scope][name]
        values = values if scope == "vertex" else np.repeat(values, curves.counts, axis=0)
        yield "groom_color", values.astype(np.float32), "vertex"
    taken = {("uniform", "st"), *((scope, name) for scope, name in colors if scope == "vertex")}
    for scope, kind in kinds.items():
        for name, values in kind.items():
            if name not in ATTRIBUTES and (scope, name) not in taken:
                yield name, values, scope


def closest_guides(scene: HairScene) -> list[NDArray[np.int32] | None]:
    """For each set the ``groom_id`` of the guide of each hair, which is its lock.

    None for guides, and where hairs have no attribute that numbers the curves of the one set of guides.
    """
    guides = [(one, ids) for one, ids in zip(scene.sets, scene.groom_ids, strict=True) if one.guide]
    if len(guides) != 1:
        return [None] * len(scene.sets)
    (_, ids), rows = guides[0], [None if one.guide else _lock_rows(one, len(guides[0][1])) for one in scene.sets]
    return [None if row is None else ids[row] for row in rows]


def _lock_rows(one: CurveSet, count: int) -> NDArray | None:
    """The row of the lock of each hair among as many guides, of the first attribute that has such rows."""
    for name in (LOCK, *OTHER_LOCKS):
        rows = one.curves.curve.get(name)
        if rows is not None and rows.dtype.kind in "iu" and rows.ndim == 1 and ((rows >= 0) & (rows < count)).all():
            return rows
    return None


def name_guides(sets: list[CurveSet]) -> list[str]:
    """Turns ``groom_closest_guides``, as they were read, into rows of the guides; takes ``groom_id`` out.

    Returns a sentence for what is not kept.
    """
    ids = [np.asarray(one.curves.curve.pop("groom_id", one.curves.ids)) for one in sets]
    guides, lost = [row for row, one in enumerate(sets) if one.guide], list[str]()
    for one in sets:
        closest, weights = (one.curves.curve.pop(name, None) for name in (CLOSEST, WEIGHTS))
        if closest is None or one.guide:
            continue
        first = closest if closest.ndim == 1 else closest[:, 0]
        known = ids[guides[0]] if len(guides) == 1 else np.empty(0)
        if not np.isin(first, known).all():
            lost.append(f"{one.name}: its {CLOSEST} are not those of one set of guides, and are left out")
            continue
        if weights is not None and weights.ndim == 2 and weights[:, 1:].any():
            lost.append(f"{one.name}: of its {CLOSEST} the first one of each hair is kept")
        order = np.argsort(known, kind="stable")
        one.curves.curve.setdefault(LOCK, order[np.searchsorted(known, first, sorter=order)].astype(np.int32))
    return lost
