"""A groom that folds a braid says so when it is groomed, checked and simulated."""

from __future__ import annotations

from pathlib import Path

import pytest
from commands import run

import ringlet

HEAD = Path(__file__).parents[2] / "examples" / "child" / "head.usdc"
RECIPE = """
ringlet = 2
seed = 7
[scalp]
file = "{head}"
mesh = "/child/skin"
region = "scalp"
[guides]
count = 80
length = 16
lift = {lift}
gravity_bend = {bend}
whorl = false
[locks]
points = 110
[locks.sections]
pattern = "brick"
size = 5
gap = 0.3
strands = 3
mask = {{ where = "z < -6" }}
[[shape]]
op = "braid"
width = 1.3
start = 0.8
tail = 1.2
simulate = "core"
[hairs]
per_lock = 2
"""
SHOT = 'ringlet = 2\ngroom = "folds.recipe.toml"\nframes = [1, 1]\npreroll = 0\n'
SAYS = "braids or twists fold back on themselves"


@pytest.fixture(scope="module")
def folds(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A recipe whose guides at the nape hang down at once, along the neck."""
    recipe = tmp_path_factory.mktemp("folds") / "folds.recipe.toml"
    recipe.write_text(RECIPE.format(head=HEAD, lift=0.35, bend=22))
    return recipe


def test_groom_check_and_sim_say_that_a_braid_folds(folds: Path) -> None:
    groomed = run("groom", folds, "-o", folds.with_name("groom.usdc"))
    assert groomed.exit_code == 0 and SAYS in groomed.output
    summary = ringlet.check_groom(folds.with_name("groom.usdc"))["folds"]
    assert 0 < summary["braids"] < summary["of"] and f"{summary['braids']} of {summary['of']} {SAYS}" in groomed.output
    assert f"first lock {summary['worst'][0]['lock']} at its point {summary['worst'][0]['point']}:" in groomed.output
    checked = run("check", folds.with_name("groom.usdc"))
    assert checked.exit_code == 1 and SAYS in checked.output
    folds.with_name("s.shot.toml").write_text(SHOT)
    assert SAYS in run("sim", folds.with_name("s.shot.toml"), "-o", folds.with_name("c.usdc")).output


def test_the_advice_about_folds_helps(folds: Path) -> None:
    led_out = folds.with_name("out.recipe.toml")
    led_out.write_text(RECIPE.format(head=HEAD, lift=0.8, bend=4))
    assert not any(SAYS in line for line in ringlet.build_groom(led_out).conflicts)
