"""Recipes: accepted values, defaults and refusals."""

from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from ringlet import UserError
from ringlet.groom import PRESETS, parse_recipe, read_recipe, schema

EXAMPLE = Path(__file__).parents[2] / "examples" / "child" / "curls.recipe.toml"


def recipe(text):
    return parse_recipe("ringlet = 2\n" + text, Path("curls.recipe.toml"))


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("[curl]\npreset = '4A'\nwidht = 3", "curl.widht is not a setting; did you mean 'width'?"),
        ("[crul]", "crul is not a setting; did you mean 'curl'?"),
        ("[curl]\npreset = '4A'\nwidth = -20", "curl.width is -0.2 m; must be at least 0 m"),
        ("[curl]\npreset = '4A'\nwidth = nan", "curl.width is nan; must be finite"),
        ("[curl]\npreset = '4A'\nwidth = '5 furlong'", "curl.width is '5 furlong'; must be a number or a length"),
        ("[curl]\npitch = { vary = 0.1 }", "curl.pitch is missing"),
        (
            "[curl]\npreset = '5Z'",
            "curl.preset is '5Z'; must be '1', '2A', '2B', '2C', '3A', '3B', '3C', '4A', '4B' or '4C'",
        ),
        ("[curl]\npitch = 1\ncurls = 3", "give exactly one of"),
        ("[curl]\nwidth = 1", "neither how many curls"),
        ("[locks]\ncount = 0", "locks.count is 0; must be at least 1"),
        ("[locks]\ncount = 5\nspacing = 1", "both 'count' and 'spacing'"),
        ("[hairs]\nper_lock = 'many'", "hairs.per_lock is 'many'; must be a number"),
        ("[[shape]]\nop = 'scragle'", "shape[0].op is 'scragle'; did you mean 'scraggle'?"),
        ("[[shape]]\nop = 'volume'\namout = 1", "shape[0].amout is not a setting; did you mean 'amount'?"),
        ("[[shape]]\nop = 'volume'\namount = { value = 1, ramp = [[0, 1], [2, 1]] }", "has a place at 2.0"),
        ("[[shape]]\nop = 'volume'\namount = { value = 1, ramp = [[1, 1], [0, 1]] }", "must ascend"),
        ("[curl]\npreset = '4A'\nopening = [[0, -1]]", "curl.opening has a factor of -1.0"),
        (f"[curl]\npreset = '4A'\nflatness = {10**400}", "curl.flatness is 10^400 or more; must be at most 1"),
        ("[guides]\nwhorl = [0, nan, 1]", "guides.whorl[1] is nan; must be finite"),
        ("[guides]\nwhorl = [0, 0, 0]", "guides.whorl is [0.0, 0.0, 0.0], which points nowhere"),
        ("[[guides.zone]]\ntoward = [0, 0, 0]", "guides.zone[0].toward is [0.0, 0.0, 0.0], which points nowhere"),
        ("[[shape]]\nop = 'bend'\ntoward = [0, 1e-9, 0]", "shape[0].toward is [0.0, 1e-09, 0.0], which points nowhere"),
        ("[guides.mirror]\nacross = [1e300, 0, 0]", "guides.mirror.across[0] is 1e+300; must be at most 1000"),
        ("curl = 3", "curl is 3; must be a table"),
        ("unit = 'ft'", "unit is 'ft'; must be"),
        ("[meshes.a]\nmiddle = [0, 1, 0]\nunit = 'm'", "meshes.a has 'unit', but no file that it is for; take it out"),
        ("[meshes.a]\nmiddle = [0, 1, 0]\nmesh = '/a'", "meshes.a has 'mesh', but no file"),
        ("[meshes.a]\nfile = 'a.obj'\nwidth = 4", "meshes.a has 'width', but a.obj has that of its own; take it out"),
        ("[curves.a]\npoints = [[0, 0, 0], [0, 1, 0]]\nup = 'Y'", "curves.a has 'up', but no file that it is for"),
        ("[curves.a]\npoints = [[0, 0, 0], [0, 1, 0]]\nprim = '/a'", "curves.a has 'prim', but no file"),
        ("[curves.a]\nfile = 'a.usdc'\nunit = 'm'", "curves.a has 'unit', but a.usdc stores its own; take it out"),
        ("[scalp]\nfile = 'a.usda'\nup = 'Z'", "scalp has 'up', but a.usda stores its own; take it out"),
        ("[guides]\nfile = 'a.USD'\nunit = 'cm'", "guides has 'unit', but a.USD stores its own; take it out"),
        ("x = = 1", "not valid TOML: invalid value (at line 2"),
    ],
)
def test_invalid_settings_are_refused_with_file_setting_and_remedy(text, message):
    with pytest.raises(UserError) as error:
        recipe(text)
    assert str(error.value).startswith("curls.recipe.toml: ")
    assert message in str(error.value)
    assert "\n" not in str(error.value)


numbers = st.one_of(st.integers(), st.floats(), st.sampled_from([10**400, -(10**30)]))
plain = st.one_of(numbers, st.booleans(), st.text("m c5.-", max_size=5), st.sampled_from(["5 mm", "-1 in", "4A"]))
anything = st.recursive(
    plain,
    lambda inner: st.one_of(
        st.lists(inner, max_size=3), st.dictionaries(st.sampled_from(["value", "vary", "ramp", "noise", "x"]), inner)
    ),
    max_leaves=8,
)
SETTINGS = [
    (section, setting)
    for section, model in (
        ("guides", "Grown"),
        ("locks", "Locks"),
        ("curl", "Curl"),
        ("collide", "Collide"),
        ("hairs", "HairSettings"),
    )
    for setting in schema()["$defs"][model]["properties"]
]


def as_toml(value):
    if isinstance(value, dict):
        return "{ " + ", ".join(f"{key} = {as_toml(inner)}" for key, inner in value.items()) + " }"
    if isinstance(value, list):
        return "[" + ", ".join(map(as_toml, value)) + "]"
    return str(value).lower() if isinstance(value, bool) else f"'{value}'" if isinstance(value, str) else repr(value)


@settings(max_examples=400, deadline=None)
@given(st.sampled_from(SETTINGS), anything)
def test_any_value_of_a_setting_is_read_or_refused_in_one_line(place, value):
    section, setting = place
    try:
        recipe(f"[{section}]\n{setting} = {as_toml(value)}")
    except UserError as error:
        assert "\n" not in str(error)


def test_a_file_without_a_recipe_is_refused(tmp_path):
    with pytest.raises(UserError, match="cannot be read"):
        read_recipe(tmp_path / "none.toml")
    with pytest.raises(UserError, match="first line must be 'ringlet = 2'"):
        parse_recipe("name = 'x'")


def test_numbers_are_in_the_recipe_unit_and_strings_in_their_own():
    for text in (
        "[guides]\nlength = 8",
        "unit = 'mm'\n[guides]\nlength = 80",
        "unit = 'in'\n[guides]\nlength = '8 cm'",
        "unit = 'dm'\n[guides]\nlength = 0.8",
        "[guides]\nlength = '0.8 dm'",
    ):
        assert recipe(text).guides.length.value == pytest.approx(0.08)


def test_a_preset_fills_only_unset_values():
    for unit in ("cm", "m"):
        curl = recipe(f"unit = '{unit}'\n[curl]\npreset = '3C'\ncurls = 5\nstart = '2 mm'").curl
        assert curl.width.value == pytest.approx(0.009)
        assert curl.pitch is None and curl.curls.value == 5.0
        assert curl.start.value == pytest.approx(0.002)


def test_a_number_keeps_the_ramp_and_the_variation_of_the_default():
    width = recipe("[curl]\npreset = '3C'\nwidth = 1").curl.width
    preset = PRESETS["3C"]["width"]
    assert width.value == pytest.approx(0.01)
    assert width.ramp == preset["ramp"] and width.vary == preset["vary"]
    table = recipe("[curl]\npreset = '3C'\nwidth = { vary = 0.5 }").curl.width
    assert table.value == pytest.approx(0.009) and table.vary == 0.5 and table.ramp == preset["ramp"]
    scraggle = recipe("[[shape]]\nop = 'scraggle'\nmagnitude = 2").shape[0].magnitude
    assert scraggle.along(0.0) == 0.0 and scraggle.along(1.0) == 1.0


def test_presets_have_their_documented_diameters_and_get_tighter():
    curls = {name: recipe(f"[curl]\npreset = '{name}'").curl for name in PRESETS}
    assert list(curls) == ["1", "2A", "2B", "2C", "3A", "3B", "3C", "4A", "4B", "4C"]
    millimetres = {name: 1e3 * curl.width.value for name, curl in curls.items()}
    for name, documented in {"3A": 25, "3B": 16, "3C": 9, "4A": 5}.items():
        assert millimetres[name] == pytest.approx(documented)
    assert millimetres["4C"] < 4
    pitches = [curl.pitch.value for curl in curls.values()]
    for alike in (pitches[:4], pitches[4:]):  # waves, and coils
        assert alike == sorted(alike, reverse=True)
    assert curls["4B"].kink.value > 0.5 and curls["4C"].kink.value == 0.0
    assert [name for name, curl in curls.items() if curl.flatness.value > 0.4] == ["1", "2A", "2B", "2C"]


def test_a_ramp_passes_through_its_knots_and_never_overshoots():
    width = recipe("[curl]\npreset = '4A'\nwidth = { value = 1, ramp = [[0, 0], [0.2, 1], [1, 0.5]] }").curl.width
    assert np.allclose(width.along(np.array([0.0, 0.2, 1.0])), [0.0, 1.0, 0.5])
    along = width.along(np.linspace(0.0, 1.0, 200))
    assert along.min() >= 0.0 and along.max() <= 1.0


def test_the_schema_has_bounds_units_and_descriptions_of_every_setting():
    definitions = schema()["$defs"]
    width = definitions["Curl"]["properties"]["width"]
    assert width["unit"] == "m" and width["anyOf"][0] == {"type": "number", "minimum": 0.0, "maximum": 0.2}
    for name, section in definitions.items():
        for setting, about in section["properties"].items():
            if setting not in ("op", "value"):
                assert about.get("description"), f"{name}.{setting} has no description"


def test_the_example_recipe_refers_to_its_head():
    assert read_recipe(EXAMPLE).scalp_file == EXAMPLE.parent / "head.usdc"
