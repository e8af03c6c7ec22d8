"""Far from the origin of coordinates hair is as exact as near it: its prims have a translation."""

from __future__ import annotations

import numpy as np
import pytest
from commands import run
from pages import page, serving
from PIL import Image
from pxr import Gf, Usd, UsdGeom
from ringlet.data.cache import Cache, Touches
from small_example import FRAMES, write_example, write_head
from wear import SCARF, write_wear

import ringlet
from ringlet import io

MICRON = 1e-6
CONTACT = "[solver]\nuntil_converged = true\n[contact]\nradius = 7e-3\n"
STILL = np.zeros(3)
FAR = np.array([1234.567, -321.0, 987.654])  # [m], Y-up


def place(file, at, *, moving=STILL):
    """Moves everything in a file to a place [m], Y-up, and by ``moving`` [m] more until the last frame."""
    stage = Usd.Stage.Open(str(file))
    unit, is_z = UsdGeom.GetStageMetersPerUnit(stage), UsdGeom.GetStageUpAxis(stage) == "Z"
    root = UsdGeom.Xformable(stage.GetDefaultPrim())
    operation = root.AddTranslateOp(opSuffix="there")
    root.SetXformOpOrder([operation, *root.GetOrderedXformOps()[:-1]])

    def vector(point):
        x, y, z = point / unit
        return Gf.Vec3d(x, -z, y) if is_z else Gf.Vec3d(x, y, z)

    operation.Set(vector(at))
    for frame in range(1, FRAMES + 1) if moving.any() else ():
        operation.Set(vector(at + moving * (frame - 1) / (FRAMES - 1)), frame)
    stage.Save()


def shot(folder, at=None, *, unit=0.01, up="Y", more=CONTACT, moving=STILL):
    """Groom, cache and hairs of the small example at a place."""
    write_example(folder)
    write_head(folder / "head.usda", unit=unit, up=up)
    file = folder / "small.shot.toml"
    file.write_text(file.read_text() + more)
    if more == SCARF:
        write_wear(folder)
    if at is not None:
        place(folder / "head.usda", at, moving=moving)
        if more == SCARF:
            place(folder / "wear.usda", at)
    contacts = ("--contacts", folder / "touches.usdc") if more == CONTACT else ()
    for one in (
        ("sim", file, "-o", folder / "cache.usdc", *contacts),
        ("hair", folder / "cache.usdc", "-o", folder / "hair.usdc"),
    ):
        result = run(*one)
        assert result.exit_code == 0, result.output
    return folder


def world_points(file, prim, frame):
    """Positions of a prim in another program [m], in the axes of the file."""
    stage = Usd.Stage.Open(str(file))
    found = stage.GetPrimAtPath(prim)
    matrix = np.array(UsdGeom.XformCache(frame).GetLocalToWorldTransform(found))
    points = np.array(UsdGeom.PointBased(found).GetPointsAttr().Get(frame), np.float64)
    return (points @ matrix[:3, :3] + matrix[3, :3]) * UsdGeom.GetStageMetersPerUnit(stage)


def drawn(folder):
    """A small still of the hairs, shape (h, w, 3)."""
    ringlet.write_still(folder / "hair.usdc", folder / "still.png", width=48, height=48, samples=4)
    return np.asarray(Image.open(folder / "still.png"), np.float64)


@pytest.fixture(scope="module")
def near(tmp_path_factory):
    return shot(tmp_path_factory.mktemp("near"))


@pytest.mark.parametrize(("unit", "up"), [(0.01, "Y"), (0.0254, "Z")])
def test_hair_is_the_same_to_a_micrometre_a_kilometre_away(near, tmp_path, unit, up):
    far = shot(tmp_path, FAR, unit=unit, up=up)
    one, other = (ringlet.read_groom(folder / "cache.usdc") for folder in (near, far))
    for name in ("locks", "guides"):
        assert np.abs(getattr(other, name).points - getattr(one, name).points - FAR).max() < MICRON
    caches = [ringlet.read_cache(folder / "cache.usdc").points for folder in (near, far)]
    assert np.abs(caches[1] - caches[0] - FAR).max() < MICRON
    for frame in (2, FRAMES):
        hairs = [io.read_hairs(folder / "hair.usdc", frame).points for folder in (near, far)]
        assert np.abs(hairs[1] - hairs[0] - FAR).max() < 2 * MICRON
    if (unit, up) == (0.01, "Y"):
        for file, prim in (("cache", "locks"), ("hair", "hairs")):
            points = [world_points(folder / f"{file}.usdc", f"/groom/{prim}", 2) for folder in (near, far)]
            assert np.abs(points[1] - points[0] - FAR).max() < 2 * MICRON
            assert io.problems(far / f"{file}.usdc") == io.problems(near / f"{file}.usdc")
        pictures = [drawn(folder) for folder in (near, far)]
        assert pictures[0].std() > 10 and np.abs(pictures[1] - pictures[0]).mean() < 0.5


def test_contacts_a_kilometre_away_keep_their_places(near, tmp_path):
    places = np.random.default_rng(1).uniform(-0.1, 0.1, (20, 3)) + FAR
    force = np.ones(20, np.float32)
    cache = Cache(np.array([2.0]), np.empty((1, 0, 3)), touches=[Touches(places, force, force)])
    ringlet.write_touches(cache, near / "cache.usdc", tmp_path / "touches.usdc")
    assert np.abs(io.read_touches(tmp_path / "touches.usdc", 2)[0].places - places).max() < MICRON
    assert np.abs(world_points(tmp_path / "touches.usdc", "/groom/touches", 2) - places).max() < MICRON


def test_near_the_origin_no_translation_is_authored(near):
    stage = Usd.Stage.Open(str(near / "hair.usdc"))
    for name in ("locks", "guides", "hairs"):
        assert UsdGeom.Xformable(stage.GetPrimAtPath(f"/groom/{name}")).GetOrderedXformOps() == []
    assert ringlet.read_cache(near / "cache.usdc").points.dtype == np.float32


@pytest.mark.parametrize("start", [np.zeros(3), FAR])
def test_a_head_that_travels_far_takes_the_origin_of_its_hair_along(tmp_path, start):
    flight = np.array([3000.0, 0.0, -600.0])  # [m]
    folder = shot(tmp_path, start, more="", moving=flight)
    groom = ringlet.read_groom(folder / "cache.usdc")
    with ringlet.open_cache(folder / "cache.usdc") as cache:
        clip = io.read_clip(groom.scalp_file, groom.scalp_prim)
        corners = groom.scalp.triangles[groom.locks.curve["root_triangle"]]
        for frame in (*cache.frames, 1.5, 3.25):
            scalp = clip.at(frame)[corners]
            roots = np.einsum("nk,nkd->nd", groom.locks.curve["root_barycentric"], scalp)
            assert np.abs(cache.points(frame)[groom.locks.offsets[:-1]] - roots).max() < MICRON
            lock = world_points(folder / "cache.usdc", "/groom/locks", frame)
            assert np.abs(lock - cache.points(frame)).max() < MICRON
            hairs = world_points(folder / "hair.usdc", "/groom/hairs", frame)[:: groom.locks.counts[0]][::3]
            assert np.abs(hairs - roots).max() < MICRON  # the first hair of a lock is the lock


def test_cloth_a_kilometre_away_is_exact_too(tmp_path):
    clothed = [shot(tmp_path / name, at, more=SCARF) for name, at in (("near", None), ("far", FAR))]
    near, far = (ringlet.read_cache(folder / "cache.usdc").cloths[0].points for folder in clothed)
    assert np.abs(far - near - FAR).max() < MICRON
    world = [world_points(folder / "cache.usdc", "/groom/cloths/wear/scarf", FRAMES) for folder in clothed]
    assert np.abs(world[1] - world[0] - FAR).max() < MICRON


def test_a_loft_a_kilometre_away_is_current_and_the_same(tmp_path):
    lofts = []
    for name, at in (("near", np.zeros(3)), ("far", FAR)):
        folder = write_example(tmp_path / name)
        place(folder / "head.usda", at)
        file = folder / "small.shot.toml"
        file.write_text(file.read_text() + '[rest]\nmode = "lofted"\n')
        assert run("loft", file).exit_code == 0
        assert run("sim", file, "-o", folder / "cache.usdc").exit_code == 0
        lofts.append(io.read_rest(folder / "small.rest.usdc")[0])
    assert np.abs(lofts[1].points - lofts[0].points - FAR).max() < MICRON
    assert np.abs(lofts[1].point["groomed"] - lofts[0].point["groomed"] - FAR).max() < MICRON


def shown(folder):
    """What the review shows of the small shot: locks, head and guides, locks after a drag of the brush, and a frame."""
    with serving(folder, "small.shot.toml") as client, page(client) as one:
        guides, body = one.receive("guides"), one.latest("body")
        before = one.latest("locks", draft=False)["points"]
        one.latest("numbers", draft=False)
        tip = guides["points"].reshape(-1, 3)[guides["offsets"][1] - 1].tolist()
        one.send(kind="sculpt", tool="comb", radius=0.02, gesture=7, at=tip, by=[0.01, 0, 0])
        after = one.receive("locks", draft=False)["points"]
        one.send(kind="play", action="start")
        (frame,) = one.watch(2)
        places = [guides["points"], guides["middle"], body["points"], before, after, frame["points"], frame["bodies"]]
        return [np.array(points, np.float64).reshape(-1, 3) for points in places]


def test_the_review_shows_a_head_a_kilometre_away_like_one_nearby(tmp_path):
    near, far = (write_example(tmp_path / name) for name in ("near", "far"))
    place(far / "head.usda", FAR)
    whole = np.round(FAR)
    both = list(zip(shown(near), shown(far), strict=True))
    assert np.abs(both[4][0] - both[3][0]).max() > 0.002  # the brush has moved something
    for one, other in both:
        assert np.abs(other - one - (FAR - whole)).max() < 2 * MICRON
