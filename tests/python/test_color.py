"""Colour of hair: pigments, recipes, primvars and pictures."""

from __future__ import annotations

import json
from pathlib import Path
from typing import get_args

import numpy as np
import pytest
from PIL import Image
from pxr import Usd, UsdGeom
from ringlet.data.curves import Curves
from ringlet.data.errors import UserError
from ringlet.data.picture import PictureSettings
from ringlet.data.pigment import (
    HAIR_COLORS,
    absorption,
    absorption_of,
    concentration,
    curve_reflectance,
    display_color,
    linear_color,
    melanin_of,
    reflectance,
)
from ringlet.groom.color import Preset
from ringlet.io import HairWriter, read_groom, read_hairs, write_groom
from ringlet.picture import Pose, sheet, still
from ringlet.picture.camera import frame
from ringlet.picture.engine import mitsuba
from ringlet.picture.fiber import fiber_bsdf
from ringlet.picture.render import trace
from ringlet.picture.scene import build_scene
from ringlet.picture.sheet import GAP
from ringlet.picture.strands import load_fibres
from shapes import ball
from test_picture import tuft

from ringlet.groom import HairMemory, lay_hairs, make_groom, make_hairs, parse_recipe

RECIPE = """
ringlet = 2
[scalp]
region = "scalp"
[guides]
count = 20
[locks]
count = 60
points = 40
[curl]
preset = "3C"
curls = 5
[hairs]
per_lock = 10
"""


def groom(tables="", recipe=RECIPE):
    return make_groom(parse_recipe(recipe + tables), ball())


def hairs(tables="", **options):
    return make_hairs(groom(tables), **options).curves


def per_point(curves, name):
    return curves.point[name].reshape(len(curves), -1)


# Pigments


def test_absorption_is_that_of_the_published_pigments():
    one = melanin_of(1.0)  # at a concentration of 1
    assert absorption(one, 0.0) == pytest.approx([0.419, 0.697, 1.37], rel=1e-12)
    assert absorption(one, 1.0) == pytest.approx([0.187, 0.4, 1.05], rel=1e-12)
    half = melanin_of(0.5)
    assert absorption(half, 0.5) == pytest.approx(0.25 * np.array([0.606, 1.097, 2.42]), rel=1e-12)


def test_the_colour_of_dense_hair_is_that_of_chiang_et_al():
    # σ = (ln C / D(β))², with D(0.3) = 5.88841 by the polynomial of the paper.
    assert absorption_of(0.5, 0.3) == pytest.approx((np.log(0.5) / 5.88841) ** 2, rel=1e-5)
    colors = np.array([[0.001, 0.2, 0.99], [0.03, 0.4, 0.7]])
    assert reflectance(absorption_of(colors, 0.45), 0.45) == pytest.approx(colors, rel=1e-12)


def test_white_hair_has_no_pigment_and_black_hair_a_finite_amount():
    assert concentration(0.0) == 0.0
    assert np.isfinite(concentration(1.0))
    assert reflectance(absorption(0.0, 0.5), 0.3) == pytest.approx([1.0, 1.0, 1.0])
    assert melanin_of(concentration([0.1, 0.5, 0.99])) == pytest.approx([0.1, 0.5, 0.99])


def test_srgb_is_decoded():
    assert linear_color("#ff8000") == pytest.approx([1.0, 0.21586, 0.0], abs=1e-5)


def test_the_presets_of_recipes_are_the_named_colours():
    assert set(get_args(Preset)) == set(HAIR_COLORS)


@pytest.mark.parametrize("sigma", [(0.01, 0.03, 0.1), (0.2, 1.0, 8.0)])
def test_dense_hair_under_white_light_has_its_display_color(sigma):
    mi, count = mitsuba(), 3000
    random = np.random.default_rng(0)
    controls = np.zeros((count, 4, 4), np.float32)
    controls[:, :, 0] = random.uniform(-3, 3, count)[:, None] + random.normal(0, 0.15, count)[:, None] * np.arange(4)
    controls[:, :, 1] = np.linspace(-12, 12, 4)
    controls[:, :, 2] = random.uniform(-4, 0, count)[:, None]
    controls[:, :, 3] = 0.08
    bsdf = {"type": "hair", "sigma_a": {"type": "rgb", "value": list(sigma)}}
    scene = mi.load_dict(
        {
            "type": "scene",
            "hairs": load_fibres(mi, controls.reshape(-1, 4), 4 * np.arange(count + 1, dtype=np.int32), bsdf),
            "light": {"type": "constant", "radiance": {"type": "rgb", "value": [1.0, 1.0, 1.0]}},
            "integrator": {"type": "path", "max_depth": 100, "rr_depth": 60},
            "sensor": {
                "type": "orthographic",
                "to_world": mi.ScalarTransform4f().look_at([0, 0, 9], [0, 0, 0], [0, 1, 0]),
                "film": {"type": "hdrfilm", "width": 8, "height": 8, "pixel_format": "rgb"},
            },
        }
    )
    seen = np.array(mi.render(scene, spp=64)).mean(axis=(0, 1))
    assert seen == pytest.approx(display_color(reflectance(sigma, 0.3)), rel=0.25)


# Recipes


def test_hair_is_without_colour_by_default_and_its_files_hold_nothing_of_it(tmp_path):
    made = groom()
    write_groom(made, tmp_path / "groom.usda")
    stage = Usd.Stage.Open(str(tmp_path / "groom.usda"))
    names = [
        name for path in ("/groom", "/groom/locks") for name in stage.GetPrimAtPath(path).GetAuthoredPropertyNames()
    ]
    for name in ("melanin", "redness", "dye", "gray", "roughness", "tilt", "displayColor", "ringlet:color"):
        assert not any(name in found for found in names)
    assert curve_reflectance(make_hairs(made).curves, "hairs") is None


def test_a_preset_fills_what_is_not_given():
    made = parse_recipe(RECIPE + '[color]\npreset = "ginger"\nredness = 0.2\n')
    assert made.color.melanin.value == HAIR_COLORS["ginger"].melanin
    assert made.color.redness.value == 0.2


def test_a_ramp_runs_from_root_to_tip():
    made = hairs("[color]\nmelanin = { value = 0.9, ramp = [[0, 1], [1, 0.4]] }\nvary_hairs = 0\n")
    melanin = per_point(made, "melanin")
    assert melanin[:, 0] == pytest.approx(0.9, abs=1e-6)
    assert melanin[:, -1] == pytest.approx(0.36, abs=1e-6)
    assert (np.diff(melanin, axis=1) <= 1e-7).all()
    assert "redness" in made.curve, "what does not vary along a hair is stored once a hair"


def test_hairs_of_other_point_counts_have_the_ramp_of_their_lock():
    table = "[color]\nmelanin = { value = 0.9, ramp = [[0, 1], [1, 0.4]] }\nvary_hairs = 0\n"
    made = make_hairs(groom(table, RECIPE.replace("per_lock = 10", "per_lock = 10\npoints = 79"))).curves
    fine = make_hairs(groom(table)).curves
    assert per_point(made, "melanin")[:, ::2] == pytest.approx(per_point(fine, "melanin"), abs=1e-6)


def test_variation_of_hairs_is_by_their_ids():
    table = "[color]\nmelanin = { value = 0.7, vary = 0.3 }\nvary_hairs = 0.4\n"
    whole, half = hairs(table), hairs(table, fraction=0.5)
    values = dict(zip(whole.ids.tolist(), whole.curve["melanin"].tolist(), strict=True))
    assert [values[name] for name in half.ids.tolist()] == half.curve["melanin"].tolist()
    locks = concentration(groom(table).locks.curve["melanin"])
    assert np.ptp(locks) > 0.3 * locks.mean()
    relative = concentration(whole.curve["melanin"]) / locks[whole.curve["lock"]]
    assert 0.6 <= relative.min() < 0.65
    assert 1.35 < relative.max() <= 1.4 + 1e-3
    another = hairs(table + "seed = 2\n")
    assert not np.array_equal(another.curve["melanin"], whole.curve["melanin"])


def test_the_share_of_white_hairs_is_that_of_the_recipe():
    many = RECIPE.replace("per_lock = 10", "per_lock = 100")
    made = make_hairs(groom("[color]\ngray = 0.3\n", many)).curves
    assert (made.curve["melanin"] < 0.01).mean() == pytest.approx(0.3, abs=0.02)
    assert (hairs("[color]\ngray = 1\n").curve["melanin"] < 0.01).all()
    assert (hairs("[color]\n").curve["melanin"] > 0.5).all()


def test_a_single_lock_may_have_a_colour_of_its_own():
    lock = groom().locks.ids[5]
    made = groom(f"[color]\nmelanin = {{ value = 0.9, vary = 0.2, lock = {{ {lock} = 0.1 }} }}\n")
    assert made.locks.curve["melanin"][5] == pytest.approx(0.1)
    assert np.delete(made.locks.curve["melanin"], 5).min() > 0.5


def test_an_edit_of_a_lock_may_set_its_colour():
    lock = groom().locks.ids[5]
    made = groom(f'[[edit]]\nlock = {lock}\nset = {{ "color.melanin" = 0.1, "color.gray" = 1 }}\n')
    assert made.locks.curve["melanin"][5] == pytest.approx(0.1)
    assert made.locks.curve["gray"].tolist() == [float(k == 5) for k in range(60)]


def test_dye_replaces_the_natural_colour_where_its_ramp_and_mask_say():
    made = hairs('[color]\n[color.dye]\ncolor = "#2060c0"\namount = { value = 1, ramp = [[0, 0], [1, 1]] }\n')
    colors = curve_reflectance(made, "hairs").reshape(len(made), -1, 3)
    assert colors[:, -1] == pytest.approx(np.broadcast_to(linear_color("#2060c0"), (len(made), 3)), abs=1e-6)
    assert (colors[:, 0, 2] < 0.01).all()
    streaks = groom('[color]\n[color.dye]\nmask = { where = "random < 0.25" }\n').locks.curve["dye_amount"]
    assert set(np.unique(streaks)) == {0.0, 1.0}
    assert streaks.mean() == pytest.approx(0.25, abs=0.12)


def test_each_dye_covers_those_before_it_by_its_amount():
    made = hairs(
        '[color]\n[color.dye]\ncolor = "#ff0000"\namount = 0.5\n'
        '[[color.dyes]]\ncolor = "#0000ff"\namount = { value = 1, ramp = [[0, 0], [1, 0.5]] }\n'
        '[[color.dyes]]\ncolor = "#00ff00"\nmask = { where = "random < 0.3" }\n'
    )
    natural = curve_reflectance(hairs("[color]\n"), "hairs")
    colors = curve_reflectance(made, "hairs").reshape(len(made), -1, 3)
    green = np.abs(colors[:, 0] - [0.0, 1.0, 0.0]).max(axis=1) < 1e-5
    assert 0.1 < green.mean() < 0.5
    assert colors[green] == pytest.approx(np.broadcast_to([0.0, 1.0, 0.0], colors[green].shape), abs=1e-5)
    red = 0.5 * natural[~green] + 0.5 * np.array([1.0, 0.0, 0.0])
    assert colors[~green, 0] == pytest.approx(red, abs=1e-5)
    assert colors[~green, -1] == pytest.approx(0.5 * red + 0.5 * np.array([0.0, 0.0, 1.0]), abs=1e-5)


def test_one_dye_is_as_good_as_the_same_dye_in_the_list():
    dye = 'color = "#2060c0"\namount = { value = 0.8, ramp = [[0, 0], [1, 1]] }\n'
    one, listed = (hairs(f"[color]\n{table}\n{dye}") for table in ("[color.dye]", "[[color.dyes]]"))
    assert curve_reflectance(one, "hairs") == pytest.approx(curve_reflectance(listed, "hairs"), abs=1e-6)


def test_regrowth_is_a_length_in_the_natural_colour():
    made = groom("[color]\n[color.dye]\nregrowth = 2\n")
    amount = per_point(made.locks, "dye_amount")
    run = np.linalg.norm(np.diff(made.locks.points.reshape(len(made.locks), -1, 3), axis=1), axis=2).cumsum(axis=1)
    assert (amount[:, 1:][run < 0.016] == 0.0).all()
    assert (amount[:, 1:][run > 0.0201] == 1.0).all()


def test_colour_follows_a_map_of_the_scalp():
    mesh = ball()
    mesh.maps["painted"] = (mesh.points[mesh.triangles][:, :, 0] > 0.0).astype(float)
    made = make_groom(parse_recipe(RECIPE + '[color]\ngray = { value = 1, map = "painted" }\n'), mesh)
    right = made.locks.roots[:, 0] > 0.03
    assert made.locks.curve["gray"][right] == pytest.approx(1.0)
    assert made.locks.curve["gray"][made.locks.roots[:, 0] < -0.03] == pytest.approx(0.0)


def test_a_change_of_colour_keeps_the_layout_of_hairs():
    memory = HairMemory()
    first = lay_hairs(groom("[color]\nmelanin = 0.2\n"), memory=memory).curves
    assert lay_hairs(groom("[color]\nmelanin = 0.8\n"), memory=memory).curves is first


@pytest.mark.parametrize(
    ("table", "message"),
    [
        ("[color]\nmelanin = 1.2\n", r"color.melanin is 1.2; must be at most 1"),
        ('[color]\n[color.dye]\ncolor = "red"\n', r"color.dye.color is 'red'; must be a colour such as \"#b4531f\""),
        ('[color]\npreset = "green"\n', "color.preset"),
        ("[fiber]\nroughness = 0\n", r"fiber.roughness is 0; must be at least 0.05"),
        ('[color]\ngray = { value = 1, map = "nowhere" }\n', "color.gray.map is 'nowhere'"),
    ],
)
def test_mistakes_are_named(table, message):
    with pytest.raises(UserError, match=message):
        groom(table)


# The fibre


def test_a_flat_fibre_turns_about_its_axis_and_is_seen_narrower_and_wider():
    recipe = RECIPE.replace("[hairs]", "[hairs]\nwidth = 0.01")
    round_ = make_hairs(groom("", recipe)).curves
    flat = make_hairs(groom("[fiber]\nflatness = 0.5\ntwist_pitch = 4\n", recipe)).curves
    seen = per_point(flat, "width") / per_point(round_, "width")
    assert seen.min() == pytest.approx(0.5, abs=0.02)
    assert seen.max() == pytest.approx(1.0, abs=0.02)
    turns = np.ptp(per_point(flat, "twist"), axis=1) / 360.0
    assert turns == pytest.approx(groom("", recipe).locks.lengths()[flat.curve["lock"]] / 0.04, rel=1e-4)
    close = make_hairs(groom("[fiber]\nflatness = 0.5\ntwist_pitch = 0.05\n", recipe)).curves
    mean = per_point(close, "width") / per_point(round_, "width")
    assert np.ptp(mean) < 1e-6, "turns closer than the points of a hair are shown by their mean"


def test_fibers_vary_from_lock_to_lock_and_from_hair_to_hair():
    lock = groom().locks.ids[5]
    table = f"[fiber]\nroughness = {{ value = 0.2, vary = 0.5, lock = {{ {lock} = 0.6 }} }}\ntilt = 3\n"
    locks = groom(table).locks.curve
    assert locks["roughness"][5] == pytest.approx(0.6)
    assert 0.1 <= np.delete(locks["roughness"], 5).min() < 0.13
    made = hairs(table)
    assert np.array_equal(made.curve["roughness"], locks["roughness"][made.curve["lock"]])
    assert np.ptp(made.curve["tilt"]) == 0.0
    varied = hairs(table + "vary_hairs = 0.3\n")
    factor = varied.curve["roughness"] / made.curve["roughness"]
    assert 0.7 <= factor.min() < 0.75
    assert 1.25 < factor.max() <= 1.3 + 1e-3
    assert np.ptp(varied.curve["tilt"]) > 1.0
    half = hairs(table + "vary_hairs = 0.3\n", fraction=0.5)
    values = dict(zip(varied.ids.tolist(), varied.curve["tilt"].tolist(), strict=True))
    assert [values[name] for name in half.ids.tolist()] == half.curve["tilt"].tolist()


def test_the_section_varies_from_lock_to_lock():
    recipe = RECIPE.replace("[hairs]", "[hairs]\nwidth = 0.01")
    table = "[fiber]\nflatness = { value = 0.5, vary = 1 }\ntwist_pitch = { value = 4, vary = 0.5 }\n"
    flat = make_hairs(groom(table, recipe)).curves
    seen = per_point(flat, "width") / per_point(make_hairs(groom("", recipe)).curves, "width")
    narrowest = 1.0 - flat.curve["flatness"]
    assert np.ptp(flat.curve["flatness"]) > 0.5
    assert (seen.min(axis=1) >= narrowest - 1e-5).all()
    assert np.corrcoef(seen.mean(axis=1), narrowest)[0, 1] > 0.9


# Files


def test_colours_come_back_from_files(tmp_path):
    made = groom(
        '[color]\npreset = "brown"\ngray = 0.2\nmelanin = { value = 0.8, ramp = [[0, 1], [1, 0.5]] }\n'
        "[color.dye]\namount = 0.4\n[fiber]\nroughness = 0.25\nazimuthal_roughness = { value = 0.3, vary = 0.2 }\n"
        "tilt = 3\n"
    )
    write_groom(made, tmp_path / "groom.usdc")
    again = read_groom(tmp_path / "groom.usdc")
    assert again.color == made.color
    assert again.fiber == made.fiber
    before, after = make_hairs(made).curves, make_hairs(again).curves
    with HairWriter(tmp_path / "hair.usdc", made, before, tmp_path / "groom.usdc") as writer:
        writer.add(None, before.points)
    read = read_hairs(tmp_path / "hair.usdc")
    for name in ("redness", "dye", "dye_amount", "roughness", "azimuthal_roughness", "tilt"):
        assert np.array_equal(before.curve[name], after.curve[name]), name
        assert np.array_equal(before.curve[name], read.curve[name]), name
    assert np.array_equal(before.point["melanin"], after.point["melanin"])
    assert np.array_equal(before.point["melanin"], read.point["melanin"])

    stage = Usd.Stage.Open(str(tmp_path / "hair.usdc"))
    prim = stage.GetPrimAtPath("/groom/hairs")
    api = UsdGeom.PrimvarsAPI(prim)
    shown = api.GetPrimvar("displayColor")
    assert shown.GetInterpolation() == "vertex"
    assert np.array(shown.Get()) == pytest.approx(display_color(curve_reflectance(before, "hairs")), rel=1e-5)
    assert {name: api.GetPrimvar(name).GetInterpolation() for name in ("dye", "tilt", "melanin", "redness")} == {
        "dye": "constant",
        "tilt": "constant",
        "melanin": "vertex",
        "redness": "uniform",
    }
    assert json.loads(prim.GetParent().GetAttribute("ringlet:color").Get())["preset"] == "brown"


def test_dyes_and_fibers_that_vary_come_back_from_files(tmp_path):
    made = groom(
        '[color]\n[color.dye]\n[[color.dyes]]\ncolor = "#2060c0"\namount = { value = 0.5, ramp = [[0, 0], [1, 1]] }\n'
        "[fiber]\nflatness = { value = 0.4, vary = 0.2 }\nvary_hairs = 0.1\n"
    )
    write_groom(made, tmp_path / "groom.usdc")
    again = read_groom(tmp_path / "groom.usdc")
    assert (again.color, again.fiber) == (made.color, made.fiber)
    before, after = make_hairs(made).curves, make_hairs(again).curves
    with HairWriter(tmp_path / "hair.usdc", made, before, tmp_path / "groom.usdc") as writer:
        writer.add(None, before.points)
    read = read_hairs(tmp_path / "hair.usdc")
    for name in ("roughness", "tilt", "flatness"):
        assert len(np.unique(before.curve[name])) > 100, name
        assert np.array_equal(before.curve[name], after.curve[name]), name
        assert np.array_equal(before.curve[name], read.curve[name]), name
    assert np.array_equal(before.point["dye"], read.point["dye"])
    assert np.array_equal(curve_reflectance(before, "hairs"), curve_reflectance(read, "hairs"))


# Pictures


def light_of(curves: Curves, color=None, samples: int = 16) -> np.ndarray:
    camera = frame([curves.points], view="front")
    scene = build_scene([], curves, camera, size=(48, 48), color=color, max_depth=8)
    return trace(scene, samples=samples)


def test_a_still_shows_each_hair_in_its_own_colour():
    curves = tuft(60)
    left = curves.roots[:, 0] < 0.0
    curves.curve["melanin"] = np.where(left, 0.05, 0.999)
    curves.curve["redness"] = np.zeros(60)
    light = light_of(curves)
    assert light[:, :22, :3].mean() > 2.0 * light[:, 26:, :3].mean()
    one = light_of(curves, HAIR_COLORS["black"])
    assert one[:, :22, :3].mean() < 1.5 * one[:, 26:, :3].mean(), "a named colour overrides that of the hairs"


def test_a_still_shows_the_colour_along_a_hair():
    curves = tuft(60)
    u = np.concatenate([np.linspace(0.0, 1.0, n) for n in curves.counts])
    curves.point["melanin"] = np.where(u < 0.5, 0.999, 0.05)
    light = light_of(curves)
    covered = np.flatnonzero(light[:, :, 3].max(axis=1) > 0.1)
    middle = covered.mean()
    above, below = covered[covered < middle - 1], covered[covered > middle + 1]  # tips are up
    assert light[above, :, :3].mean() > 2.0 * light[below, :, :3].mean()


def test_a_sheet_and_a_still_of_the_same_hair_have_one_colour(tmp_path: Path):
    random = np.random.default_rng(2)
    outward = random.normal(size=(4000, 3))
    outward /= np.linalg.norm(outward, axis=1, keepdims=True)
    bent = 0.4 * random.normal(size=outward.shape)
    curves = Curves.from_list(
        [0.06 * d + np.outer(np.linspace(0, 1, 5), 0.05 * (d + b)) for d, b in zip(outward, bent, strict=True)]
    )
    curves.point["width"] = np.full(len(curves.points), 4e-4)
    curves.curve["melanin"] = np.full(len(curves), HAIR_COLORS["blond"].melanin)
    still(Pose([], curves), tmp_path / "still.png", PictureSettings(width=64, height=64, samples=24))
    sheet([(1.0, [], curves)], tmp_path / "sheet.png", tile=(64, 64), hairs=2000, samples=24)
    seen = {}
    for name, corner in (("still", 0), ("sheet", GAP)):
        pixels = np.asarray(Image.open(tmp_path / f"{name}.png").convert("RGB"), float)[corner:, corner:][:64, :64]
        seen[name] = pixels[20:44, 20:44].mean(axis=(0, 1))
    assert seen["sheet"] == pytest.approx(seen["still"], rel=0.16)  # with 4 bounces it is 40 % darker


@pytest.mark.parametrize("counts", [(5, 9, 13), (4, 6, 11)])
def test_texels_of_colours_lie_on_the_segments_of_their_hairs(counts):
    mi = mitsuba()
    curves = Curves.from_list([np.linspace([k, 0, 0], [k, 1, 0], n) for k, n in enumerate(counts)])
    curves.curve["melanin"] = np.array([0.2, 0.9, 0.6])
    controls = np.array([[p[0], p[1], p[2], 0.05] for p in curves.points], np.float32)  # any: only their number counts
    offsets = curves.offsets + 2 * np.arange(len(counts) + 1, dtype=np.int32)
    shape = load_fibres(mi, np.repeat(controls, 2, axis=0)[: offsets[-1]], offsets, {"type": "hair"})
    texture = mi.load_dict(fiber_bsdf(mi, curves, None)["sigma_a"])
    segments = int(np.array(mi.traverse(shape)["segment_indices"]).size)
    assert segments == sum(counts) - len(counts) + 1
    expected = absorption(curves.curve["melanin"], 0.0)[np.repeat(np.arange(3), np.array(counts) - 1)]
    for segment, sigma in enumerate(expected):
        si = mi.SurfaceInteraction3f()
        si.uv = [0.5, (segment + 0.5) / segments]
        assert np.array(texture.eval(si)) == pytest.approx(sigma, rel=1e-3)


def test_colours_that_are_not_finite_are_refused(tmp_path: Path):
    curves = tuft(4)
    curves.curve["melanin"] = np.array([0.1, np.nan, 0.2, 0.3])
    with pytest.raises(UserError, match="melanin is not one finite number for each curve or point"):
        light_of(curves, samples=1)
