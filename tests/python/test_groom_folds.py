"""A groom that folds a braid says so when it is groomed, checked and simulated."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from commands import run
from ringlet.data.groom import STRAND_RADIUS
from ringlet.groom.bends import eased
from ringlet.groom.operators.operator import grid
from ringlet.groom.scalp import Scalp
from scipy.spatial import KDTree
from scipy.spatial.transform import Rotation

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
lift = 0.35
gravity_bend = 22
whorl = false
[locks]
points = 110
[locks.sections]
pattern = "brick"
size = 5
gap = 0.3
strands = 3
mask = {{ where = "z < -6" }}
{shape}
[hairs]
per_lock = 2
"""
BRAID = '[[shape]]\nop = "braid"\nwidth = 1.3\nstart = 0.8\ntail = 1.2\nsimulate = "core"\n'
WAVES = '[[shape]]\nop = "scraggle"\nmagnitude = 0.7\nwavelength = 1\n'
SHOT = 'ringlet = 2\ngroom = "folds.recipe.toml"\nframes = [1, 1]\npreroll = 0\n'
SAYS = "braids or twists fold back on themselves"


def recipe(path: Path, shape: str) -> Path:
    """A recipe whose guides at the nape hang down at once, along the neck, with these operators."""
    path.write_text(RECIPE.format(head=HEAD, shape=shape))
    return path


@pytest.fixture(scope="module")
def folds(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A recipe that bends braids after they are braided."""
    return recipe(tmp_path_factory.mktemp("folds") / "folds.recipe.toml", BRAID + WAVES)


def test_groom_check_and_sim_say_that_a_braid_folds(folds: Path) -> None:
    groomed = run("groom", folds, "-o", folds.with_name("groom.usdc"))
    assert groomed.exit_code == 0 and SAYS in groomed.output
    summary = ringlet.check_groom(folds.with_name("groom.usdc"))["folds"]
    assert 0 < summary["braids"] <= summary["of"] and f"{summary['braids']} of {summary['of']} {SAYS}" in groomed.output
    assert f"first lock {summary['worst'][0]['lock']} at its point {summary['worst'][0]['point']}:" in groomed.output
    checked = run("check", folds.with_name("groom.usdc"))
    assert checked.exit_code == 1 and SAYS in checked.output
    folds.with_name("s.shot.toml").write_text(SHOT)
    assert SAYS in run("sim", folds.with_name("s.shot.toml"), "-o", folds.with_name("c.usdc")).output


def test_the_advice_about_folds_helps(folds: Path) -> None:
    before = ringlet.build_groom(recipe(folds.with_name("before.recipe.toml"), WAVES + BRAID))
    assert not any(SAYS in line for line in before.conflicts)


def test_braids_lie_on_the_head_as_a_whole(tmp_path: Path) -> None:
    """Their guides lead into the neck, where strands that are led out one by one would come into each other."""
    groom = ringlet.build_groom(recipe(tmp_path / "neck.recipe.toml", BRAID))
    assert not groom.conflicts
    strands = grid(groom.locks).reshape(-1, 3, 110, 3)[:, :, 20:100]
    solid = Scalp(groom.scalp, None).solid
    above = np.stack([solid.above(np.ascontiguousarray(one.reshape(-1, 3)))[0].reshape(3, -1) for one in strands])
    radius = float(groom.locks.curve[STRAND_RADIUS][0])
    assert 0.9 * radius < above.min() < 3.0 * radius
    least = min(KDTree(braid[a]).query(braid[b])[0].min() for braid in strands for a, b in ((0, 1), (0, 2), (1, 2)))
    assert least > 1.6 * radius


def test_lines_are_eased_where_they_turn_too_sharply_and_nowhere_else() -> None:
    random = np.random.default_rng(53)
    for _ in range(12):
        angles = np.zeros((300, 3))
        places = random.integers(20, 280, 5)
        angles[places] = random.uniform(0.0, 1.5, 5)[:, None] * random.normal(size=(5, 3))
        turns = Rotation.from_rotvec(angles)
        heading, line = Rotation.identity(), [np.zeros(3)]
        for turn in turns:
            heading = heading * turn
            line.append(line[-1] + heading.apply([1e-3, 0.0, 0.0]))
        reach = np.full(301, random.uniform(2e-3, 8e-3))
        made = eased(np.array(line), reach)
        edges = np.diff(made, axis=0)
        along = edges / np.linalg.norm(edges, axis=1, keepdims=True)
        window = round(reach[0] / np.linalg.norm(edges, axis=1).mean())
        across = np.sum(along[window:] * along[:-window], axis=1)
        assert np.degrees(np.arccos(np.clip(across, -1.0, 1.0))).max() < 43.5
        assert np.array_equal(made[[0, -1]], np.array(line)[[0, -1]])
    gentle = np.stack([0.05 * np.cos(0.02 * np.arange(200)), 0.05 * np.sin(0.02 * np.arange(200)), np.zeros(200)], 1)
    assert np.array_equal(eased(gentle, np.full(200, 0.02)), gentle)
