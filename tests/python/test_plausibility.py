"""Lengths that are out of proportion to the head get a warning that says how they may be meant."""

from __future__ import annotations

from pathlib import Path

import pytest
from commands import edit, run
from shapes import ball
from small_example import write_example

import ringlet
from ringlet.groom import make_groom, parse_recipe

ROOT = Path(__file__).parents[2]
HEAD = ball()  # a scalp 18 cm across, as the head of the examples
GROOM = "ringlet = 2\nunit = '{unit}'\n[guides]\ncount = 40\nlength = {length}\n[locks]\ncount = 400\npoints = 24\n"


def warnings(text: str) -> list[str]:
    return make_groom(parse_recipe(text), HEAD).conflicts


@pytest.mark.parametrize(
    ("unit", "length", "written"),
    [("cm", 0.25, "0.25 m"), ("cm", 0.08, "0.08 m"), ("mm", 0.3, "0.3 m"), ("mm", 2.5, "2.5 cm"), ("m", 8, "8 cm")],
)
def test_hair_far_too_short_or_long_for_the_head_is_named_once_with_what_may_be_meant(unit, length, written):
    (line,) = warnings(GROOM.format(unit=unit, length=length))
    assert line.startswith(f"guides.length is {length} {unit}, ") and line.endswith(
        f'write "{written}" if that is meant'
    )
    assert "\n" not in line and not warnings(GROOM.format(unit=unit, length=f"'{written}'"))


def test_a_curl_as_narrow_as_a_hair_is_named_once():
    text = GROOM.format(unit="cm", length=6) + "[curl]\nwidth = {width}\npitch = 3\n"
    (line,) = warnings(text.format(width=0.011))
    assert line.startswith("curl.width is 0.011 cm, ") and 'write "0.011 m"' in line
    assert not warnings(text.format(width="'0.011 m'"))


@pytest.mark.parametrize(("unit", "length"), [("cm", "'4 mm'"), ("cm", 0.5), ("cm", 150), ("m", 2e-4), ("m", 4)])
def test_a_crop_and_hair_to_the_floor_are_plausible_and_stubble_in_metres_is_meant(unit, length):
    assert not warnings(GROOM.format(unit=unit, length=length).replace("400", "2000"))


@pytest.mark.parametrize("name", ["child/top", "child/light", "looks/fade", "looks/beard", "types/4C", "types/1"])
def test_no_hair_of_the_examples_is_odd_the_shortest_least_of_all(name):
    made = ringlet.build_groom(ROOT / "examples" / f"{name}.recipe.toml")
    assert not [line for line in made.conflicts if "unit of the recipe" in line]


def test_the_command_warns_in_one_line(tmp_path):
    project = write_example(tmp_path)
    recipe = edit(project / "small.recipe.toml", "length = 5", "length = 0.05")
    result = run("groom", recipe, "-o", project / "groom.usdc")
    lines = [line for line in result.stderr.splitlines() if line.startswith("warning: guides.length is 0.05 cm")]
    assert result.exit_code == 0 and len(lines) == 1
