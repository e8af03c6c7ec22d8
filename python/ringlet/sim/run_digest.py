"""The digest of a run: two runs with the same digest give the same bits."""

from __future__ import annotations

import math
from collections.abc import Sequence
from importlib.metadata import version

from ringlet.data.curves import Curves
from ringlet.data.groom import Groom
from ringlet.data.mesh import Clip
from ringlet.shot.shot import Shot
from ringlet.sim.checkpoint import digest
from ringlet.sim.garment import Garment
from ringlet.sim.obstacle import Obstacle

# Settings that change no frame: file names, whose content is part of the digest, and how far a run goes.
_PLACES = {
    "groom": True,
    "frames": True,
    "rest": {"file"},
    "collider": {"__all__": {"file"}},
    "cloth": {"__all__": {"file"}},
}


def digest_of_run(
    shot: Shot,
    groom: Groom,
    clip: Clip,
    rest: Curves | None,
    obstacles: Sequence[Obstacle],
    garments: Sequence[Garment],
    frames: tuple[int, int] | None,
) -> str:
    """A digest of all that a run depends on before its first frame, then one of the animation at each frame.

    They are separated by spaces. A run that goes further has the digests of the shorter one, and more.
    """
    curves = [groom.locks] if rest is None else [groom.locks, rest]
    arrays = [
        part for c in curves for part in (c.offsets, c.ids, c.points, *(c.curve[name] for name in sorted(c.curve)))
    ]
    moving = [clip, *(o.clip for o in obstacles), *(g.clip for g in garments)]
    first, last = frames or shot.frames
    arrays += [one.at(one.next_to(first)) for one in moving]
    start = digest(version("ringlet"), shot.model_dump(mode="json", exclude=_PLACES), first, *arrays)
    end = max(one.frames[-1] for one in moving)  # the animation holds from here on
    each = [digest(*(one.at(frame) for one in moving))[:16] for frame in range(first, min(last, math.ceil(end)) + 1)]
    held = digest(*(one.at(end) for one in moving))[:16]
    return " ".join([start, *each, *[held] * (last + 1 - first - len(each))])
