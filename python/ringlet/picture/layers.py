"""Layers of a picture other than its light (AOVs): depth, normal, albedo, motion, and what is seen."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ringlet.data.camera import Camera
from ringlet.data.curves import Curves
from ringlet.data.groom import GROOM
from ringlet.picture.bodies import PosedBody
from ringlet.picture.cryptomatte import NOTHING, Matte, matte
from ringlet.picture.scene import Scene, scene_scale

SAMPLES = 16  # rays per pixel: the edges of the layers are then as smooth as those of the picture


@dataclass(frozen=True)
class Layers:
    """What is seen in each pixel: means over what is covered, 0 where nothing is.

    depth:  along the optical axis [m], shape (height, width)
    normal: of the surface, in world axes, shape (height, width, 3)
    albedo: linear r, g, b, shape (height, width, 3)
    lock:   row of the lock of the hair that one ray through the pixel hits; -1 elsewhere. Shape (height, width), int32
    motion: in the picture until the next frame, to the right and up [pixels], shape (height, width, 2); None where
            nothing moves
    mattes: which locks, and which grooms and bodies are seen
    """

    depth: NDArray[np.float32]
    normal: NDArray[np.float32]
    albedo: NDArray[np.float32]
    lock: NDArray[np.int32]
    motion: NDArray[np.float32] | None = None
    mattes: list[Matte] = field(default_factory=list)


@dataclass(frozen=True)
class HairGroup:
    """Hairs of one shape of the scene, and their reflectance, of each hair or of each point, shape (k, 3)."""

    hairs: Curves
    reflectance: NDArray[np.float64]

    def of_segments(self, values: NDArray) -> NDArray:
        """Values of hairs as values of their segments."""
        return np.repeat(values, self.hairs.counts - 1, axis=0)

    def locks(self) -> NDArray[np.integer]:
        """Row of the lock of each segment; without locks each hair is one."""
        return self.of_segments(self.hairs.curve.get("lock", np.arange(len(self.hairs))))

    def albedo(self) -> NDArray[np.float64]:
        """Albedo of each segment (linear r, g, b), that of its first point where it varies along hairs."""
        if len(self.reflectance) == len(self.hairs):
            return self.of_segments(self.reflectance)
        return np.delete(self.reflectance, self.hairs.offsets[1:] - 1, axis=0)

    def starts(self) -> NDArray[np.int64]:
        """Row of the first point of each segment."""
        return np.delete(np.arange(len(self.hairs.points)), self.hairs.offsets[1:] - 1)


@dataclass(frozen=True)
class Later:
    """What a picture's camera sees in the next frame: hairs of the same shapes, bodies, and the camera."""

    hairs: Sequence[Curves]
    bodies: Sequence[PosedBody]
    camera: Camera


def trace_layers(
    mi: Any,
    scene: Scene,
    camera: Camera,
    groups: Sequence[HairGroup],
    bodies: Sequence[PosedBody] = (),
    grooms: Sequence[str] = (),
    later: Later | None = None,
) -> Layers:
    """Casts rays of one sample per pixel, so that each hits one surface, and takes the means.

    groups: hairs of the first shapes of the scene
    bodies: those of the next shapes
    grooms: names of the grooms that hairs are of
    later:  what is seen in the next frame, for the layer of motion
    """
    names = _Names(groups, bodies, grooms)
    hair = [(number, group.locks(), group.albedo()) for number, group in enumerate(groups, 1)]
    aovs = "position:position,normal:sh_normal,albedo:albedo,shape:shape_index,segment:prim_index"
    integrator = mi.load_dict({"type": "aov", "aovs": aovs})
    sums: Any = 0.0
    lock: Any = None
    seen = {name: list[NDArray[np.int32]]() for name in names.of}
    for number in range(SAMPLES):
        rays = np.array(mi.render(scene.loaded, integrator=integrator, spp=1, seed=number), np.float64)
        position, normal, albedo = np.split(rays[:, :, :9], 3, axis=2)
        shape, segment = (np.rint(rays[:, :, k]).astype(np.int64) for k in (9, 10))
        shown = (shape > 0) & (shape <= len(groups) + scene.bodies)  # neither the background nor a light
        covered, hit = shown[:, :, None], np.full(shape.shape, NOTHING, np.int32)
        for index, locks, colors in hair:
            of_group = shape == index
            at = np.minimum(segment[of_group], len(locks) - 1)  # the last one is the guard
            albedo[of_group], hit[of_group] = colors[at], locks[at]
        places = camera.target + position / scene_scale(camera)
        depth = camera.depths(places.reshape(-1, 3)).reshape(*shape.shape, 1)
        motion = np.zeros((*shape.shape, 2))
        if later is not None:
            motion[shown] = _motion(places, shape, segment, shown, camera, groups, bodies, later)
        sums = sums + np.concatenate([covered, *(covered * one for one in (depth, normal, albedo, motion))], axis=2)
        for name, rows in names.hit(shape, segment).items():
            seen[name].append(rows)
        lock = hit if lock is None else lock
    means = (sums[:, :, 1:] / np.maximum(sums[:, :, :1], 1.0)).astype(np.float32)
    mattes = [matte(name, names.of[name], np.stack(rows)) for name, rows in seen.items()]
    moved = means[:, :, 7:9] if later is not None else None
    return Layers(means[:, :, 0], means[:, :, 1:4], means[:, :, 4:7], lock, moved, mattes)


class _Names:
    """Names of locks, and of grooms and bodies, as mattes know them.

    of: names by the name of the matte
    """

    def __init__(self, groups: Sequence[HairGroup], bodies: Sequence[PosedBody], grooms: Sequence[str]) -> None:
        locks, things = dict[str, int](), dict[str, int]()
        self._groups = list[tuple[NDArray, NDArray]]()
        for group in groups:
            curve, count = group.hairs.curve, len(group.hairs)
            ids = curve.get("guide_id", curve.get("lock", group.hairs.ids))
            rows = curve.get(GROOM, np.zeros(count, np.int32))
            named = [
                grooms[row] if row < len(grooms) else f"hair_{row}" if row else "hair"
                for row in map(int, rows.tolist())
            ]
            numbered = [
                [names.setdefault(name, len(names)) for name in of]
                for names, of in ((locks, [f"lock_{id}" for id in ids.tolist()]), (things, named))
            ]
            self._groups.append((group.of_segments(np.array(numbered[0])), group.of_segments(np.array(numbered[1]))))
        self._bodies = [things.setdefault(body.mesh.name.rsplit(" ", 1)[-1], len(things)) for body in bodies]
        self.of = {"CryptoLock": list(locks), "CryptoObject": list(things)}

    def hit(self, shape: NDArray, segment: NDArray) -> dict[str, NDArray[np.int32]]:
        """What each ray hits, rows of names, of rays that hit a segment of a shape."""
        made = {name: np.full(shape.shape, NOTHING, np.int32) for name in self.of}
        for index, of_segments in enumerate(self._groups, 1):
            chosen = shape == index
            for rows, values in zip(made.values(), of_segments, strict=True):
                rows[chosen] = values[np.minimum(segment[chosen], len(values) - 1)]
        for index, thing in enumerate(self._bodies, 1 + len(self._groups)):
            made["CryptoObject"][shape == index] = thing
        return made


def _motion(
    places: NDArray[np.float64],
    shape: NDArray,
    segment: NDArray,
    shown: NDArray[np.bool_],
    camera: Camera,
    groups: Sequence[HairGroup],
    bodies: Sequence[PosedBody],
    later: Later,
) -> NDArray[np.float64]:
    """How far places go in the picture until the next frame [pixels], of those that are shown, shape (k, 2)."""
    size = np.array(shown.shape[::-1])
    moved = places.copy()
    for index, (group, then) in enumerate(zip(groups, later.hairs, strict=True), 1):
        chosen = shape == index
        start = group.starts()[np.minimum(segment[chosen], len(group.starts()) - 1)]
        a, b = group.hairs.points[start].astype(np.float64), group.hairs.points[start + 1].astype(np.float64)
        along = ((places[chosen] - a) * (b - a)).sum(axis=1) / np.maximum(((b - a) ** 2).sum(axis=1), 1e-300)
        t = np.clip(along, 0.0, 1.0)[:, None]
        moved[chosen] += (1.0 - t) * (then.points[start] - a) + t * (then.points[start + 1] - b)
    for index, (body, then) in enumerate(zip(bodies, later.bodies, strict=True), 1 + len(groups)):
        chosen = shape == index
        corners = body.mesh.triangles[segment[chosen]]
        weights = _barycentric(places[chosen], np.asarray(body.points, np.float64)[corners])
        moved[chosen] += np.einsum("nk,nkd->nd", weights, np.asarray(then.points - body.points, np.float64)[corners])
    after, before = later.camera.project(moved[shown]), camera.project(places[shown])
    return (after - before) * size * (1.0, -1.0)


def _barycentric(places: NDArray[np.float64], corners: NDArray[np.float64]) -> NDArray[np.float64]:
    """Barycentric weights of places (n, 3) in triangles (n, 3, 3), shape (n, 3)."""
    a, b = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
    p = places - corners[:, 0]
    aa, ab, bb = (a * a).sum(axis=1), (a * b).sum(axis=1), (b * b).sum(axis=1)
    pa, pb = (p * a).sum(axis=1), (p * b).sum(axis=1)
    area = np.maximum(aa * bb - ab * ab, 1e-300)
    v, w = (bb * pa - ab * pb) / area, (aa * pb - ab * pa) / area
    return np.stack([1.0 - v - w, v, w], axis=1)
