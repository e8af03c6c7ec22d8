"""The advice of a message is followed, and the message is gone."""

from __future__ import annotations

import re
import shutil
from collections.abc import Callable
from pathlib import Path
from typing import NamedTuple

import numpy as np
import pytest
from commands import edit, refused, run
from pxr import Usd, UsdGeom, Vt
from ringlet.io.hair import HEADER

RECIPE, SHOT = "small.recipe.toml", "small.shot.toml"


class Advice(NamedTuple):
    """A command that is refused, a part of its message with the advice, and what the advice says to do.

    spoil:  makes the input wrong
    line:   the words of the command
    advice: the end of the message, as a pattern
    follow: changes the input as the advice says, or gives the words of the command as it says
    """

    spoil: Callable[[], object]
    line: str
    advice: str
    follow: Callable[[], object] | str


def nothing() -> None: ...


def in_file(name: str, old: str, new: str) -> Callable[[], object]:
    return lambda: edit(Path(name), old, new)


def far_hair() -> None:
    """A .hair file in centimetres, with a lone curve of 12 cm."""
    points = np.float32([[0, 0, 0], [0, 12, 0]])
    Path("a.hair").write_bytes(HEADER.pack(b"HAIR", 1, 2, 2, 1, 0.01, 0.0, 1.0, 1.0, 1.0, b"") + points.tobytes())


def spoil_cache() -> None:
    stage = Usd.Stage.Open("cache.usdc")
    points = UsdGeom.PointBased(stage.GetPrimAtPath("/groom/locks")).GetPointsAttr()
    points.Set(Vt.Vec3fArray([(float("nan"), 0, 0)] * len(points.Get(2))), 2)
    stage.Save()


def simulate() -> None:
    assert run("sim", SHOT, "--groom", "groom.usdc", "-o", "cache.usdc").exit_code == 0


def move_head() -> None:
    stage = Usd.Stage.Open("head.usda")
    points = UsdGeom.PointBased(stage.GetPrimAtPath("/ball/skin")).GetPointsAttr()
    points.Set(Vt.Vec3fArray.FromNumpy(np.array(points.Get()) + np.float32([10, 0, 0])))
    stage.Save()


def add_to(name: str, text: str) -> Callable[[], object]:
    return lambda: Path(name).write_text(Path(name).read_text() + text)


def after_groom(text: str) -> Callable[[], object]:
    return in_file(RECIPE, "ringlet = 2", f"ringlet = 2\n{text}")


GROOM = f"groom {RECIPE} -o out.usdc"
SIM = f"sim {SHOT} --groom groom.usdc -o out.usdc"
HAIR = "hair groom.usdc --cache cache.usdc -o out.usdc"

ADVICE = [
    # Files and places
    Advice(nothing, "groom gone.recipe.toml -o out.usdc", "check the name$|give a recipe file$", GROOM),
    Advice(nothing, f"groom {RECIPE} -o head.usda", "choose another name$", GROOM),
    Advice(lambda: Path("out.usdc").mkdir(), GROOM, "give a file name$", GROOM.replace("out", "new")),
    Advice(nothing, GROOM.replace(".usdc", ".abc"), "must end in .usdc, .usd or .usda", GROOM),
    Advice(nothing, f"groom {SHOT} -o out.usdc", "give a recipe file$", GROOM),
    Advice(nothing, f"sim {RECIPE} -o out.usdc", "give a shot file$", SIM),
    Advice(nothing, "hair groom.usdc --cache groom.usdc -o out.usdc", "make a cache with: ringlet sim", HAIR),
    Advice(spoil_cache, HAIR, "simulate again$", simulate),
    Advice(far_hair, "convert a.hair out.usdc", "with --from-unit$", "convert a.hair out.usdc --from-unit cm"),
    Advice(
        nothing, "convert groom.usdc out.abc --from-unit cm", "leave --from-unit and --from-up out$",
        "convert groom.usdc out.abc",
    ),
    Advice(nothing, "hair groom.usdc --cache cache.usdc -o out.usdc --frames 90:99", "it holds 1 to 4$",
           "hair groom.usdc --cache cache.usdc -o out.usdc --frames 1:4"),
    # The head
    Advice(move_head, SIM, "bind it anew: ringlet sim SHOT --rebind$", f"{SIM} --rebind"),
    Advice(move_head, SIM, "make the groom again, or", lambda: run("groom", RECIPE, "-o", "groom.usdc")),
    Advice(nothing, f"sim {SHOT} -o out.usdc --rebind", "leave it out$", f"sim {SHOT} -o out.usdc"),
    # Recipes
    Advice(in_file(RECIPE, "ringlet = 2", ""), GROOM, "its first line must be 'ringlet = 2'$",
           lambda: Path(RECIPE).write_text("ringlet = 2\n" + Path(RECIPE).read_text())),
    Advice(in_file(RECIPE, "count = 8", "cuont = 8"), GROOM, "did you mean 'count'", in_file(RECIPE, "cuont", "count")),
    Advice(in_file(RECIPE, "count = 8", "count = -1"), GROOM, "must be at least 1$",
           in_file(RECIPE, "count = -1", "count = 1")),
    Advice(in_file(RECIPE, "region = ", "regoin = "), GROOM, "did you mean 'region'",
           in_file(RECIPE, "regoin", "region")),
    Advice(in_file(RECIPE, '"scalp"', '"saclp"'), GROOM, "scalp", in_file(RECIPE, '"saclp"', '"scalp"')),
    Advice(in_file(RECIPE, "width = 1.0", "widht = 1.0"), GROOM, "did you mean 'width'",
           in_file(RECIPE, "widht", "width")),
    Advice(in_file(RECIPE, "pitch = 1.5", ""), GROOM, "give a preset, or one of curls",
           in_file(RECIPE, "width = 1.0", "width = 1.0\ncurls = 4")),
    Advice(in_file(RECIPE, "[curl]", '[[shape]]\nop = "friz"\n[curl]'), GROOM, "did you mean 'frizz'",
           in_file(RECIPE, '"friz"', '"frizz"')),
    Advice(in_file(RECIPE, "length = 5", 'length = "5 mn"'), GROOM, "5 m", in_file(RECIPE, "5 mn", "5 mm")),
    Advice(nothing, f"edit {RECIPE} --freeze 1", r'add a line edits = "small.edits.toml" to it$',
           after_groom('edits = "small.edits.toml"')),
    # Shots
    Advice(nothing, f"{SIM} --contacts c.usdc", r"add \[contact\]$", add_to(SHOT, "\n[contact]\n")),
    Advice(add_to(SHOT, '\n[rest]\nmode = "lofted"\n'), SIM, "make it with: ringlet loft ",
           lambda: run("loft", SHOT, "--groom", "groom.usdc")),
    Advice(in_file(SHOT, "frames = [1, 4]", "frames = [4, 1]"), SIM, "frames", in_file(SHOT, "[4, 1]", "[1, 4]")),
    Advice(nothing, f"{SIM} --locks 4", "leave it out$", SIM),
]  # fmt: skip


@pytest.fixture
def inputs(pipeline, tmp_path, monkeypatch) -> None:
    """A copy of the small example with its groom and its cache, as the current folder."""
    shutil.copytree(pipeline, tmp_path / "copy")
    monkeypatch.chdir(tmp_path / "copy")


@pytest.mark.usefixtures("inputs")
@pytest.mark.parametrize("one", ADVICE, ids=[f"{k}-{one.line.split()[0]}" for k, one in enumerate(ADVICE)])
def test_advice_that_is_followed_helps(one):
    one.spoil()
    message = refused(run(*one.line.split()))
    assert re.search(one.advice, message), message
    line = one.line
    if isinstance(one.follow, str):
        line = one.follow
    else:
        one.follow()
    result = run(*line.split())
    if one.line.startswith("edit"):  # the lock of that example does not exist
        assert message not in result.stderr
    else:
        assert result.exit_code == 0, (message, result.stderr)
