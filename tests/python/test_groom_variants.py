"""Variants: recipes that change some values of another."""

import json

import numpy as np
import pytest
from ringlet.cli.app import app
from ringlet.io import read_rest
from small_example import write_head
from typer.testing import CliRunner

import ringlet
from ringlet import UserError
from ringlet.groom import parse_recipe, read_recipe

BASE = """
ringlet = 2
name = "base"
unit = "cm"
[scalp]
file = "head.usda"
region = "scalp"
[guides]
count = 8
length = { value = 6, vary = 0.1 }
part_line = { falloff = 3 }
[locks]
count = 12
points = 64
[[shape]]
op = "scraggle"
magnitude = 0.3
[[shape]]
op = "volume"
amount = 0.5
[[shape]]
op = "scraggle"
magnitude = 0.1
[curl]
preset = "3B"
width = 1
"""


@pytest.fixture
def folder(tmp_path):
    write_head(tmp_path / "head.usda")
    (tmp_path / "base.toml").write_text(BASE)
    return tmp_path


def variant(folder, text, name="down.toml"):
    (folder / name).parent.mkdir(exist_ok=True)
    (folder / name).write_text(f"ringlet = 2\n{text}")
    return folder / name


def test_a_variant_changes_only_its_own_values(folder):
    path = variant(
        folder, 'extends = "base.toml"\nname = "down"\n[guides]\nlength = 12\n[curl]\nwidth = { vary = 0.3 }\n'
    )
    base, down = read_recipe(folder / "base.toml"), read_recipe(path)
    assert (down.name, down.guides.length.value, down.curl.width.vary) == ("down", 0.12, 0.3)
    assert down.curl.width.value == base.curl.width.value
    same = {"name", "guides", "curl", "extends"}
    assert down.model_dump(exclude=same) == base.model_dump(exclude=same)
    assert down.guides.count == base.guides.count and down.guides.part_line == base.guides.part_line


def test_operators_are_changed_by_name_and_removed_with_false(folder):
    text = 'extends = "base.toml"\ncurl = false\n[shape]\nvolume = false\n"scraggle 2" = { magnitude = 0.7 }\n'
    down = read_recipe(variant(folder, text))
    assert [op.op for op in down.shape] == ["scraggle", "scraggle"]
    assert [op.magnitude.value for op in down.shape] == pytest.approx([0.003, 0.007])
    assert down.curl is None
    assert read_recipe(variant(folder, 'extends = "base.toml"\nshape = []\n')).shape == []


def test_operators_are_changed_and_appended_in_one_variant(folder):
    text = 'extends = "base.toml"\n[shape.volume]\namount = 0.9\n[[shape.append]]\nop = "clump"\nsize = 3\n'
    both = read_recipe(variant(folder, text))
    assert [op.op for op in both.shape] == ["scraggle", "volume", "scraggle", "clump"]
    assert (both.shape[1].amount.value, both.shape[3].size) == (0.9, 0.03)
    again = read_recipe(variant(folder, 'extends = "down.toml"\n[[shape.append]]\nop = "clump"\n', "again.toml"))
    assert [op.op for op in again.shape] == [*(op.op for op in both.shape), "clump"]


def test_a_variant_takes_the_whorl_away(folder):
    assert read_recipe(variant(folder, 'extends = "base.toml"\n[guides]\nwhorl = false\n')).guides.whorl is None


def test_values_are_removed_with_false(folder):
    base = read_recipe(folder / "base.toml")
    assert base.scalp.region is not None and base.curl.preset is not None
    text = 'extends = "base.toml"\n[scalp]\nregion = false\n[curl]\npreset = false\ncurls = 5\n'
    down = read_recipe(variant(folder, text))
    assert (down.scalp.region, down.curl.preset) == (None, None)
    assert down.curl.width.value == base.curl.width.value and down.scalp.mesh == base.scalp.mesh


def test_a_variant_of_a_variant_in_another_folder_finds_the_files_of_the_base(folder):
    variant(folder, 'extends = "base.toml"\n[guides]\nlength = 9\n', "long.toml")
    path = variant(folder, 'extends = "../long.toml"\n[curl]\nwidth = 2\n', "variants/wide.toml")
    recipe = read_recipe(path)
    assert (recipe.guides.length.value, recipe.curl.width.value) == (0.09, 0.02)
    assert len(ringlet.build_groom(path).locks) == 12


def test_the_text_stored_with_the_groom_is_a_complete_recipe(folder):
    groom = ringlet.build_groom(variant(folder, 'extends = "base.toml"\n[guides]\nlength = 9\n'))
    assert groom.recipe is not None and "extends" not in groom.recipe
    again = ringlet.build_groom(parse_recipe(groom.recipe, folder / "again.toml"))
    np.testing.assert_array_equal(again.locks.points, groom.locks.points)


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ('extends = "bsae.toml"', "bsae.toml: cannot be read"),
        ('extends = "down.toml"', "down.toml: extends down.toml, which extends it in turn"),
        ("extends = 3", "extends is 3; must be the name of a file"),
        ('extends = "base.toml"\nunit = "m"', "unit is 'm', that of base.toml is 'cm'; must be the same"),
        (
            'extends = "base.toml"\n[shape.volumme]\namount = 1',
            "shape.volumme is no operator of what it extends; did you mean",
        ),
        ('extends = "base.toml"\n[shape]\nappend = 3', "shape.append is 3; must be tables [[shape.append]]"),
        ('extends = "base.toml"\n[shape]\nvolume = 3', "shape.volume is 3; must be a table of settings, or false"),
        ('extends = "base.toml"\n[curl]\nwidht = 3', "curl.widht is not a setting; did you mean 'width'?"),
    ],
)
def test_invalid_variants_are_refused_in_one_line(folder, text, words):
    with pytest.raises(UserError) as error:
        read_recipe(variant(folder, text))
    assert words in str(error.value) and "\n" not in str(error.value)


def test_variants_are_written_as_usd_variants(folder):
    from pxr import Usd, UsdGeom

    down = variant(folder, 'extends = "base.toml"\n[guides]\nlength = 12\n[locks]\npoints = 96\n')
    base_groom, down_groom = ringlet.build_groom(folder / "base.toml"), ringlet.build_groom(down)
    ringlet.write_groom(base_groom, folder / "groom.usdc", variants={"down": down_groom})
    base_locks = ringlet.read_groom(folder / "groom.usdc").locks
    np.testing.assert_allclose(base_locks.points, base_groom.locks.points, atol=1e-6)
    again = ringlet.read_groom(folder / "groom.usdc", variant="down")
    np.testing.assert_allclose(again.locks.points, down_groom.locks.points, atol=1e-6)
    np.testing.assert_array_equal(again.locks.ids, down_groom.locks.ids)
    assert again.recipe == down_groom.recipe

    stage = Usd.Stage.Open(str(folder / "groom.usdc"))  # as other programs read it
    choice = stage.GetPrimAtPath("/groom").GetVariantSets().GetVariantSet("groom")
    assert (sorted(choice.GetVariantNames()), choice.GetVariantSelection()) == (["base", "down"], "base")
    choice.SetVariantSelection("down")
    locks = UsdGeom.BasisCurves(stage.GetPrimAtPath("/groom/locks"))
    assert set(locks.GetCurveVertexCountsAttr().Get()) == {96} and len(locks.GetPointsAttr().Get()) == 12 * 96
    with pytest.raises(UserError, match=r"has no variant 'dwon'; did you mean 'down'"):
        ringlet.read_groom(folder / "groom.usdc", variant="dwon")
    with pytest.raises(UserError, match=r"variant 'hair down': is no name for USD"):
        ringlet.write_groom(base_groom, folder / "groom.usdc", variants={"hair down": down_groom})
    ringlet.write_groom(base_groom, folder / "groom.usdc", variants={"2-down": down_groom})
    assert ringlet.read_groom(folder / "groom.usdc", variant="2-down").recipe == down_groom.recipe


def test_a_variant_in_another_folder_uses_the_same_head(folder, monkeypatch):
    monkeypatch.chdir(folder)
    (folder / "other").mkdir()
    (folder / "other/down.toml").write_text("ringlet = 2\nextends = '../base.toml'\n[locks]\npoints = 96\n")
    down = ringlet.build_groom("other/down.toml")
    ringlet.write_groom(ringlet.build_groom("base.toml"), "groom.usdc", variants={"down": down})
    assert len(ringlet.read_groom("groom.usdc", variant="down").locks.points) == 12 * 96


def test_a_cache_is_layered_over_the_selected_variant(folder):
    down = ringlet.build_groom(variant(folder, 'extends = "base.toml"\n[locks]\npoints = 96\n'))
    base = ringlet.build_groom(folder / "base.toml")
    ringlet.write_groom(base, folder / "groom.usdc", variants={"down": down})
    moved = np.stack([base.locks.points, base.locks.points + 0.01]).astype(np.float32)
    ringlet.write_cache(ringlet.Cache(np.array([1.0, 2.0]), moved), folder / "groom.usdc", folder / "cache.usdc")
    np.testing.assert_allclose(ringlet.read_cache(folder / "cache.usdc").points, moved, atol=1e-6)
    assert len(ringlet.read_groom(folder / "cache.usdc").locks) == 12


def test_the_example_has_a_variant_with_longer_hair():
    from pathlib import Path

    child = Path(__file__).parents[2] / "examples" / "child"
    up, down = ringlet.build_groom(child / "curls.recipe.toml"), ringlet.build_groom(child / "down.recipe.toml")
    assert np.array_equal(up.locks.ids, down.locks.ids)
    assert down.locks.points[:, 1].min() < up.locks.points[:, 1].min() - 0.04
    assert np.median(down.locks.lengths()) > 1.7 * np.median(up.locks.lengths())


def test_every_command_accepts_a_variant_and_its_output_records_it(folder):
    down = ringlet.build_groom(variant(folder, 'extends = "base.toml"\n[locks]\npoints = 96\n'))
    file, cache, hair = (folder / f"{name}.usdc" for name in ("groom", "cache", "hair"))
    ringlet.write_groom(ringlet.build_groom(folder / "base.toml"), file, variants={"down": down})
    (folder / "a.shot.toml").write_text("ringlet = 2\ngroom = 'groom.usdc'\nframes = [1, 2]\npreroll = 0\n")
    chosen = ["--variant", "down"]
    checked = json.loads(run("check", file, *chosen, "--json"))
    assert checked["points"] == 12 * 96
    run("loft", folder / "a.shot.toml", "-o", folder / "rest.usdc", *chosen)
    assert len(read_rest(folder / "rest.usdc")[0].points) == 12 * 96
    run("sim", folder / "a.shot.toml", "-o", cache, *chosen)
    assert (ringlet.read_groom(cache).variant, ringlet.read_cache(cache).points.shape[1]) == ("down", 12 * 96)
    run("hair", file, "--cache", cache, "-o", hair)  # the variant of the cache, without an option
    assert ringlet.read_groom(hair).variant == "down" and len(ringlet.read_groom(hair).locks.points) == 12 * 96
    run("hair", file, *chosen, "-o", hair)
    assert ringlet.read_groom(hair).variant == "down"
    assert ringlet.read_groom(file).variant == "base"
    with pytest.raises(UserError, match=r"variant 'down': .*base.toml is a recipe; name the recipe of the variant"):
        ringlet.load_groom(folder / "base.toml", variant="down")


def run(*arguments):
    result = CliRunner().invoke(app, [str(argument) for argument in arguments])
    assert result.exit_code in (0, 1), result.output
    return result.stdout


def test_a_variant_gives_values_relative_to_those_of_its_base(folder):
    text = (
        'extends = "base.toml"\nguides.length = "130 %"\nlocks.count = 9\ncurl.width = { value = "50 %", vary = 0.4 }\n'
        'shape."scraggle 2".magnitude = "200 %"\nguides.part_line.falloff = "10 %"\n'
    )
    base, longer = read_recipe(folder / "base.toml"), read_recipe(variant(folder, text, "longer.toml"))
    assert longer.guides.length.value == pytest.approx(1.3 * base.guides.length.value)
    assert longer.guides.length.vary == base.guides.length.vary
    assert (longer.curl.width.value, longer.curl.width.vary) == (pytest.approx(0.005), 0.4)
    assert longer.shape[2].magnitude.value == pytest.approx(0.002)
    twice = read_recipe(variant(folder, 'extends = "longer.toml"\nguides.length = "50 %"\n', "twice.toml"))
    assert twice.guides.length.value == pytest.approx(0.65 * base.guides.length.value)
    units = variant(folder, 'extends = "base.toml"\nguides.length = "8 mm"\n', "units.toml")
    scaled = read_recipe(variant(folder, f'extends = "{units.name}"\nguides.length = "25 %"\n', "scaled.toml"))
    assert scaled.guides.length.value == pytest.approx(0.002)


@pytest.mark.parametrize("setting", ["guides.lift", "scalp.region"])
def test_a_relative_value_without_a_base_is_refused(folder, setting):
    with pytest.raises(UserError, match=f"{setting} is '130 %', but what it extends has .*; give it a"):
        read_recipe(variant(folder, f'extends = "base.toml"\n{setting} = "130 %"\n'))
