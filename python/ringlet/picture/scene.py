"""Scenes for the path tracer: bodies, hairs, lights and a camera."""

from __future__ import annotations

import tempfile
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ringlet.data.camera import Camera
from ringlet.data.curves import Curves
from ringlet.data.errors import UserError
from ringlet.data.pigment import HairColor
from ringlet.picture.bodies import COLORS, PosedBody, material
from ringlet.picture.engine import mitsuba
from ringlet.picture.fiber import fiber_bsdf
from ringlet.picture.rigs import STUDIO, Rig
from ringlet.picture.strands import fibres, load_fibres, split

# Smallest drawn diameter of a hair [pixels]: a surface of no radius has no normals.
THINNEST = 1e-3

# Surfaces after which Russian roulette may end a light path. Each ends dark hair's light so often that the paths that
# are left become specks: of the light that two hairs scattered, variance is 15 times as large with 2 as with 3.
ROULETTE = 3


@dataclass(frozen=True)
class Scene:
    """A scene of Mitsuba, whose shapes are numbered from 1: those of hairs first, then bodies, then lights.

    They are counted here, since a shape that was asked for belongs to Python: each sample of a layer would then wait
    for Python's lock, once for every shape.

    hairs:  those of each shape
    bodies: how many there are
    """

    loaded: Any
    hairs: list[Curves]
    bodies: int


def build_scene(
    bodies: Sequence[PosedBody],
    hairs: Curves | None,
    camera: Camera,
    *,
    size: tuple[int, int],
    color: HairColor | None,
    max_depth: int,
    rig: Rig | None = None,
) -> Scene:
    """Builds the scene, centred and scaled so that single precision resolves a hair's width.

    size:     width and height of the picture [pixels]
    color:    of all hairs; None for that of their attributes
    rig:      light; by default the studio around what the camera looks at
    """
    mi = mitsuba()
    target, scale = camera.target, scene_scale(camera)
    pixel = 2.0 * camera.slopes[0] * camera.distance / size[0]
    rig = rig or Rig(STUDIO, 0.0, camera.axes, target, camera.distance)
    shapes = [] if hairs is None or not len(hairs) else split(hairs)
    parts: dict[str, Any] = {
        "type": "scene",
        "integrator": {"type": "path", "max_depth": max_depth, "rr_depth": ROULETTE, "hide_emitters": True},
        "sensor": image_sensor(mi, camera, size, scale),
    }
    for index, some in enumerate(shapes):
        controls, offsets = fibres(some, target)
        controls[:, 3] = np.maximum(controls[:, 3], 0.5 * THINNEST * pixel)
        bsdf = fiber_bsdf(mi, some, color)
        parts[f"hairs{index}"] = load_fibres(mi, controls * np.float32(scale), offsets, bsdf)
    with tempfile.TemporaryDirectory(prefix="ringlet-") as folder:
        for index, body in enumerate(bodies):
            parts[f"body{index}"] = _mesh(mi, body, target, scale, Path(folder) / f"body{index}.ply")
        # Not optimised: alike bodies would become one shape, behind the lights.
        return Scene(mi.load_dict(parts | rig.emitters(mi, target, scale), optimize=False), shapes, len(bodies))


def scene_scale(camera: Camera) -> float:
    """Scene units per metre: the camera is 100 units from its target, the origin of the scene."""
    return 100.0 / camera.distance


def image_sensor(mi: Any, camera: Camera, size: tuple[int, int], scale: float) -> dict[str, Any]:
    """The camera in the scene, whose origin is the camera's target.

    Its pixels share no samples: a denoiser takes noise that they share for detail, and layers have one surface a ray.
    """
    place = scale * camera.distance * camera.axes[2]
    sensor: dict[str, Any] = {
        "type": "perspective",
        "fov": camera.fov,
        "fov_axis": "x",
        "near_clip": 5.0,
        "far_clip": 1e5,
        "to_world": mi.ScalarTransform4f().look_at(origin=list(place), target=[0, 0, 0], up=list(camera.axes[1])),
        "sampler": {"type": "multijitter"},
        "film": {
            "type": "hdrfilm",
            "width": size[0],
            "height": size[1],
            "pixel_format": "rgba",
            "component_format": "float32",
            "rfilter": {"type": "box"},
        },
    }
    if camera.lens_radius:
        if any(camera.shift):
            raise UserError("picture: the camera has both an aperture offset and depth of field; set --f-stop to 0")
        focus = camera.distance if camera.focus is None else camera.focus
        lens = {"type": "thinlens", "aperture_radius": scale * camera.lens_radius, "focus_distance": scale * focus}
        return sensor | lens
    right, up = (0.5 * shift / slope for shift, slope in zip(camera.shift, camera.slopes, strict=True))
    return sensor | {"principal_point_offset_x": right, "principal_point_offset_y": -up}


def _mesh(mi: Any, body: PosedBody, target: NDArray[np.float64], scale: float, file: Path) -> dict[str, Any]:
    """A body as a shape of the scene, by way of a file: a mesh that is made here would belong to Python."""
    mesh = body.mesh
    made = mi.Mesh(mesh.name, len(mesh.points), len(mesh.triangles), has_vertex_normals=True)
    if mesh.colors is not None:
        made.add_attribute(COLORS, 3, np.clip(mesh.colors, 0.0, 1.0).astype(np.float32).ravel())
    parameters = mi.traverse(made)
    values = {
        "vertex_positions": (body.points - target) * scale,
        "vertex_normals": mesh.normals(np.asarray(body.points, np.float64)),
        "faces": mesh.triangles,
    }
    for name, array in values.items():
        kind = type(parameters[name])
        parameters[name] = kind(np.ascontiguousarray(array, np.uint32 if name == "faces" else np.float32).ravel())
    parameters.update()
    made.write_ply(str(file))
    return {"type": "ply", "filename": str(file), "bsdf": material(mesh, body.opacity)}
