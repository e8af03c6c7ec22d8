"""Hair that fits on a disk: hairs on demand, levels of detail, and the share that a camera needs."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
from commands import edit, refused, run
from PIL import Image
from pxr import Gf, Sdf, Usd, UsdGeom
from ringlet.data.detail import HAIR_PIXELS, LEVELS, screen_share
from ringlet.data.share import share
from ringlet.viewer.show.scene import open_frames, read_scene
from test_several_grooms import SEVERAL

import ringlet
from ringlet import io

TOLERANCE = 1e-5  # of hairs on demand, against those with points; strays are 1 cm off their lock [m]
COIL = """
[hairs]
per_lock = 12
density = 2
stray = 0.3
stray_distance = 1

[hairs.families]
count = 3

[hairs.curl]
escape = 0.2
relax = 0.3
"""


def hairs(folder: Path, *options: object, name: str = "made.usdc", source: str = "cache.usdc") -> Path:
    """Writes hairs in a folder; returns their path."""
    result = run("hair", folder / source, "-o", folder / name, *options)
    assert result.exit_code == 0, result.output
    return folder / name


def assert_same(one: Path, other: Path, frame: float | None) -> None:
    """The hairs of two files are the same at a frame, with their widths and attributes."""
    a, b = io.read_hairs(one, frame), io.read_hairs(other, frame)
    assert np.array_equal(a.ids, b.ids) and np.array_equal(a.offsets, b.offsets)
    assert np.abs(a.points - b.points).max() < TOLERANCE
    assert a.curve.keys() == b.curve.keys() and a.point.keys() == b.point.keys()
    for kind in ("curve", "point"):
        for name, values in getattr(a, kind).items():
            assert np.allclose(values, getattr(b, kind)[name], rtol=2e-4, atol=1e-7), name


@pytest.fixture(scope="module")
def curled(tmp_path_factory):
    """The small example whose hairs have families, curls and strays of their own, with its cache and its hairs."""
    from small_example import write_example

    folder = write_example(tmp_path_factory.mktemp("curled"))
    edit(folder / "small.recipe.toml", "[hairs]\nper_lock = 3\n", COIL)
    for arguments in (
        ("groom", folder / "small.recipe.toml", "-o", folder / "groom.usdc"),
        ("sim", folder / "small.shot.toml", "--groom", folder / "groom.usdc", "-o", folder / "cache.usdc"),
    ):
        assert (result := run(*arguments)).exit_code == 0, result.output
    hairs(folder, name="full.usdc")
    hairs(folder, "--on-demand", name="demand.usdc")
    return folder


# On demand


@pytest.mark.parametrize("frame", [None, 1.0, 3.0, 4.0])
def test_hairs_on_demand_are_those_with_points(curled, frame):
    assert_same(curled / "full.usdc", curled / "demand.usdc", frame)
    assert io.read_hair_frames(curled / "demand.usdc").tolist() == io.read_hair_frames(curled / "full.usdc").tolist()


def test_hairs_on_demand_at_rest_are_those_with_points(curled):
    full = hairs(curled, name="rest.usdc", source="groom.usdc")
    made = hairs(curled, "--on-demand", name="rest_demand.usdc", source="groom.usdc")
    assert_same(full, made, None)
    assert not len(io.read_hair_frames(made))


def test_hairs_of_several_grooms_are_made_on_demand_each(copy):
    (copy / "several.recipe.toml").write_text(SEVERAL)
    assert run("groom", copy / "several.recipe.toml", "-o", copy / "groom.usdc").exit_code == 0
    full = hairs(copy, name="full.usdc", source="groom.usdc")
    made = hairs(copy, "--on-demand", name="demand.usdc", source="groom.usdc")
    assert_same(full, made, None)
    stage = Usd.Stage.Open(str(made))
    assert [prim.GetName() for prim in stage.GetPrimAtPath("/groom/hairs").GetChildren()] == ["hair", "brows"]
    assert not io.problems(made)


def test_hairs_on_demand_are_expanded_to_the_same_file_layout(curled):
    again = hairs(curled, name="expanded.usdc", source="demand.usdc")
    assert_same(curled / "full.usdc", again, 3.0)
    prims = [Usd.Stage.Open(str(curled / name)) for name in ("full.usdc", "expanded.usdc")]
    one, other = ({a.GetName() for a in stage.GetPrimAtPath("/groom/hairs").GetAuthoredProperties()} for stage in prims)
    assert one == other
    layers = [layer.identifier for layer in prims[1].GetLayerStack()]
    assert not any("demand" in name for name in layers)


def test_convert_expands_hairs_on_demand(curled):
    for name in ("full", "demand"):
        result = run("convert", curled / f"{name}.usdc", curled / f"{name}.out.usdc", "--json")
        assert result.exit_code == 0, result.output
        counts = json.loads(result.stdout)
        assert counts["hairs"] == len(io.read_hairs(curled / "full.usdc")) and counts["frames"] == 4
    with io.open_scene(curled / "full.out.usdc") as a, io.open_scene(curled / "demand.out.usdc") as b:
        one, other = (next(s for s in scene.sets if s.name == "hairs") for scene in (a, b))
        assert np.abs(one.points(3.0) - other.points(3.0)).max() < TOLERANCE
        assert np.abs(one.points(3.0) - one.points(1.0)).max() > 1e-3


def test_pictures_take_hairs_on_demand(curled, tmp_path):
    pictures = []
    for name in ("full", "demand"):
        picture = tmp_path / f"{name}.png"
        ringlet.write_still(curled / f"{name}.usdc", picture, frame=2, width=48, samples=8, denoiser="none")
        pictures.append(np.asarray(Image.open(picture), float))
    assert np.abs(pictures[0] - pictures[1]).mean() < 0.05 * pictures[0].std()


def test_the_page_shows_a_file_of_hairs_on_demand(curled):
    bodies, display = read_scene(curled / "demand.usdc")
    assert bodies and len(display.hairs.curves) == len(io.read_hairs(curled / "full.usdc"))
    with open_frames(curled / "demand.usdc", display) as (frames, read):
        assert frames.tolist() == [1, 2, 3, 4]
        assert np.isfinite(read(3.0).points).all()


def test_extents_contain_hairs_on_demand(curled):
    stage = Usd.Stage.Open(str(curled / "demand.usdc"))
    prim = stage.GetPrimAtPath("/groom/hairs")
    low, high = np.array(UsdGeom.Boundable(prim).GetExtentAttr().Get(3.0)) * 0.01
    points = io.read_hairs(curled / "full.usdc", 3.0).points
    assert (points >= low - TOLERANCE).all() and (points <= high + TOLERANCE).all()
    assert np.linalg.norm(high - low) < 1.2 * np.linalg.norm(np.ptp(points, axis=0))


def test_hairs_on_demand_take_few_bytes(curled):
    full, made = ((curled / name).stat().st_size for name in ("full.usdc", "demand.usdc"))
    assert made < full / 4


def test_hairs_on_demand_of_another_groom_are_refused(copy):
    assert run("groom", copy / "small.recipe.toml", "-o", copy / "groom.usdc").exit_code == 0
    made = hairs(copy, "--on-demand", source="groom.usdc")
    edit(copy / "small.recipe.toml", "count = 8", "count = 9")
    assert run("groom", copy / "small.recipe.toml", "-o", copy / "groom.usdc").exit_code == 0
    refused(run("render", made, "-o", copy / "x.png"), "other locks", "make the hairs again")


@pytest.mark.parametrize("name", ["tip", "profile", "thinning", "frizz", "width"])
def test_damaged_hairs_on_demand_are_refused(copy, name):
    assert run("groom", copy / "small.recipe.toml", "-o", copy / "groom.usdc").exit_code == 0
    made = hairs(copy, "--on-demand", source="groom.usdc")
    layer = Sdf.Layer.FindOrOpen(str(made))
    attribute = layer.GetAttributeAtPath(f"/groom/hairs.primvars:ringlet:layout:{name}")
    attribute.default = type(attribute.default)(attribute.default[:-1])
    layer.Save()
    refused(run("convert", made, copy / "x.usdc"), "damaged", "--on-demand")
    assert not (copy / "x.usdc").exists()


# Parts of a clip


def test_parts_of_a_clip_have_the_velocities_of_the_whole(curled):
    def velocities(frames: str) -> dict[float, np.ndarray]:
        path = hairs(curled, "--velocities", "--frames", frames, name=f"part{frames.replace(':', '_')}.usdc")
        stage = Usd.Stage.Open(str(path))
        curves = UsdGeom.BasisCurves.Get(stage, "/groom/hairs")
        found = curves.GetVelocitiesAttr()
        assert found.GetTimeSamples() == curves.GetPointsAttr().GetTimeSamples()
        return {time: np.array(found.Get(time)) for time in found.GetTimeSamples()}

    whole = velocities("1:4")
    assert [*whole] == [1.0, 2.0, 3.0, 4.0] and np.abs(whole[2.0] - whole[3.0]).max() > 0.0
    for frames, times in {"1:2": [1.0, 2.0], "2": [2.0], "3": [3.0], "3:4": [3.0, 4.0], "4": [4.0]}.items():
        part = velocities(frames)
        assert [*part] == times
        for time in times:
            np.testing.assert_array_equal(part[time], whole[time])


# Levels of detail


def test_levels_of_detail_are_variants_of_the_hairs(curled):
    path = hairs(curled, "--lod", "--velocities", name="lod.usdc")
    stage = Usd.Stage.Open(str(path))
    prim = stage.GetPrimAtPath("/groom/hairs")
    choice = prim.GetVariantSets().GetVariantSet("LOD")
    assert choice.GetVariantNames() == [f"LOD{k}" for k in range(len(LEVELS))]
    assert choice.GetVariantSelection() == "LOD0"
    full, counts = io.read_hairs(curled / "full.usdc", 2.0), []
    for name in choice.GetVariantNames():
        choice.SetVariantSelection(name)
        curves = UsdGeom.BasisCurves(prim)
        points = np.array(curves.GetPointsAttr().Get(2.0)) * 0.01
        assert curves.GetPointsAttr().GetNumTimeSamples() == 4 and curves.GetVelocitiesAttr().GetNumTimeSamples() == 4
        assert prim.GetRelationship("material:binding").GetTargets() == ["/groom/materials/hairs"]
        assert np.abs(points.mean(axis=0) - full.points.mean(axis=0)).max() < 5e-3
        counts.append(len(curves.GetCurveVertexCountsAttr().Get()))
    assert counts == sorted(counts, reverse=True) and counts[0] == len(full)
    assert_same(curled / "full.usdc", path, 2.0)
    assert not io.problems(path)


@pytest.fixture(scope="module")
def example():
    return ringlet.build_groom(share("examples/child") / "ribbon.recipe.toml")


def shadow(curves, pixel: float) -> np.ndarray:
    """Part of each pixel [m] that hairs cover as seen from the front: 1 - exp(-Σ w l / A) (Kajiya and Kay 1989)."""
    points = curves.points.reshape(len(curves), -1, 3)[..., :2]
    begin, along = points[:, :-1] - curves.points[:, :2].mean(axis=0), np.diff(points, axis=1)
    area = np.linalg.norm(along, axis=2) * curves.point["width"].reshape(len(curves), -1)[:, 1:]
    size, pieces = int(0.6 / pixel), int(np.ceil(2.0 * np.linalg.norm(along, axis=2).max() / pixel))
    depth = np.zeros(size * size)
    for k in range(pieces):
        at = ((begin + (k + 0.5) / pieces * along) / pixel).astype(int) + size // 2
        depth += np.bincount((at[..., 0] * size + at[..., 1]).ravel(), area.ravel() / pieces, size * size)
    return 1.0 - np.exp(-depth / pixel**2)


def test_levels_of_detail_cover_as_much_as_all_hairs_where_they_are_used(example):
    full = ringlet.build_hairs(example).curves
    for level in LEVELS[1:]:
        made = ringlet.build_hairs(example, fraction=level.share, wider=True, point_share=level.points).curves
        pixel = float(made.point["width"].max()) / HAIR_PIXELS
        some, every = shadow(made, pixel), shadow(full, pixel)
        assert some.sum() == pytest.approx(every.sum(), rel=0.04)


def test_two_thirds_of_the_points_keep_the_curve_to_a_fifth_of_a_millimetre(example):
    full = ringlet.build_hairs(example, fraction=0.05).curves
    less = ringlet.build_hairs(example, fraction=0.05, point_share=2 / 3).curves
    n, m = int(full.counts[0]), int(less.counts[0])
    assert m == round(2 / 3 * n)
    at = np.linspace(0, m - 1, 10 * m)
    points = less.points.reshape(-1, m, 3).astype(float)
    fine = catmull_rom(points, at)
    original = catmull_rom(full.points.reshape(-1, n, 3).astype(float), np.linspace(0, n - 1, 10 * m))
    off = np.linalg.norm(fine - original, axis=2)
    assert np.quantile(off, 0.95) < 2e-4


def catmull_rom(points: np.ndarray, at: np.ndarray) -> np.ndarray:
    """Points of pinned Catmull-Rom curves, shape (curves, n, 3), at parameters from 0 to n - 1."""
    ends = [2 * points[:, :1] - points[:, 1:2], points, 2 * points[:, -1:] - points[:, -2:-1]]
    p = np.concatenate(ends, axis=1)
    i = np.minimum(at.astype(int), points.shape[1] - 2)
    t = (at - i)[None, :, None]
    a, b, c, d = (p[:, i + k] for k in range(4))
    return b + 0.5 * t * (c - a + t * (2 * a - 5 * b + 4 * c - d + t * (3 * (b - c) + d - a)))


# The share that a camera needs


def with_camera(folder: Path, distance: float) -> Path:
    """A layer over the cache with a camera that looks at the head from the front, from a distance [m]."""
    path = folder / "seen.usda"
    path.unlink(missing_ok=True)
    layer = Sdf.Layer.CreateNew(str(path))
    layer.subLayerPaths.append("./cache.usdc")
    stage = Usd.Stage.Open(layer)
    UsdGeom.SetStageMetersPerUnit(stage, 0.01)
    stage.SetTimeCodesPerSecond(24)
    camera = UsdGeom.Camera.Define(stage, "/shot_camera")
    camera.CreateFocalLengthAttr(50.0)
    camera.CreateHorizontalApertureAttr(36.0)
    UsdGeom.Xformable(camera).AddTranslateOp().Set(Gf.Vec3d(0, 0, 100 * distance))
    stage.Save()
    return path


def test_a_camera_far_away_needs_fewer_and_wider_hairs(curled):
    near, far = 0.5, 30.0
    made = {}
    for distance in (near, far):
        with_camera(curled, distance)
        camera = "--camera", "/shot_camera", "--camera-file", curled / "seen.usda"
        made[distance] = run("hair", curled / "cache.usdc", "-o", curled / f"seen_{distance:g}.usdc", *camera, "--json")
    full = io.read_hairs(curled / "full.usdc")
    for distance, result in made.items():
        assert result.exit_code == 0, (distance, result.output)
    fractions = [json.loads(result.stdout)["fraction"] for result in made.values()]
    assert fractions[1] < 0.1 < fractions[0]
    assert len(io.read_hairs(curled / "seen_30.usdc")) < 0.5 * len(full)


def test_the_share_follows_the_width_on_the_screen():
    from ringlet.data.camera import Camera

    camera = Camera(np.zeros(3), np.eye(3), 1.0, (0.36, 0.2))
    width = 1e-4
    assert screen_share(width, 0.05, camera, 1920) == 1.0
    share_at = screen_share(width, 5.0, camera, 1920)
    on_screen = width / share_at / (2 * 0.36 * 5.0) * 1920
    assert on_screen == pytest.approx(HAIR_PIXELS)
    assert screen_share(width, 5.0, camera, 960) == pytest.approx(0.5 * share_at)
    assert screen_share(width, -1.0, camera, 1920) == 1.0


# Refusals


@pytest.mark.parametrize(
    ("options", "words"),
    [
        (("--lod", "--on-demand"), "--lod does not go together with --on-demand"),
        (("--lod", "--fraction", "0.5"), "--lod does not go together with --fraction"),
        (("--on-demand", "--velocities"), "--on-demand does not go together with --velocities"),
        (("--camera", "/nobody"), "has no prim /nobody"),
    ],
)
def test_options_that_contradict_are_refused(curled, options, words):
    refused(run("hair", curled / "cache.usdc", "-o", curled / "x.usdc", *options), words)
    assert not (curled / "x.usdc").exists()


def test_made_hairs_are_not_thinned_again(curled):
    refused(run("hair", curled / "demand.usdc", "-o", curled / "x.usdc", "--lod"), "made already")
