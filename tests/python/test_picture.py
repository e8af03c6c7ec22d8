"""Pictures: splines, framing, stills, contact sheets and refusals."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from PIL import Image
from ringlet.data.curves import Curves
from ringlet.data.errors import UserError
from ringlet.data.mesh import Mesh
from ringlet.data.picture import PictureSettings
from ringlet.picture import HAIR_COLORS, VIEWS, Pose, PosedBody, sheet, still
from ringlet.picture.bodies import material
from ringlet.picture.camera import frame
from ringlet.picture.engine import mitsuba
from ringlet.picture.hair_field import hair_field
from ringlet.picture.render import trace
from ringlet.picture.scene import build_scene
from ringlet.picture.sheet import subsample
from ringlet.picture.strands import fibres, load_fibres, spline_controls
from ringlet.picture.tone import develop
from scipy.interpolate import BSpline

QUICK = PictureSettings(width=64, height=64, samples=8, view="front")
TINY = PictureSettings(width=16, height=16, samples=16)


def helix(turns: float, per_turn: int, radius: float = 0.004) -> np.ndarray:
    """A helix along y, shape (n, 3)."""
    angle = 2 * np.pi * np.arange(round(turns * per_turn) + 1) / per_turn
    return np.stack([radius * np.cos(angle), 0.001 * angle, radius * np.sin(angle)], axis=1)


def tuft(count: int = 40, scale: float = 1.0, at: tuple[float, float, float] = (0.0, 0.0, 0.0)) -> Curves:
    """Parallel curls, 1 mm thick so that they cover pixels of small pictures."""
    curl = helix(5, 12)
    roots = np.stack([np.linspace(-0.06, 0.06, count), np.zeros(count), np.zeros(count)], axis=1)
    curves = Curves.from_list([scale * (curl + root) + at for root in roots])
    curves.point["width"] = np.full(len(curves.points), 1e-3 * scale)
    return curves


def ball(scale: float = 1.0, at: tuple[float, float, float] = (0.0, 0.0, 0.0), name: str = "ball") -> PosedBody:
    """An octahedron of radius 5 cm below the tuft."""
    corners = np.array([[1, 0, 0], [-1, 0, 0], [0, 1, 0], [0, -1, 0], [0, 0, 1], [0, 0, -1]], float)
    points = 0.05 * scale * corners - np.array([0, 0.05 * scale, 0]) + at
    triangles = [[0, 2, 4], [2, 1, 4], [1, 3, 4], [3, 0, 4], [2, 0, 5], [1, 2, 5], [3, 1, 5], [0, 3, 5]]
    return PosedBody(Mesh(name, points, np.array(triangles, np.int32), color=(0.4, 0.2, 0.1)), points)


def pixels(path: Path) -> np.ndarray:
    return np.asarray(Image.open(path), float)


# Curves


@pytest.mark.parametrize("count", [2, 3, 4, 50])
def test_the_spline_passes_through_every_point(count: int) -> None:
    points = np.random.default_rng(1).normal(size=(3, count, 3))
    controls = spline_controls(points)
    for curve, c in zip(points, controls, strict=True):
        knots = np.arange(-3, count + 3, dtype=float)
        assert BSpline(knots, c, 3)(np.arange(count)) == pytest.approx(curve, abs=1e-12)


def test_a_curl_of_twelve_points_a_turn_keeps_its_radius() -> None:
    curl = helix(4, 12)
    controls = spline_controls(curl[None])[0]
    along = np.linspace(6, len(curl) - 7, 500)  # without the straight ends
    drawn = BSpline(np.arange(-3, len(curl) + 3, dtype=float), controls, 3)(along)
    radius = np.hypot(drawn[:, 0], drawn[:, 2])
    assert radius.min() > 0.999 * 0.004
    uncorrected = BSpline(np.arange(-3, len(curl) + 1, dtype=float), curl, 3)(along)
    assert np.hypot(uncorrected[:, 0], uncorrected[:, 2]).max() < 0.96 * 0.004  # without the correction


def test_hairs_of_different_lengths_reach_the_renderer_whole() -> None:
    hairs = Curves.from_list([helix(2, 12), helix(1, 7), np.array([[0.0, 0, 0], [0, 0.01, 0]])])
    hairs.point["width"] = np.linspace(1e-4, 5e-5, len(hairs.points))
    controls, offsets = fibres(hairs, np.zeros(3))
    shape = load_fibres(mitsuba(), controls, offsets, {"type": "hair"})
    parameters = mitsuba().traverse(shape)
    loaded, guard = np.split(np.array(parameters["control_points"]).reshape(-1, 4), [len(controls)])
    assert np.array_equal(loaded, controls)
    assert guard[:, 3].max() < 1e-3 * controls[:, 3].min(), "the guard curve at the end of the list is invisible"
    assert len(np.array(parameters["segment_indices"])) == sum(len(hairs[k]) - 1 for k in range(3)) + 1
    for k in range(3):
        middle = controls[offsets[k] : offsets[k + 1]]
        knot = (middle[:-2, :3] + 4 * middle[1:-1, :3] + middle[2:, :3]) / 6
        assert knot == pytest.approx(hairs[k], abs=1e-8)
        widths = hairs.point["width"][hairs.offsets[k] : hairs.offsets[k + 1]]
        assert middle[1:-1, 3] == pytest.approx(0.5 * widths)


# Framing


@pytest.mark.parametrize("view", [*VIEWS, (217.0, 35.0)])
@pytest.mark.parametrize("scale", [0.01, 1.0, 100.0])
@pytest.mark.parametrize("aspect", [0.6, 1.0, 1.8])
def test_everything_is_in_the_frame_and_fills_it(view: str | tuple[float, float], scale: float, aspect: float) -> None:
    points = scale * (np.random.default_rng(3).normal(size=(200, 3)) * (1.0, 2.0, 0.5) + (30.0, -4.0, 9.0))
    seen = frame([points[:90], points[90:]], view=view, aspect=aspect, margin=0.05).project(points)
    assert seen.min() >= 0.05 - 1e-9
    assert seen.max() <= 0.95 + 1e-9
    assert np.ptp(seen, axis=0).max() == pytest.approx(0.9)  # one dimension fills the frame up to the margins


def test_the_front_view_looks_at_the_face_and_the_side_view_at_the_left_ear() -> None:
    head = np.random.default_rng(0).normal(size=(50, 3))
    assert frame([head], view="front").origin[2] > 5.0
    assert frame([head], view="side").origin[0] > 5.0
    assert frame([head], view="back").origin[2] < -5.0


# Stills


@pytest.mark.parametrize(("scale", "at"), [(1.0, (0.0, 0.0, 0.0)), (0.01, (3.0, -2.0, 1.0))])
def test_hair_appears_at_its_projected_position(tmp_path: Path, scale: float, at: tuple[float, float, float]) -> None:
    hairs, size = tuft(scale=scale, at=at), (64, 64)
    camera = frame([hairs.points], view="front")
    scene = build_scene([], hairs, camera, size=size, color=HAIR_COLORS["dark_brown"], max_depth=4)
    coverage = trace(scene, samples=16)[:, :, 3]
    expected = np.zeros(size, bool)
    where = np.clip((camera.project(hairs.points) * 64).astype(int), 0, 63)
    expected[where[:, 1], where[:, 0]] = True
    near = np.zeros(size, bool)  # pixels with hair points and their neighbours
    for dx in (-1, 0, 1):
        for dy in (-1, 0, 1):
            near |= np.roll(expected, (dy, dx), (0, 1))
    assert coverage[expected].mean() > 0.3
    assert coverage[~near].max() < 0.05


def test_a_still_is_neither_black_nor_overexposed_and_shows_the_hair(tmp_path: Path) -> None:
    path = still(Pose([ball()], tuft()), tmp_path / "still.png", QUICK)
    image = pixels(path)
    assert image.shape == (64, 64, 3)
    assert 20 < image.mean() < 235
    empty = still(Pose([ball()], tuft(2)), tmp_path / "empty.png", QUICK)
    assert np.abs(image - pixels(empty)).max() > 40


def test_a_body_shows_through_a_transparent_one(tmp_path: Path) -> None:
    near, far = ball(at=(0.0, 0.0, 0.12)), ball(0.8, at=(0.0, -0.01, 0.0))
    for body, color in ((near, (0.8, 0.02, 0.02)), (far, (0.02, 0.02, 0.8))):
        body.mesh = Mesh(body.mesh.name, body.mesh.points, body.mesh.triangles, color=color)
    blue = {}
    for opacity in (1.0, 0.3):
        near.opacity = opacity
        path = still(Pose([near, far], tuft(2)), tmp_path / "veil.png", replace(QUICK, width=48, height=48, samples=32))
        middle = pixels(path)[40:, 20:28].mean(axis=(0, 1))  # the near body covers the far one
        blue[opacity] = middle[2] / middle[0]
    assert blue[0.3] > 2 * blue[1.0]


def test_blond_hair_is_brighter_than_black(tmp_path: Path) -> None:
    hairs = tuft(60)
    camera = frame([hairs.points], view="front")
    light = {}
    for name in ("black", "blond"):
        scene = build_scene([], hairs, camera, size=(32, 32), color=HAIR_COLORS[name], max_depth=8)
        light[name] = trace(scene, samples=16)[:, :, :3].mean()
    assert light["blond"] > 1.5 * light["black"]


def fur(count: int, width: float) -> Curves:
    """Hairs of 8 cm in all directions over a square of 10 cm, of one diameter [m]."""
    random = np.random.default_rng(2)
    middles, turns = random.uniform(-0.05, 0.05, (count, 2)), random.uniform(0.0, np.pi, count)
    along = np.linspace(-0.04, 0.04, 8)[None, :, None] * np.stack([np.cos(turns), np.sin(turns)], 1)[:, None]
    flat = middles[:, None] + along
    hairs = Curves.from_list(list(np.concatenate([flat, random.uniform(-0.01, 0.01, (count, 8, 1))], axis=2)))
    hairs.point["width"] = np.full(len(hairs.points), width)
    return hairs


@pytest.mark.parametrize("width", [0.1e-3, 0.4e-3])
def test_hairs_thinner_than_a_pixel_cover_as_much_as_in_a_large_picture(width: float) -> None:
    """Pixels of 8 mm and of 0.5 mm: the hairs are from 1/80 to 4/5 of a pixel wide."""
    hairs, coverage = fur(200, width), {}
    camera = frame([hairs.points], view=(0.0, 0.0))
    for size, samples in ((20, 400), (320, 16)):
        scene = build_scene([], hairs, camera, size=(size, size), color=HAIR_COLORS["black"], max_depth=2)
        coverage[size] = np.array(mitsuba().render(scene.loaded, spp=samples))[:, :, 3].mean()
    assert coverage[20] == pytest.approx(coverage[320], rel=0.04)
    lone = 200 * 0.08 * width / (4 * np.prod(camera.slopes) * camera.distance**2)  # without overlaps
    assert 0.8 * lone < coverage[320] < 1.02 * lone


def test_a_part_of_the_hairs_covers_as_much_as_all() -> None:
    hairs, coverage = fur(600, 0.1e-3), []
    camera = frame([hairs.points], view=(0.0, 0.0))
    for shown in (hairs, subsample(hairs, 200)):
        scene = build_scene([], shown, camera, size=(40, 40), color=HAIR_COLORS["black"], max_depth=2)
        coverage.append(np.array(mitsuba().render(scene.loaded, spp=100))[:, :, 3].mean())
    assert coverage[1] == pytest.approx(coverage[0], rel=0.08)


def test_hairs_without_a_width_do_not_break_the_picture() -> None:
    hairs = tuft()
    hairs.point["width"][:] = 0.0
    camera = frame([hairs.points], view="front")
    scene = build_scene([], hairs, camera, size=(32, 32), color=HAIR_COLORS["black"], max_depth=2)
    assert trace(scene, samples=8)[:, :, 3].max() < 0.2


def test_a_still_reports_progress_and_respects_its_time_limit(tmp_path: Path) -> None:
    steps: list[tuple[str, int, int]] = []
    still(Pose([], tuft(4)), tmp_path / "a.png", TINY, progress=lambda *step: steps.append(step))
    assert [done for _, done, _ in steps] == list(range(steps[-1][2] + 1))
    for denoiser, passes in (("none", 1), ("oidn", 3)):  # a picture that asks for a denoiser gets one
        steps.clear()
        still(
            Pose([], tuft(4)),
            tmp_path / "b.png",
            replace(TINY, samples=10_000, seconds=0.0, denoiser=denoiser),
            progress=lambda *step: steps.append(step),
        )
        assert len(steps) == passes + 2  # start and end


@pytest.mark.parametrize("samples", [4, 40])
def test_a_time_limit_splits_a_still_into_smaller_passes(tmp_path: Path, samples: int) -> None:
    """With a time limit passes are smaller, since the noise estimate needs three."""
    passes = {}
    for seconds in (None, 8e4):
        steps: list[int] = []
        still(
            Pose([], tuft(4)),
            tmp_path / "a.png",
            replace(TINY, samples=samples, seconds=seconds),
            progress=lambda _, done, total, steps=steps: steps.append(done),
        )
        passes[seconds] = steps[-1]
    assert passes[8e4] >= (4 if samples == 4 else 1.5 * passes[None])


def test_hair_is_distinguished_from_skin() -> None:
    hairs = tuft()
    camera = frame([hairs.points, ball().points], view="front")
    scene = build_scene([ball()], hairs, camera, size=(64, 64), color=HAIR_COLORS["black"], max_depth=2)
    share = hair_field(mitsuba(), scene).share
    where = np.clip((camera.project(hairs.points) * 64).astype(int), 0, 63)
    assert share[where[:, 1], where[:, 0]].mean() > 0.4
    below = camera.project(ball().points[3:4])[0] * 64
    assert share[int(below[1]) - 6, int(below[0])] < 0.01


def test_shapes_are_numbered_hairs_first_then_bodies_then_lights() -> None:
    hairs, bodies = tuft(), [ball(), ball(0.5)]
    camera = frame([hairs.points, bodies[0].points], view="front")
    scene = build_scene(bodies, hairs, camera, size=(32, 32), color=HAIR_COLORS["black"], max_depth=2)
    names = [shape.id() for shape in scene.loaded.shapes()]
    assert names[: len(scene.hairs)] == ["hairs0"]
    assert names[1 : 1 + scene.bodies] == ["body0", "body1"]
    assert all(shape.is_emitter() for shape in scene.loaded.shapes()[3:])


def test_tone_mapping_is_monotone_and_compresses_highlights() -> None:
    ramp = np.linspace(0.0, 4.0, 400)[None, :, None].repeat(3, axis=2)
    values = develop(ramp)[0, :, 0].astype(int)
    assert values[0] <= 1
    assert (np.diff(values) >= -2).all()  # dithering changes values by one
    assert values[100] < 240  # radiance 1 is below white


def test_the_material_of_a_body_follows_its_name() -> None:
    eye = material(ball(name="head.usdc /child/eye_left/iris").mesh)["bsdf"]
    shirt = material(ball(name="head.usdc /child/shirt").mesh)["bsdf"]
    assert eye["roughness"] < shirt["roughness"]
    assert shirt["base_color"]["value"] == pytest.approx([0.4, 0.2, 0.1])


def test_a_body_shows_the_colours_of_its_vertices() -> None:
    body = ball()
    body.mesh.colors = np.zeros((6, 3))
    body.mesh.colors[1], body.mesh.colors[0] = (0.8, 0.0, 0.0), (0.0, 0.0, 0.8)  # red on the left, blue on the right
    camera = frame([body.points], view="front")
    scene = build_scene([body], None, camera, size=(32, 32), color=HAIR_COLORS["black"], max_depth=2)
    red, _, blue, _ = np.moveaxis(trace(scene, samples=8), 2, 0)
    assert red[:, :8].sum() > 1.5 * blue[:, :8].sum()
    assert blue[:, -8:].sum() > 1.5 * red[:, -8:].sum()


# Sheets


def test_a_sheet_has_a_tile_for_every_frame_and_shows_the_motion(tmp_path: Path) -> None:
    hairs = tuft()
    moved = hairs.with_points(hairs.points + np.array([0.15, 0.0, 0.0]))
    frames = [(1.0, [], hairs), (2.0, [], moved), (3.0, [], hairs)]
    path = sheet(
        frames, tmp_path / "sheet.png", columns=2, tile=(64, 48), samples=4, settings=PictureSettings(view="front")
    )
    image = pixels(path)
    assert image.shape[0] > 2 * 48
    assert image.shape[1] > 2 * 64
    first, second, third = image[10:58, 10:74], image[10:58, 84:148], image[92:140, 10:74]
    assert np.abs(first - third).mean() < 1.0  # the camera is fixed
    assert np.abs(first - second).mean() > 3.0


# Refusals


@pytest.mark.parametrize(
    ("options", "named"),
    [({"view": "below"}, "three_quarter"), ({"color": "green"}, "dark_brown"), ({"samples": 0}, "at least 1")],
)
def test_wrong_options_are_refused_by_name(tmp_path: Path, options: dict, named: str) -> None:
    with pytest.raises(UserError, match=named):
        still(Pose([ball()], tuft(2)), tmp_path / "still.png", PictureSettings(**options))
    assert list(tmp_path.iterdir()) == []


def test_an_empty_picture_is_refused(tmp_path: Path) -> None:
    with pytest.raises(UserError, match="neither hairs nor bodies"):
        still(Pose([], tuft(1).take(np.arange(0))), tmp_path / "still.png")
    with pytest.raises(UserError, match="no frames"):
        sheet([], tmp_path / "sheet.png")


def test_an_unwritable_picture_leaves_no_file(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("a file")
    with pytest.raises(UserError, match="cannot be written"):
        still(Pose([], tuft(1)), tmp_path / "file" / "still.png", TINY)
    assert [entry.name for entry in tmp_path.iterdir()] == ["file"]


def test_non_finite_points_are_refused(tmp_path: Path) -> None:
    hairs, body = tuft(3), ball()
    hairs.points[70] = np.nan
    with pytest.raises(UserError, match="curve 1, point 9"):
        still(Pose([], hairs), tmp_path / "still.png")
    with pytest.raises(UserError, match="frame 7: hairs: curve 1"):
        sheet([(7.0, [], hairs)], tmp_path / "sheet.png")
    with pytest.raises(UserError, match="ball: point 2"):
        PosedBody(body.mesh, np.where(np.arange(6)[:, None] == 2, np.inf, body.points))


def test_posed_points_must_fit_the_mesh() -> None:
    body = ball()
    with pytest.raises(UserError, match="must be"):
        PosedBody(body.mesh, body.points[:3])
