"""Light on hair: the highlight of straight hair, and noise that averages out along hairs."""

from __future__ import annotations

import numpy as np
import pytest
from ringlet.data.camera import Camera
from ringlet.data.curves import Curves
from ringlet.data.pigment import USUAL_FIBER
from ringlet.picture.engine import mitsuba
from ringlet.picture.hair_field import HairField, hair_field
from ringlet.picture.passes import Passes
from ringlet.picture.render import trace
from ringlet.picture.scene import build_scene
from ringlet.picture.strands import split

RADIUS, SIZE = 0.05, 48
AHEAD = Camera(np.array([0.0, 0.0, 4.0]), np.eye(3), 4.0, (0.0126, 0.0126))  # sees 10 cm at the origin
ELEVATION = 40.0  # of the light [degrees]


class Sun:
    """A distant light at ``ELEVATION`` above the camera."""

    def emitters(self, mi, origin, scale):
        e = np.radians(ELEVATION)
        toward = [0.0, -np.sin(e), -np.cos(e)]
        return {"sun": {"type": "directional", "direction": toward, "irradiance": {"type": "rgb", "value": 20.0}}}


def cylinder(count: int = 700, **fiber: float) -> Curves:
    """Black hairs side by side, from the top of a lying cylinder over its front to its bottom."""
    down = np.radians(np.linspace(89.0, -89.0, 60))
    random = np.random.default_rng(1)
    hairs = []
    for x in np.linspace(-RADIUS, RADIUS, count):
        radius = RADIUS * (1.0 - 0.01 * random.uniform())
        hairs.append(np.stack([np.full(60, x), radius * np.sin(down), radius * np.cos(down)], axis=1))
    curves = Curves.from_list(hairs)
    curves.point["width"] = np.full(len(curves.points), 9e-5)
    curves.curve |= {"melanin": np.full(count, 0.9999), "redness": np.zeros(count)}
    curves.curve |= {name: np.full(count, value) for name, value in (USUAL_FIBER | fiber).items()}
    return curves


def seen(hairs: Curves, samples: int = 40, denoise: bool = True) -> np.ndarray:
    scene = build_scene([], hairs, AHEAD, size=(SIZE, SIZE), color=None, max_depth=2, rig=Sun())
    return trace(scene, samples=samples, denoise=denoise)[:, :, :3].mean(axis=2)


def band(**fiber: float) -> tuple[float, float, int, float]:
    """Latitude of the brightest place on the cylinder and the band's deviation [degrees], the number of its peaks, and
    its relative deviation along the band."""
    light = seen(cylinder(**fiber))
    profile = light[:, 6:-6].mean(axis=1)
    height = (0.5 - (np.arange(SIZE) + 0.5) / SIZE) * 2.0 * 4.0 * AHEAD.slopes[1] / RADIUS
    inside = np.abs(height) < 0.97
    latitude, profile = np.degrees(np.arcsin(height[inside])), profile[inside]
    weight = np.where(profile > 0.3 * profile.max(), profile, 0.0)
    centre = float((weight * latitude).sum() / weight.sum())
    deviation = float(np.sqrt((weight * (latitude - centre) ** 2).sum() / weight.sum()))
    risen = np.diff((profile > 0.5 * profile.max()).astype(int))
    row = light[np.argmin(np.abs(np.degrees(np.arcsin(np.clip(height, -1, 1))) - centre)), 6:-6]
    return centre, deviation, int((risen > 0).sum()), float(row.std() / row.mean())


def test_the_highlight_is_one_band_that_the_tilt_moves_towards_the_root():
    """Light at elevation e and a camera at 0 meet at e/2 on a cylinder; the tilt α of the cuticle adds α (R lobe)."""
    flat, tilted = band(roughness=0.15, tilt=0.0), band(roughness=0.15, tilt=5.0)
    assert flat[0] == pytest.approx(0.5 * ELEVATION, abs=1.5)
    assert tilted[0] - flat[0] == pytest.approx(5.0, abs=1.2)
    assert flat[2] == tilted[2] == 1


def test_the_band_is_as_wide_as_the_roughness_says_and_smooth_along_it():
    """The R lobe has the deviation 0.726 β + 0.812 β² (Chiang et al. 2016); a cylinder shows half of it."""
    widths = {}
    for roughness in (0.12, 0.2):
        lobe = np.degrees(0.726 * roughness + 0.812 * roughness**2)
        _, widths[roughness], peaks, variation = band(roughness=roughness, tilt=0.0)
        assert widths[roughness] == pytest.approx(0.5 * lobe, rel=0.25)
        assert peaks == 1
        assert variation < 0.14
    noisy = seen(cylinder(roughness=0.15), denoise=False)
    row = noisy[noisy.mean(axis=1).argmax(), 6:-6]
    assert row.std() / row.mean() > 0.2


def test_the_field_of_hairs_tells_how_they_run():
    for degrees in (0.0, 30.0, 110.0):
        run = np.array([np.cos(np.radians(degrees)), -np.sin(np.radians(degrees)), 0.0])  # y of pictures is down
        side = np.array([-run[1], run[0], 0.0])
        hairs = Curves.from_list(
            [np.array([o * side - 0.1 * run, o * side, o * side + 0.1 * run]) for o in np.linspace(-0.06, 0.06, 60)]
        )
        hairs.point["width"] = np.full(len(hairs.points), 3e-3)
        field = hair_field(mitsuba(), build_scene([], hairs, AHEAD, size=(24, 24), color=None, max_depth=2, rig=Sun()))
        double = np.radians(2.0 * degrees)
        assert field.share[8:16, 8:16].min() > 0.95
        assert field.layers[12, 12, 3:] == pytest.approx([np.cos(double), np.sin(double)], abs=0.05)


def test_single_hairs_stay_and_noise_does_not():
    random = np.random.default_rng(3)
    stripes = 0.2 * np.broadcast_to(np.arange(48) % 4 == 0, (48, 48))[:, :, None] * np.ones(4)
    nothing = np.zeros((48, 48))
    layers = np.stack([nothing + 1.0, stripes[:, :, 0], nothing, nothing - 1.0, nothing], axis=2).astype(np.float32)
    field = HairField(np.ones((48, 48), np.float32), layers)
    for hairs, least, most in ((stripes, 0.9, 1.1), (0.0 * stripes, -0.1, 0.1)):
        passes = Passes()
        for _ in range(4):
            passes.add((0.3 + hairs) * random.gamma(2.0, 0.5, (48, 48, 1)))
        flat = np.full((48, 48, 4), 0.3) + hairs.mean()
        kept = (passes.relief(flat, field) - flat)[8:-8, 8:-8, :3]
        scale = (stripes - stripes.mean())[8:-8, 8:-8, :3]
        assert least <= (kept * scale).sum() / (scale**2).sum() <= most
        assert kept.std() < (0.02 if not hairs.any() else 0.12)


def test_fibers_that_differ_get_materials_of_their_own():
    hairs = cylinder(40)
    assert len(split(hairs)) == 1
    hairs.curve["roughness"] = np.linspace(0.1, 0.5, 40)
    shapes = split(hairs)
    assert [len(some) for some in shapes] == [10, 10, 10, 10]
    assert sorted(np.concatenate([some.ids for some in shapes]).tolist()) == hairs.ids.tolist()
    smooth, rough = cylinder(roughness=0.12, tilt=0.0), cylinder(roughness=0.4, tilt=0.0)
    both = cylinder(tilt=0.0)
    both.curve["roughness"] = np.where(both.roots[:, 0] < 0.0, 0.12, 0.4)
    light = seen(both)
    assert light[:, 6:20].max(axis=0).mean() == pytest.approx(seen(smooth)[:, 6:20].max(axis=0).mean(), rel=0.15)
    assert light[:, 28:42].max(axis=0).mean() == pytest.approx(seen(rough)[:, 28:42].max(axis=0).mean(), rel=0.15)
    assert light[:, 6:20].max() > 1.5 * light[:, 28:42].max()
