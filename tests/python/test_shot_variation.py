"""Varying materials: ramps along the strand, maps over the head and random variation of locks."""

import numpy as np
import pytest
from pxr import Sdf, Usd, UsdGeom, Vt
from ringlet.data.curves import Curves
from ringlet.data.errors import UserError
from ringlet.data.groom import Groom
from ringlet.data.mesh import Clip, Mesh
from ringlet.shot import parse_shot
from ringlet.sim import simulate
from ringlet.sim.shot_strands import make_strands
from ringlet.sim.variation import material_factors
from small_example import write_example, write_head

import ringlet
from ringlet import _core

SHOT = 'ringlet = 2\ngroom = "groom.usdc"\nframes = [1, 1]\npreroll = 0\n'
POINTS = 31


def groom(curve=None, point=None, maps=None):
    """Two straight horizontal strands of 6 cm on a patch, with roots at z = 0 and z = 10 cm."""
    mesh = Mesh(
        "patch",
        np.array([[0, 0, 0], [0.1, 0, 0], [0.1, 0, 0.1], [0, 0, 0.1]]),
        np.array([[0, 2, 1], [0, 3, 2]], np.int32),
        maps=maps or {},
    )
    along = np.c_[np.linspace(0, 0.06, POINTS), np.zeros((POINTS, 2))]
    locks = Curves.from_list([along + [0.05, 0, 0.0], along + [0.05, 0, 0.1]], ids=[7, 9])
    triangle, barycentric, _ = _core.bind_roots(mesh.points, mesh.triangles, locks.roots)
    locks.curve |= {"root_triangle": triangle, "root_barycentric": barycentric} | (curve or {})
    locks.point |= point or {}
    return Groom(locks, locks, mesh)


def factors(text, made):
    return material_factors(parse_shot(f"{SHOT}[variation]\n{text}"), made)


def settled(text, made=None):
    """Strands in equilibrium under gravity."""
    strands = make_strands(parse_shot(f"{SHOT}[variation]\n{text}"), made or groom())
    assert strands.settle(gravity=(0, -9.81, 0), tolerance=1e-8)
    return strands.positions.reshape(2, POINTS, 3)


def bent(points, first, last):
    """The angle between two edges of a strand [rad]."""
    a, b = (np.diff(points, axis=0)[k] for k in (first, last))
    return np.arctan2(np.linalg.norm(np.cross(a, b)), a @ b)


def test_a_shot_without_variation_has_no_factors():
    assert factors("", groom()) == {}


def test_a_strand_with_a_stiffer_root_bends_less_only_there():
    even, stiff = settled("")[0], settled("bend = { ramp = [[0, 4], [0.5, 4], [0.6, 1], [1, 1]] }")[0]
    assert bent(stiff, 2, 14) < 0.5 * bent(even, 2, 14)
    assert bent(stiff, 22, 29) > 0.9 * bent(even, 22, 29)


def test_a_ramp_counts_arc_length_from_root_to_tip():
    made = groom()
    bend = factors("bend = { value = 3, ramp = [[0, 1], [1, 2]] }", made)["bend"].reshape(2, POINTS)
    assert np.allclose(bend, 3 * (1 + np.linspace(0, 1, POINTS)))


@pytest.mark.parametrize(
    ("kind", "values"),
    [
        ("curve", [1.0, 8.0]),
        ("point", np.repeat([1.0, 8.0], POINTS)),
        ("maps", np.array([[1.0, 8.0, 1.0], [1.0, 8.0, 8.0]])),  # 1 along the edge z = 0, 8 along z = 10 cm
    ],
)
def test_a_map_makes_one_lock_stiffer_than_the_other(kind, values):
    made = groom(**{kind: {"stiff": np.array(values)}})
    assert np.allclose(factors('bend = { map = "stiff" }', made)["bend"], np.repeat([1, 8], POINTS))
    soft, stiff = settled('bend = { map = "stiff" }', made)
    assert soft[-1, 1] < 2 * stiff[-1, 1] < 0
    assert np.abs(soft - settled("")[0]).max() < 1e-12


def test_random_variation_depends_on_lock_and_seed():
    text = "damping = { value = 1, vary = 0.5 }"
    both = factors(text, groom())["damping"].reshape(2, POINTS)
    assert (both == both[:, :1]).all() and both[0, 0] != both[1, 0]
    made = groom()
    made.locks = made.locks.take(np.array([1]))
    assert (factors(text, made)["damping"] == both[1]).all()
    assert (factors(f"seed = 2\n{text}", made)["damping"] != both[1]).all()


def test_a_stiffer_material_sags_less_in_a_simulated_shot():
    made = groom()
    still = Clip(np.array([1.0]), made.scalp.points[None], 24.0)
    shot = SHOT.replace("preroll = 0", "preroll = 40")
    even, stiff = (simulate(parse_shot(shot + more), made, still) for more in ("", "[variation]\nbend = 5\n"))
    assert even.points[0, POINTS - 1, 1] < 2 * stiff.points[0, POINTS - 1, 1] < 0


def test_a_limp_lock_hangs_out_in_wind_by_its_air():
    """The tangent of its angle is drag by weight: twice the factor, twice the tangent."""
    text = "[strands]\nbend_scale = 1e-4\n[motion]\nair = { value = 2, lock = { 9 = 4 } }\n"
    strands, wind = make_strands(parse_shot(SHOT + text), groom()), 0.4
    assert strands.settle(gravity=(0, -9.81, 0), wind=(0, 0, wind), tolerance=1e-8)
    tips = np.diff(strands.positions.reshape(2, POINTS, 3)[:, -3:-1], axis=1)[:, 0]
    weight = 1300 * np.pi * 35e-6**2 * 9.81  # by length
    assert tips[:, 2] / -tips[:, 1] == pytest.approx(2e-5 * wind / weight * np.array([2, 4]), rel=0.01)


def test_air_varies_along_a_lock_and_multiplies_its_variation():
    text = "[variation]\ndrag = 3\n[motion]\nair = { ramp = [[0, 0], [1, 2]] }\n"
    plain, varied = (make_strands(parse_shot(SHOT + more), groom()).drag[1 : POINTS - 1] for more in ("", text))
    assert varied / plain == pytest.approx(3 * 2 * np.linspace(0, 1, POINTS)[1:-1])
    with pytest.raises(UserError, match=r"motion.air is .* on lock 7: strands.drag is"):
        make_strands(parse_shot(f"{SHOT}[strands]\ndrag = 1\n[motion]\nair = 1e4\n"), groom())


@pytest.mark.parametrize(
    ("text", "made", "words"),
    [
        ('bend = { map = "stif" }', groom(maps={"stiff": np.ones((2, 3))}), ["variation.bend.map", "stif", "'stiff'?"]),
        ('bend = { map = "zzz" }', groom(curve={"soft": np.ones(2)}), ["zzz", "patch", "there are: soft"]),
        ('bend = { map = "zzz" }', groom(), ["zzz", "paint"]),
        ('bend = { map = "m" }', groom(curve={"m": np.array([1.0, -2.0])}), ["bend", "-2", "lock 9", "at least 0"]),
        ('bend = { map = "m" }', groom(curve={"m": np.array([np.nan, 1.0])}), ["bend", "nan", "lock 7"]),
        ("radius = { ramp = [[0, 1], [1, 0]] }", groom(), ["variation.radius is 0", "lock 7", "more than"]),
        ("bend = -1", groom(), ["variation.bend", "-1", "at least 0"]),
        ("bend = { ramp = [[0, 1], [0, 2]] }", groom(), ["variation.bend.ramp", "ascend"]),
        ("bend = { ramp = [[0, 1], [1, 1e30]] }", groom(), ["variation.bend.ramp", "1e+30", "at most"]),
        (
            "bend = { value = 2, ramp = [[0, 1], [1, 1e6]] }",
            groom(),
            ["variation.bend", "2 times 1e+06", "at most 1e+06"],
        ),
        (
            "radius = { ramp = [[0, 1], [1, 1e-30]] }",
            groom(),
            ["variation.radius", "strands.radius", "more than 1e-07"],
        ),
        ("stretch = { ramp = [[0, 1], [1, 1e-7]] }", groom(), ["variation.stretch", "1e-07", "at least 1e-06"]),
        ("damping = { value = 1e5 }", groom(), ["variation.damping", "strands.damping is 500", "at most 100"]),
        ('bend = { map = "m" }', groom(curve={"m": np.array([1.0, 1e30])}), ["variation.bend", "1e+30", "lock 9"]),
        ('radius = { map = "m" }', groom(curve={"m": np.array([1.0, 1e-30])}), ["strands.radius", "lock 9"]),
        ('bend = { map = "m" }', groom(point={"m": np.full(2 * POINTS, 1e30)}), ["strands.bend_scale", "lock 7"]),
        ("bned = 2", groom(), ["variation.bned", "'bend'"]),
    ],
)
def test_invalid_variation_is_refused_in_one_line(text, made, words):
    with pytest.raises(UserError) as caught:
        factors(text, made)
    assert "\n" not in str(caught.value)
    for word in words:
        assert word in str(caught.value)


@pytest.mark.parametrize("interpolation", ["constant", "uniform", "vertex", "faceVarying"])
def test_floats_painted_on_the_scalp_are_read_as_maps(tmp_path, interpolation):
    head = write_head(tmp_path / "head.usda")
    stage = Usd.Stage.Open(str(head))
    mesh = UsdGeom.Mesh(stage.GetPrimAtPath("/ball/skin"))
    points = np.array(mesh.GetPointsAttr().Get())[:, 1]
    faces = np.array(mesh.GetFaceVertexIndicesAttr().Get())
    values = {
        "constant": [2.5],
        "uniform": points[faces].reshape(-1, 3).mean(axis=1),
        "vertex": points,
        "faceVarying": points[faces],
    }[interpolation]
    primvar = UsdGeom.PrimvarsAPI(mesh).CreatePrimvar("height", Sdf.ValueTypeNames.FloatArray, interpolation)
    primvar.Set(Vt.FloatArray.FromNumpy(np.array(values, np.float32)))
    stage.Save()
    read = ringlet.build_groom(write_example_recipe(tmp_path)).scalp
    height = 100 * read.points[read.triangles][:, :, 1]
    expected = {"constant": 0 * height + 2.5, "uniform": 0 * height + height.mean(axis=1, keepdims=True)}
    assert np.allclose(read.maps["height"], expected.get(interpolation, height), atol=1e-5)


def write_example_recipe(folder):
    """The recipe of the small example on the head in ``folder``."""
    other = write_example(folder / "other")
    recipe = (other / "small.recipe.toml").read_text().replace("head.usda", "../head.usda")
    (other / "small.recipe.toml").write_text(recipe)
    return other / "small.recipe.toml"


def test_floats_painted_on_the_locks_of_a_groom_file_are_maps(tmp_path):
    folder = write_example(tmp_path)
    ringlet.write_groom(ringlet.build_groom(folder / "small.recipe.toml"), tmp_path / "groom.usdc")
    stage = Usd.Stage.Open(str(tmp_path / "groom.usdc"))
    api = UsdGeom.PrimvarsAPI(stage.GetPrimAtPath("/groom/locks"))
    counts = np.array(UsdGeom.Curves(api.GetPrim()).GetCurveVertexCountsAttr().Get())
    per_lock = np.arange(1.0, len(counts) + 1)
    api.CreatePrimvar("stiff", Sdf.ValueTypeNames.FloatArray, "uniform").Set(per_lock.tolist())
    stage.Save()
    made = ringlet.read_groom(tmp_path / "groom.usdc")
    assert np.allclose(factors('bend = { map = "stiff" }', made)["bend"], np.repeat(per_lock, counts))
