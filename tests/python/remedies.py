"""Rows of the tests of advice: a part of a message as the code has it, what is refused so, and what follows its advice.

All of them run in a folder with the small example, its groom and its cache.
"""

from __future__ import annotations

import dataclasses
import os
import struct
from collections.abc import Callable
from pathlib import Path
from typing import Any, NamedTuple
from unittest.mock import patch

import numpy as np
import test_settings_act as recipes
import test_shot_settings_act as shots
from commands import edit, run
from pxr import Sdf, Usd, UsdGeom, Vt
from ringlet.data.picture import PictureSettings
from ringlet.data.toml import to_toml
from ringlet.io.hair import HEADER
from ringlet.io.tfx import HEADER as TFX
from ringlet.shot import parse_shot
from ringlet.shot.solver import Solver
from ringlet.sim.core import step_settings
from ringlet.viewer import protocol
from ringlet.viewer.project import Project
from ringlet.viewer.session import Session
from ringlet.viewer.show.display_groom import GroomEvaluator
from ringlet.viewer.show.grooming import Grooming
from ringlet.viewer.wire import MOST, unpack
from settings_walk import add
from shapes import ball

import ringlet
from ringlet import Curves, Mesh, _core, io
from ringlet.groom import make_groom, parse_recipe

RECIPE, SHOT = "small.recipe.toml", "small.shot.toml"
GROOM = f"groom {RECIPE} -o out.usdc"
SIM = f"sim {SHOT} --groom groom.usdc -o out.usdc"
HAIR = "hair groom.usdc --cache cache.usdc -o out.usdc"

Act = Callable[[], object]


class Advice(NamedTuple):
    """A part of a message with its advice, ``{}`` for what is filled in; what is refused; what follows the advice."""

    part: str
    wrong: Act
    right: Act


def in_order(*acts: Act) -> Act:
    return lambda: [act() for act in acts]


def line(text: str) -> Act:
    """A command line; its refusal is an error."""

    def act() -> None:
        result = run(*text.split())
        if result.exit_code:
            assert result.exit_code == 2, result.output
            raise ringlet.UserError(result.stderr.strip().splitlines()[-1])

    return act


def changed(name: str, *pairs: tuple[str, str]) -> Act:
    def act() -> None:
        for old, new in pairs:
            edit(Path(name), old, new)

    return act


def wrote(name: str, content: str | bytes) -> Act:
    return lambda: Path(name).write_bytes(content if isinstance(content, bytes) else content.encode())


def added(name: str, text: str) -> Act:
    return lambda: wrote(name, Path(name).read_text() + text)()


def recipe(text: str) -> Act:
    """Reads the base of the tests of settings with further tables; 'none' takes a setting out."""
    return lambda: parse_recipe(_with(recipes.BASE, text))


def made(text: str) -> Act:
    """Makes the groom of such a recipe, and its hairs."""
    return lambda: recipes.outcome(_with(recipes.BASE, text))


def shot(text: str) -> Act:
    return lambda: parse_shot(_with(shots.BASE, text))


def moved(text: str) -> Act:
    """Simulates such a shot."""
    return lambda: shots.outcome(_with(shots.BASE, text))


def without_factor(system: str) -> Act:
    """Simulates with this solver where no matrix has a factor, which takes a rare step to reach."""

    def settings(solver: Solver, *step: Any) -> Any:
        if solver.system == "direct":
            raise _core.FactorisationError
        return step_settings(solver, *step)

    def act() -> None:
        with patch("ringlet.sim.scene.step_settings", settings):
            moved(shots.CONTACT + f"[solver]\nsystem = '{system}'\n")()

    return act


def _with(base: str, text: str) -> str:
    data: dict[str, Any] = {}
    add(data, base)
    add(data, text)
    return to_toml(data)


def picture(**settings: Any) -> Act:
    return lambda: PictureSettings.of(settings)


def obj(text: str) -> Act:
    """Converts an OBJ file."""
    return in_order(wrote("a.obj", text), line("convert a.obj out.usdc --from-unit m"))


def hair(hairs: int = 1, points: int = 2, arrays: int = 2, segments: int = 1, thickness: float = 0.01) -> bytes:
    """A .hair file in metres."""
    places = np.linspace(0.0, 0.1, 3 * points, dtype=np.float32)
    return HEADER.pack(b"HAIR", hairs, points, arrays, segments, thickness, 0.0, 1.0, 1.0, 1.0, b"") + places.tobytes()


def converted(name: str, content: bytes) -> Act:
    return in_order(wrote(name, content), line(f"convert {name} out.usdc --from-unit m"))


def staged(name: str, path: str, change: Callable[[Usd.Prim], object], then: str) -> Act:
    """Changes a prim of a copy of a stage, and gives the copy to a command as ``other``."""

    def act() -> None:
        copy = Path(f"other{Path(name).suffix}")
        copy.write_bytes(Path(name).read_bytes())
        stage = Usd.Stage.Open(str(copy))
        change(stage.GetPrimAtPath(path))
        stage.Save()
        line(then)()

    return act


def spoil_layer(prim: Usd.Prim, name: str, value: str) -> None:
    layer = prim.GetStage().GetRootLayer()
    layer.customLayerData = {**layer.customLayerData, "ringlet": {**layer.customLayerData["ringlet"], name: value}}


def packed(text: str) -> bytes:
    """The text of a message, with its length."""
    return struct.pack("<I", len(text)) + text.encode()


def nan_at(prim: Usd.Prim) -> None:
    points = UsdGeom.PointBased(prim).GetPointsAttr()
    points.Set(Vt.Vec3fArray([(float("nan"), 0, 0)] * len(points.Get(2))), 2)


def moved_head() -> None:
    stage = Usd.Stage.Open("head.usda")
    points = UsdGeom.PointBased(stage.GetPrimAtPath("/ball/skin")).GetPointsAttr()
    points.Set(Vt.Vec3fArray.FromNumpy(np.array(points.Get()) + np.float32([10, 0, 0])))
    stage.Save()


def simulated() -> None:
    line(f"sim {SHOT} --groom groom.usdc -o cache.usdc")()


def head_of(faces: str) -> Act:
    """Grows hair on an OBJ file of three points."""
    head = wrote("head.obj", f"v 0 0 0\nv 0 0 9\nv 9 0 0\n{faces}\n")
    text = 'ringlet = 2\n[scalp]\nfile = "head.obj"\nunit = "cm"\n[guides]\ncount = 3\nlength = 5\n'
    return in_order(head, wrote("head.toml", text), line("groom head.toml -o out.usdc"))


groom, sim, hairs = line(GROOM), line(SIM), line(HAIR)
PLAN, WEDGE = f"wedge {SHOT} --openjd plan.json", f"wedge {SHOT} -o w --here --no-picture"
COIL = "[curl]\nwidth = 1\npitch = 2\n"
SECTIONS = "[locks]\ncount = 'none'\n[locks.sections]\nsize = 6\nstrands = 2\n"
EDITS = changed(RECIPE, ("ringlet = 2", 'ringlet = 2\nedits = "small.edits.toml"'))

FILES = [
    Advice("{}: cannot be read ({}); {}", line("groom gone.recipe.toml -o out.usdc"), groom),
    Advice("is the {} of the same run; choose another name", line(f"groom {RECIPE} -o head.usda"), groom),
    Advice("is a folder; give a file name", in_order(lambda: Path("out.usdc").mkdir(), groom),
        line(GROOM.replace("out", "new"))),
    Advice("{}: ends in '{}'; must end in .usdc, .usd or .usda", line(GROOM.replace(".usdc", ".abc")), groom),
    Advice("is a {}; give a {} file", line(f"groom {SHOT} -o out.usdc"), groom),
    Advice("holds no simulated frames; make a cache", line("hair groom.usdc --cache groom.usdc -o out.usdc"), hairs),
    Advice("is not finite at frame {}; simulate again", staged("cache.usdc", "/groom/locks", nan_at,
        HAIR.replace("cache.usdc", "other.usdc")), in_order(simulated, hairs)),
    Advice("{}: nothing touches, --contacts has nothing to write; add [contact]", line(f"{SIM} --contacts c.usdc"),
        in_order(added(SHOT, "\n[contact]\n"), line(f"{SIM} --contacts c.usdc"))),
    Advice("--locks {}: {} has locks already; leave it out", line(f"{SIM} --locks 4"), sim),
    Advice("rebind: {} is a recipe, which grooms the head as it is now; leave it out",
        line(f"sim {SHOT} -o out.usdc --rebind"), line(f"sim {SHOT} -o out.usdc")),
    Advice("stores its unit and up-axis; leave --from-unit and --from-up out",
        line("convert groom.usdc out.abc --from-unit cm"), line("convert groom.usdc out.abc")),
    Advice("has no frame from {} to {}; {}", line(f"{HAIR} --frames 90:99"), line(f"{HAIR} --frames 1:4")),
    Advice("roots are off the scalp, that of lock {} by {} mm; the head has changed: {}", in_order(moved_head, sim),
        line(f"{SIM} --rebind")),
    Advice("there is no such rest shape; make it with: ringlet loft {}", in_order(added(SHOT,
        '\n[rest]\nmode = "lofted"\n'), sim), in_order(line(f"loft {SHOT} --groom groom.usdc"), sim)),
    Advice("names no file for edits; add a line edits", line(f"edit {RECIPE} --freeze 19000000"), in_order(EDITS,
        line(f"edit {RECIPE} --freeze 19000000"))),
    Advice("its first line must be 'ringlet", in_order(changed(RECIPE, ("ringlet = 2", "")), groom),
        in_order(lambda: Path(RECIPE).write_text("ringlet = 2\n" + Path(RECIPE).read_text()), groom)),
    Advice("this Ringlet reads {} files up to {}: update it", in_order(changed(RECIPE, ("ringlet = 2",
        "ringlet = 3")), groom), in_order(changed(RECIPE, ("ringlet = 3", "ringlet = 2")), groom)),
    Advice("is not valid TOML: {}{}; correct it there", in_order(added(RECIPE, "\n[hairs"), groom),
        in_order(lambda: Path(RECIPE).write_text(Path(RECIPE).read_text().removesuffix("\n[hairs")), groom)),
    Advice("ringlet is {}; must be {}, the version of the format", in_order(changed(RECIPE, ("ringlet = 2",
        "ringlet = 'two'")), groom), in_order(changed(RECIPE, ("'two'", "2")), groom)),
    Advice("{}: a groom extends {}, which has several; must have one", in_order(wrote("two.toml",
        f'ringlet = 2\n[grooms.a]\nextends = "{RECIPE}"\n[grooms.b]\nextends = "{RECIPE}"\n'), wrote("all.toml",
        'ringlet = 2\n[grooms.c]\nextends = "two.toml"\n'), line("groom all.toml -o out.usdc")),
        in_order(changed("all.toml", ("two.toml", RECIPE)), line("groom all.toml -o out.usdc"))),
    Advice("is outside of the grooms; move it to", in_order(wrote("all.toml",
        f'ringlet = 2\n[grooms.a]\nextends = "{RECIPE}"\n[curl]\nwidth = 1\npitch = 2\n'),
        line("groom all.toml -o out.usdc")), in_order(changed("all.toml", ("[curl]", "[grooms.a.curl]")),
        line("groom all.toml -o out.usdc"))),
    Advice("has the name {}; use letters, digits and _", in_order(wrote("all.toml",
        f'ringlet = 2\n[grooms."a b"]\nextends = "{RECIPE}"\n'), line("groom all.toml -o out.usdc")),
        in_order(changed("all.toml", ('"a b"', "a_b")), line("groom all.toml -o out.usdc"))),
    Advice("but what it extends {}; give it a value of its own", in_order(wrote("b.toml",
        f'ringlet = 2\nextends = "{RECIPE}"\n[hairs]\nshorter = "130 %"\n'), line("groom b.toml -o out.usdc")),
        in_order(wrote("b.toml", f'ringlet = 2\nextends = "{RECIPE}"\n[hairs]\nshorter = 0.2\n'),
        line("groom b.toml -o out.usdc"))),
    Advice("which extends it in turn; take one of the two away", in_order(wrote("b.toml",
        'ringlet = 2\nextends = "b.toml"\n'), line("groom b.toml -o out.usdc")), in_order(changed("b.toml",
        ('"b.toml"', f'"{RECIPE}"')), line("groom b.toml -o out.usdc"))),
    Advice("unit is {}, that of {} is {}; must be the same", in_order(wrote("b.toml",
        f'ringlet = 2\nunit = "m"\nextends = "{RECIPE}"\n'), line("groom b.toml -o out.usdc")),
        in_order(changed("b.toml", ('unit = "m"\n', "")), line("groom b.toml -o out.usdc"))),
    Advice("does not belong there; it holds [[edit]] and [[sculpt]] tables only", in_order(EDITS,
        wrote("small.edits.toml", "ringlet = 2\nseed = 3\n"), groom), in_order(wrote("small.edits.toml",
        "ringlet = 2\n"), groom)),
    Advice("has both {} and {}, which is its name now; take one of them away", in_order(added(RECIPE,
        "\n[clean]\nmargin = 0\n[collide]\nmargin = 0\n"), groom), in_order(changed(RECIPE, ("[clean]\nmargin = 0\n",
        "")), groom)),
    Advice("scalp.file is {}, but there is no such file; check the name", in_order(changed(RECIPE, ("head.usda",
        "haed.usda")), groom), in_order(changed(RECIPE, ("haed.usda", "head.usda")), groom)),
    Advice("converge: frames are {}:{}; must be two frames", line(f"converge {SHOT} --groom groom.usdc --frames 3:3"),
        line(f"converge {SHOT} --groom groom.usdc --frames 1:2")),
    Advice("its locks are not those of the groom; simulate the shot again", in_order(changed(RECIPE,
        ("count = 8", "count = 7")), line(f"motion {SHOT} cache.usdc")), in_order(line(f"sim {SHOT} -o cache.usdc"),
        line(f"motion {SHOT} cache.usdc"))),
    Advice("has {}{}, which is given instead of strands.{}; take one of them away", in_order(changed(SHOT,
        ("preroll = 0", "preroll = 0\n[strands]\nbend_scale = 2\n[motion]\nbounce = 3")), line(f"motion {SHOT}")),
        in_order(changed(SHOT, ("bend_scale = 2", "")), line(f"motion {SHOT}"))),
    Advice("is {}, but {} is {}, and both say how stiff locks are; take one of them away", in_order(changed(SHOT,
        ("preroll = 0", "preroll = 0\n[motion]\nbounce = 3\nsag = 0.1")), line(f"motion {SHOT}")),
        in_order(changed(SHOT, ("bounce = 3", "")), line(f"motion {SHOT}"))),
    Advice("in which locks hang as groomed, but motion.sag is {}; take that away, or set rest.mode", in_order(changed(
        SHOT, ("preroll = 0", "preroll = 0\nrest.mode = 'equilibrium'\n[motion]\nsag = 0.1")),
        line(f"motion {SHOT}")), in_order(changed(SHOT, ("'equilibrium'", "'none'")), line(f"motion {SHOT}"))),
    Advice("steps a frame settles it in {} s at most; lower it, or set", in_order(changed(SHOT, ("preroll = 0",
        "preroll = 0\n[motion]\nbounce = 11")), line(f"motion {SHOT}")), in_order(changed(SHOT, ("[motion]",
        '[solver]\nintegrator = "bdf2"\nsubsteps = 2\n[motion]')), line(f"motion {SHOT}"))),
    Advice("is a recipe; name the recipe of the variant instead", line(f"sim {SHOT} --variant b -o out.usdc"),
        line(f"sim {SHOT} -o out.usdc")),
    Advice("has no frames for a movie; give hairs made with --cache", line("movie groom.usdc -o frames"), hairs),
    Advice("does not move, so it has no frames {}; give its cache too, with --cache",
        line("hair groom.usdc -o out.usdc --frames 1:4"), line(f"{HAIR} --frames 1:4")),
    Advice("--{} does not go together with --{}; leave one of them out", line(f"{HAIR} --on-demand --velocities"),
        line(f"{HAIR} --on-demand")),
    Advice("--frame {}: does not go together with --frames; leave one of them out",
        line("convert hair.usdc out.abc --frame 1 --frames 1:2"), line("convert hair.usdc out.abc --frame 1")),
    Advice("--frames {}: must be FIRST:LAST, such as 1:48", line(f"{SIM} --frames 1-4"), line(f"{SIM} --frames 1:4")),
    Advice("--frames {}: {}; give FIRST:LAST, such as 1:48", line(f"{SIM} --frames 4:1"), line(f"{SIM} --frames 1:4")),
    Advice("must be LOCK:NAME=VALUE, such as", in_order(EDITS, line(f"edit {RECIPE} --set curl.width=8mm")),
        line(f"edit {RECIPE} --set 19000000:curl.width=8mm")),
    Advice("--fix: needs --output FIXED for the repaired groom", line("check groom.usdc --fix"),
        line("check groom.usdc --fix --output fixed.usdc")),
    Advice("are both called '{}'; rename one of them", in_order(lambda: Path("sub").mkdir(), *(wrote(f"{at}v.toml",
        f'ringlet = 2\nextends = "{up}{RECIPE}"\n') for at, up in (("", ""), ("sub/", "../"))),
        line(f"{GROOM} --variant v.toml --variant sub/v.toml")),
        in_order(lambda: Path("sub/v.toml").rename("sub/w.toml"),
        line(f"{GROOM} --variant v.toml --variant sub/w.toml"))),
    Advice("is what the groom itself is called in the file; choose another name", in_order(wrote("base.recipe.toml",
        f'ringlet = 2\nextends = "{RECIPE}"\n'), line(f"{GROOM} --variant base.recipe.toml")),
        in_order(lambda: Path("base.recipe.toml").rename("more.recipe.toml"),
        line(f"{GROOM} --variant more.recipe.toml"))),
    Advice("a still shows one frame; choose it with --frame", line("render hair.usdc -o s.png --frames 1:2"),
        line("render hair.usdc -o s.png --frame 1 --width 16 --samples 1")),
    Advice("holds no results of a wedge; make them with", line(f"wedge {SHOT} -o w --compare"),
        in_order(line(f"{WEDGE} --set solver.newton=1"), line(f"wedge {SHOT} -o w --compare"))),
    Advice("must be SETTING=VALUE,VALUE", line(f"{PLAN} --set newton"), line(f"{PLAN} --set solver.newton=1")),
    Advice("--set {}: {} is given twice; name all its values in one --set",
        line(f"{PLAN} --set solver.newton=1 --set solver.newton=2"), line(f"{PLAN} --set solver.newton=1,2")),
    Advice("{}: there is no such file; check the name", line("hair gone.usdc -o out.usdc"),
        line("hair groom.usdc -o out.usdc")),
    Advice("is a folder; give a USD file", in_order(lambda: Path("f.usdc").mkdir(), line("hair f.usdc -o out.usdc")),
        line("hair groom.usdc -o out.usdc")),
    Advice("is empty; write it again or choose another", in_order(wrote("e.usdc", ""),
        line("hair e.usdc -o out.usdc")), line("hair groom.usdc -o out.usdc")),
    Advice("is not a Ringlet groom; make one with", line("hair head.usda -o out.usdc"),
        line("hair groom.usdc -o out.usdc")),
    Advice("has no variant '{}'", line("hair groom.usdc --variant b -o out.usdc"),
        line("hair groom.usdc -o out.usdc")),
    Advice("is not a rest shape; make one with: ringlet loft SHOT.toml", in_order(added(SHOT,
        '\n[rest]\nmode = "lofted"\nfile = "groom.usdc"\n'), sim), in_order(changed(SHOT, ('file = "groom.usdc"\n',
        "")), line(f"loft {SHOT} --groom groom.usdc"), sim)),
    Advice("is stale, {}; {}, or use it as it is with --allow-stale", in_order(added(SHOT,
        '\n[rest]\nmode = "lofted"\n'), line(f"loft {SHOT} --groom groom.usdc"), added(SHOT,
        "[strands]\nbend_scale = 2\n"), sim), in_order(line(f"{SIM} --allow-stale"),
        line(f"loft {SHOT} --groom groom.usdc"), sim)),
    Advice("holds {}, which is no checkpoint; choose another place", in_order(lambda: Path("out.usdc.part").mkdir(),
        wrote("out.usdc.part/notes.txt", "mine"), sim), line(SIM.replace("out", "new"))),
    Advice("lock {} is not edited", in_order(EDITS, line(f"edit {RECIPE} --freeze 19000000"),
        line(f"edit {RECIPE} --release 19000001")), line(f"edit {RECIPE} --release 19000000")),
    Advice("there is no lock {}; the nearest id is {}", in_order(EDITS, line(f"edit {RECIPE} --freeze 19000001")),
        line(f"edit {RECIPE} --freeze 19000000")),
    Advice("is no page; give a name that ends with .html", line(f"share {RECIPE} -o out.txt"),
        line(f"share {RECIPE} -o out.html")),
    Advice("there is no such file; give a recipe or a USD file with hair", line("share gone.toml -o out.html"),
        line("share hair.usdc -o out.html")),
    Advice("a video cannot be transparent; give a folder", line("movie hair.usdc -o m.mp4 --background transparent"),
        groom),
    Advice("must end in {}, or be a folder of frames", line("movie hair.usdc -o m.gif"), groom),
    Advice("{}: is a file, but frames need a folder; give another name", in_order(wrote("frames", "x"),
        line("movie hair.usdc -o frames")), groom),
    Advice("wedge: {}: {} is not a setting{}", line(f"{PLAN} --set solver.newtom=1"),
        line(f"{PLAN} --set solver.newton=1")),
]  # fmt: skip

FORMATS = [
    Advice("is not a .hair file (it does not begin with HAIR); choose another", converted("a.hair",
        b"WOOL" + hair()[4:]), converted("a.hair", hair())),
    Advice("holds no points; export it again", converted("a.hair", hair(arrays=0)), converted("a.hair", hair())),
    Advice("bytes, too few for {} points; export it again", converted("a.hair", hair()[:-4]), converted("a.hair",
        hair())),
    Advice("bytes, but says it holds {} or more; export it again", converted("a.hair", hair(arrays=6)),
        converted("a.hair", hair())),
    Advice("hairs of {} segments do not make {} points; export it again", converted("a.hair", hair(segments=3)),
        converted("a.hair", hair())),
    Advice("{} thick; must be from 0 to {}", converted("a.hair", hair(thickness=-1.0)), converted("a.hair",
        hair(thickness=0.0))),
    Advice("has {} bytes, too few for a .tfx file; export it again", converted("a.tfx", b"tfx"),
        in_order(line("convert groom.usdc a.tfx"), line("convert a.tfx out.usdc --from-unit m"))),
    Advice("is no .tfx file of version 4", converted("a.tfx", bytes(TFX.size)),
        in_order(line("convert groom.usdc a.tfx"), line("convert a.tfx out.usdc --from-unit m"))),
    Advice("holds {} strands of {} points; must have at least 1 of 2", converted("a.tfx", struct.pack("<f",
        4.0) + bytes(TFX.size)), line("convert groom.usdc a.tfx")),
    Advice("a face uses point {}; must be from 1 to {}", head_of("f 1 2 4"), head_of("f 1 2 3")),
    Advice("a face uses vt {}; must be from 1 to {}", head_of("vt 0 0\nf 1/1 2/1 3/2"),
        head_of("vt 0 0\nf 1/1 2/1 3/1")),
    Advice("a line uses point {}; must be from 1 to {}", obj("v 0 0 0\nv 0 1 0\nl 1 3\n"),
        obj("v 0 0 0\nv 0 1 0\nl 1 2\n")),
    Advice("line {} is '{}'; must be numbers after '{}'", obj("v 0 a 0\n"), obj("v 0 0 0\nv 0 1 0\nl 1 2\n")),
    Advice("groups; must be at most {}", head_of("g " + " ".join(f"g{k}" for k in range(101)) + "\nf 1 2 3"),
        head_of("g a\nf 1 2 3")),
    Advice("face {} has {} corners; must have at least 3", head_of("f 1 2"), head_of("f 1 2 3")),
    Advice("packages are not written; name a", line("convert groom.usdc out.usdz"),
        line("convert groom.usdc out.usdc")),
    Advice("{}: is no Alembic archive; choose another", in_order(wrote("a.abc", "no"),
        line("convert a.abc out.usdc")), in_order(line("convert groom.usdc a.abc"), line("convert a.abc out.usdc"))),
    Advice("{}: there are no curves; give at least one", obj("v 0 0 0\nv 0 1 0\n"), obj("v 0 0 0\nv 0 1 0\nl 1 2\n")),
]  # fmt: skip

RECIPES = [
    Advice("is empty; give at least one [place, factor]", recipe(COIL + "opening = []"),
        recipe(COIL + "opening = [[0, 1]]")),
    Advice("has a factor of {}; must be at least 0", recipe(COIL + "opening = [[0, -1]]"),
        recipe(COIL + "opening = [[0, 0]]")),
    Advice("has a place at {}; must be between 0 (root) and 1 (tip)", recipe(COIL + "opening = [[2, 1]]"),
        recipe(COIL + "opening = [[1, 1]]")),
    Advice("has places {}; must ascend", recipe(COIL + "opening = [[1, 1], [0, 1]]"),
        recipe(COIL + "opening = [[0, 1], [1, 1]]")),
    Advice("is {}; must be a number{}", recipe("[guides]\nlength = '5 mn'"), recipe("[guides]\nlength = '5 mm'")),
    Advice("is nan; must be finite", recipe("[guides]\nlength = nan"), recipe("[guides]\nlength = 5")),
    Advice("is {}{} times {} of its ramp; must be at most {}{}",
        recipe("[curl]\ncurls = 3\nwidth = { value = 1, ramp = [[0, 1], [1, 21]] }"),
        recipe("[curl]\ncurls = 3\nwidth = { value = 1, ramp = [[0, 1], [1, 20]] }")),
    Advice("has a factor of {}; must be at most {}", recipe("[curl]\ncurls = 3\nopening = [[0, 11]]"),
        recipe("[curl]\ncurls = 3\nopening = [[0, 10]]")),
    Advice("; must be a colour such as", recipe("[color.dye]\ncolor = 'mud'"),
        recipe("[color.dye]\ncolor = '#b4531f'")),
    Advice("needs either 'lines' or a 'region'; give one of them", recipe("[scalp.edge]\nwidth = 1"),
        made("[scalp.edge]\nwidth = 1\nregion = 'front'")),
    Advice("has 'both_sides', which is for 'lines'; name a region",
        recipe("[scalp.edge]\nwidth = 1\nregion = 'front'\nboth_sides = true"),
        recipe("[scalp.edge]\nwidth = 1\nregion = 'front'")),
    Advice("changes nothing; give it 'set', 'length', 'curve', 'offsets' or 'move', or take it away",
        recipe("[[edit]]\nlock = 1"), recipe("[[edit]]\nlock = 1\ncurve = [[0, 0, 0], [0, 0, 1]]")),
    Advice("has a length, which counts before the lock is curled; give it stage = 'shape'",
        recipe("[[edit]]\nlock = 1\nlength = 2"), recipe("[[edit]]\nlock = 1\nlength = 2\nstage = 'shape'")),
    Advice("needs one of 'toward', 'curve' and 'border = true'; it says from where distances count",
        recipe("[gradients.a]\nend = 1"), recipe("[gradients.a]\nend = 1\nborder = true")),
    Advice("has the same start and end; set the distances between which it changes",
        recipe("[gradients.a]\nend = 0\nborder = true"), recipe("[gradients.a]\nend = 1\nborder = true")),
    Advice("has a curve of {} point(s); give at least 2", recipe("[[edit]]\nlock = 1\ncurve = [[0, 0, 0]]"),
        recipe("[[edit]]\nlock = 1\ncurve = [[0, 0, 0], [0, 0, 1]]")),
    Advice("may use only numbers, comparisons",
        recipe("[guides]\nlift = 0\n[[shape]]\nop = 'frizz'\nmask = { where = 'print(1)' }"),
        recipe("[[shape]]\nop = 'frizz'\nmask = { where = 'id > 3' }")),
    Advice("; must be an expression such as", recipe("[[shape]]\nop = 'frizz'\nmask = { where = 'id %' }"),
        recipe("[[shape]]\nop = 'frizz'\nmask = { where = 'id % 2 == 0' }")),
    Advice("has '{}', which is not known{}", recipe("[[shape]]\nop = 'frizz'\nmask = { where = 'di > 3' }"),
        recipe("[[shape]]\nop = 'frizz'\nmask = { where = 'id > 3' }")),
    Advice("needs either a 'file' or the 'middle' of an ellipsoid", recipe("[meshes.round]\nwidth = 2"),
        recipe(recipes.ROUND)),
    Advice("has {} point(s); give at least 2", recipe("[curves.tail]\npoints = [[0, 0, 0]]"), recipe(recipes.TAIL)),
    Advice("needs either 'points' or a 'file'; give one of them", recipe("[curves.tail]\n"), recipe(recipes.TAIL)),
    Advice("says neither how many curls nor how close; give a preset", recipe("[curl]\nwidth = 1"),
        recipe("[curl]\nwidth = 1\ncurls = 4")),
    Advice("has both '{}' and '{}'; give exactly one of curls, curls_per_cm and pitch",
        recipe("[curl]\nwidth = 1\ncurls = 4\npitch = 2"), recipe(COIL)),
    Advice("does not say where it is; give it 'toward' or a 'mask'", recipe("[[guides.zone]]\nlength = 2"),
        recipe("[[guides.zone]]\nlength = 2\ntoward = [0, 1, 0]")),
    Advice("has a falloff that its cone has no room for; give it 'toward', and an 'angle' as large",
        recipe("[[guides.zone]]\nlength = 2\nfalloff = 20\nmask = 0.5"),
        recipe("[[guides.zone]]\nlength = 2\nfalloff = 20\ntoward = [0, 1, 0]\nangle = 20")),
    Advice("has a hairline, but every guide becomes a lock; give it 'count' or 'spacing'",
        recipe("[locks]\ncount = 'none'\n[locks.hairline]\nwidth = 1"),
        recipe("[locks]\ncount = 40\n[locks.hairline]\nwidth = 1")),
    Advice("has a density, but every guide becomes a lock; give it",
        recipe("[locks]\ncount = 'none'\ndensity = 'paint'"), recipe("[locks]\ncount = 8\ndensity = 'paint'")),
    Advice("has a line and also a mesh; give one of them",
        recipe(recipes.TAIL + recipes.ROUND + "[[shape]]\nop = 'cut'\nline = 'tail'\nmesh = 'round'"),
        recipe(recipes.TAIL + "[[shape]]\nop = 'cut'\nline = 'tail'")),
    Advice("has no place for the tie; give it a curve", recipe("[[shape]]\nop = 'tie'"),
        recipe("[[shape]]\nop = 'tie'\ntoward = [0, 1, 0]")),
    Advice("has a curve and also toward or each = 'section'; give one of them",
        recipe(recipes.TAIL + "[[shape]]\nop = 'tie'\ncurve = 'tail'\ntoward = [0, 1, 0]"),
        recipe("[[shape]]\nop = 'tie'\ntoward = [0, 1, 0]")),
    Advice("which points nowhere; must have a length from {} to {}", recipe("[guides.mirror]\nacross = [0, 0, 0]"),
        recipe("[guides.mirror]\nacross = [1, 0, 0]")),
    Advice("changes nothing; give it 'length' or 'offsets', or take it away", recipe("[[sculpt]]\nguide = 3"),
        recipe("[[sculpt]]\nguide = 3\nlength = 1.5")),
    Advice("needs both pattern = 'drawn' and 'part_lines'", recipe(SECTIONS + "pattern = 'drawn'"), recipe(SECTIONS)),
    Advice("is '{}', which is no helper curve{}", made(recipes.TAIL + "[[shape]]\nop = 'attract'\ncurve = 'tial'"),
        made(recipes.TAIL + "[[shape]]\nop = 'attract'\ncurve = 'tail'")),
    Advice("is '{}', which is no helper mesh{}", made(recipes.ROUND + "[[shape]]\nop = 'grow_to'\nmesh = 'ruond'"),
        made(recipes.ROUND + "[[shape]]\nop = 'grow_to'\nmesh = 'round'")),
    Advice("ends before it starts; set an 'end' beyond the 'start'",
        made(recipes.TAIL + "[[shape]]\nop = 'finger_wave'\ncurve = 'tail'\nstart = 2\nend = 1"),
        made(recipes.TAIL + "[[shape]]\nop = 'finger_wave'\ncurve = 'tail'\nstart = 2\nend = 4")),
    Advice("has no line to run along; name a curve of [curves], or give guides.part_line",
        made("[[shape]]\nop = 'finger_wave'"),
        made("[guides]\npart_line = { offset = 0 }\n[[shape]]\nop = 'finger_wave'")),
    Advice("has {} points of a lock in a wave, where it needs {}; raise locks.points, or the wavelength",
        made(recipes.TAIL + "[[shape]]\nop = 'finger_wave'\ncurve = 'tail'\nwavelength = '5 mm'"),
        made(recipes.TAIL + "[[shape]]\nop = 'finger_wave'\ncurve = 'tail'\nwavelength = '5 cm'")),
    Advice("each is 'section', but there are none; add [locks.sections]",
        made("[[shape]]\nop = 'tie'\neach = 'section'"), made(SECTIONS + "[[shape]]\nop = 'tie'\neach = 'section'")),
    Advice("too few for {} curls ({} points a curl); {}", made("[curl]\ncurls = 30"),
        made("[locks]\npoints = 400\n[curl]\ncurls = 30")),
    Advice("which only locks of sections and edges have; add [locks.sections] or [scalp.edge]",
        made("[[shape]]\nop = 'frizz'\nmask = { where = 'section > 0' }"),
        made(SECTIONS + "[[shape]]\nop = 'frizz'\nmask = { where = 'section > 0' }")),
    Advice("no section has strands; set locks.sections.strands, such as 3, and see its mask",
        made("[locks]\ncount = 'none'\n[locks.sections]\nsize = 6\n[[shape]]\nop = 'braid'\nwidth = 1\npitch = 3"),
        made(recipes.STRANDS + "[[shape]]\nop = 'braid'\nwidth = 2\npitch = 5")),
    Advice("needs an area, but scalp.edge grows hair on lines; take one of the two away",
        made("[scalp.edge]\nwidth = 0\nregion = 'front'\n" + SECTIONS), made(SECTIONS)),
    Advice("is '{}', which neither the locks nor {} have{}", made("[guides]\nlength = { value = 5, map = 'piant' }"),
        made("[guides]\nlength = { value = 5, map = 'paint' }")),
    Advice("is '{}', which {} has no directions for{}", made("[guides]\ndirection = 'cmobed'"),
        made("[guides]\ndirection = 'combed'")),
    Advice("less than the {} m between the points of a shape; set locks.shape_points",
        made("[[shape]]\nop = 'frizz'\nwavelength = '1 mm'"),
        made("[locks]\nshape_points = 130\n[[shape]]\nop = 'frizz'\nwavelength = '1 mm'")),
    Advice("too few for {} turns of hairs.coil",
        made("[hairs]\nper_lock = 12\npoints = 8\n[hairs.families]\n[hairs.coil]\npitch = '1 mm'"),
        made("[hairs]\nper_lock = 12\npoints = 800\n[hairs.families]\n[hairs.coil]\npitch = '1 mm'")),
]  # fmt: skip

PAIR = shots.CONTACT + "[[contact.pair]]\nbetween = ['locks', 'flor']\nfriction = 0.9\n"
SHOTS = [
    Advice("must be at most 1 (or limit_twist = false", shot("[strands]\ntwist_ratio = 2"),
        in_order(shot("[strands]\ntwist_ratio = 1"), shot("[strands]\ntwist_ratio = 2\nlimit_twist = false"))),
    Advice("is there, but locks touch nothing; add a table [contact]", shot("[[collider]]\nname = 'floor'\n"),
        shot(shots.CONTACT)),
    Advice("names no mesh; give `mesh`", shot("[contact]\n[[cloth]]\nname = 'sheet'\n"), shot(shots.CLOTH)),
    Advice("but there is no `to`; name the collider",
        shot(shots.CLOTH + "[[cloth.pin]]\nsubset = 'front'\nwithin = 0.1\n"),
        shot(shots.CLOTH + "[[cloth.pin]]\nto = 'floor'\nwithin = 0.1\n")),
    Advice("between[{}] is '{}', which is no name in the shot{}", moved(PAIR), moved(PAIR.replace("flor", "floor"))),
    Advice("{}.to is '{}', which is no collider{}", moved(shots.CLOTH + "[[cloth.pin]]\nto = 'flor'\nwithin = 0.1\n"),
        moved(shots.CLOTH + "[[cloth.pin]]\nto = 'floor'\nwithin = 0.1\n")),
    Advice("{}.subset is '{}', which {} does not have{}", moved(shots.PINNED.replace("front", "frnt")),
        moved(shots.PINNED)),
    Advice("{}.map is '{}', which {} does not have{}", moved(shots.CLOTH + "[[cloth.pin]]\nmap = 'stif'\n"),
        moved(shots.CLOTH + "[[cloth.pin]]\nmap = 'stiff'\n")),
    Advice("but the nearest vertex is {} m from '{}'; raise it",
        moved(shots.CLOTH + "[[cloth.pin]]\nto = 'floor'\nwithin = 1e-6\n"),
        moved(shots.CLOTH + "[[cloth.pin]]\nto = 'floor'\nwithin = 0.5\n")),
    Advice("only 'history' can be without one", shot("[solver]\nsafeguards = []\n"),
        shot("[solver]\ncontinuation = 'history'\nsafeguards = []\n")),
    Advice("solver.system is 'direct', but the matrix",
        without_factor("direct"), without_factor("conjugate_gradient")),
    Advice("which needs solver.continuation = 'material_frame'",
        moved("[rest]\nmode = 'equilibrium'\n[solver]\ncontinuation = 'history'\n"),
        moved("[rest]\nmode = 'equilibrium'\n[solver]\ncontinuation = 'material_frame'\n")),
    Advice("loft: rest.gain is set, but rest.mode 'equilibrium'", moved("[rest]\nmode = 'equilibrium'\ngain = 0.5\n"),
        moved("[rest]\nmode = 'lofted'\ngain = 0.5\n")),
    Advice("rest.mode 'equilibrium' needs at least 3", moved("held = 2\n[rest]\nmode = 'equilibrium'\n"),
        moved("held = 3\n[rest]\nmode = 'equilibrium'\n")),
    Advice("sim: held is {}, but a lock has {} points; hold fewer, or resample", moved("held = 60\n"),
        moved("held = 2\n")),
]  # fmt: skip

PICTURES = [
    Advice("picture: {} is {}; must be at least {} and at most {}", picture(width=0), picture(width=16)),
    Advice("picture: {} is '{}'; choose one of {}", picture(engine="gpu"), picture(engine="scalar")),
    Advice("picture: {} is given with camera {}, which has its own; leave one out", picture(camera="/c",
        view="front"), picture(camera="/c")),
    Advice("picture: there is no hair colour '{}'; choose one of",
        line("render hair.usdc -o a.png --color mud --width 16 --samples 1"),
        line("render hair.usdc -o a.png --color brown --width 16 --samples 1")),
    Advice("picture: there is no view '{}'; choose one of",
        line("render hair.usdc -o a.png --view top-left --width 16 --samples 1"),
        line("render hair.usdc -o a.png --view 90,4 --width 16 --samples 1")),
    Advice("picture: there is no light '{}'; choose one of",
        line("render hair.usdc -o a.png --light sunny --width 16 --samples 1"),
        line("render hair.usdc -o a.png --light studio --width 16 --samples 1")),
    Advice("the azimuth must be at most 360, the elevation {}",
        line("render hair.usdc -o a.png --view 400,4 --width 16 --samples 1"),
        line("render hair.usdc -o a.png --view 90,4 --width 16 --samples 1")),
    Advice("a JPEG cannot be transparent; choose .png or .exr",
        line("render hair.usdc -o a.jpg --background transparent --width 16 --samples 1"),
        line("render hair.usdc -o a.png --background transparent --width 16 --samples 1")),
    Advice("has no hairs; make them with: ringlet hair {} -o hair.usdc",
        line("render groom.usdc -o a.png --width 16 --samples 1"), in_order(line("hair groom.usdc -o hair.usdc"),
        line("render hair.usdc -o a.png --width 16 --samples 1"))),
    Advice("has no frames, so that nothing moves; leave out the shutter",
        in_order(line("hair groom.usdc -o still.usdc"),
        line("render still.usdc -o a.png --shutter 180 --width 16 --samples 1")),
        line("render still.usdc -o a.png --width 16 --samples 1")),
    Advice("has no hairs at frame {}; it holds {} to {}",
        line("render hair.usdc -o a.png --frame 9 --width 16 --samples 1"),
        line("render hair.usdc -o a.png --frame 4 --width 16 --samples 1")),
]  # fmt: skip

HEAD, SKIN = "head.usda", "/ball/skin"


def head(change: Callable[[Usd.Stage, UsdGeom.Mesh], object] | None = None, region: str = "scalp") -> Act:
    """Grooms a head after a change; without one, the head as it was."""

    def act() -> None:
        kept = Path("kept.usda")
        if not kept.exists():
            kept.write_bytes(Path(HEAD).read_bytes())
        Path(HEAD).write_bytes(kept.read_bytes())
        if change is not None:
            stage = Usd.Stage.Open(HEAD)
            stage.Reload()
            change(stage, UsdGeom.Mesh(stage.GetPrimAtPath(SKIN)))
            stage.Save()
        groom()

    return act


def unwrap(mesh: UsdGeom.Mesh, values: list[tuple[float, float]], indices: list[int] | None = None) -> None:
    primvar = UsdGeom.PrimvarsAPI(mesh).CreatePrimvar("st", Sdf.ValueTypeNames.TexCoord2fArray, "faceVarying")
    primvar.Set(values)
    if indices:
        primvar.SetIndices(indices)


def of_head(part: str, change: Callable[[Usd.Stage, UsdGeom.Mesh], object]) -> Advice:
    return Advice(part, head(change), head())


def counts(change: Callable[[list[int]], list[int]]) -> Callable[[Usd.Stage, UsdGeom.Mesh], object]:
    return lambda stage, mesh: mesh.GetFaceVertexCountsAttr().Set(change(list(mesh.GetFaceVertexCountsAttr().Get())))


def points(
    change: Callable[[np.ndarray], np.ndarray], frame: float | None = None
) -> Callable[[Usd.Stage, UsdGeom.Mesh], object]:
    def act(stage: Usd.Stage, mesh: UsdGeom.Mesh) -> None:
        value = Vt.Vec3fArray.FromNumpy(change(np.array(mesh.GetPointsAttr().Get())).astype(np.float32))
        mesh.GetPointsAttr().Set(value, Usd.TimeCode.Default() if frame is None else frame)

    return act


def shirt(add: Callable[[Usd.Prim], object]) -> Callable[[Usd.Stage, UsdGeom.Mesh], object]:
    return lambda stage, mesh: add(stage.DefinePrim("/ball/shirt"))


def inactive(change: Callable[[Usd.Stage, UsdGeom.Mesh], object]) -> Act:
    """The head with a prim that is deactivated."""

    def act(stage: Usd.Stage, mesh: UsdGeom.Mesh) -> None:
        change(stage, mesh)
        stage.GetPrimAtPath("/ball/shirt").SetActive(False)

    return head(act)


GONE = shirt(lambda prim: prim.GetReferences().AddReference("./gone.usda"))
ASTRAY = shirt(lambda prim: prim.GetReferences().AddInternalReference("/gone"))
HEADS = [
    of_head("{}: has no points; export it again or choose another", points(lambda old: old[:0])),
    of_head("{}: point {} is {}; must be finite, and at most {} from 0", points(lambda old: np.full_like(old,
        np.inf))),
    of_head("{}: has no faces; export it again or choose another mesh", counts(lambda old: [])),
    of_head("its faces have {} corners, but there are {} indices; export it again", counts(lambda old: old[1:])),
    of_head("{}: a face uses point {}; must be from 0 to {}", lambda stage,
        mesh: mesh.GetFaceVertexIndicesAttr().Set([999] * 672)),
    of_head("names face {}; must be from 0 to {}", lambda stage, mesh: UsdGeom.Subset.CreateGeomSubset(mesh, "neck",
        "face", [999])),
    of_head("values for {}; must have one for each", lambda stage, mesh: unwrap(mesh, [(0, 0)] * 7)),
    of_head("has a value that is no number; must be finite", lambda stage, mesh: unwrap(mesh, [(0,
        float("nan"))] * 672)),
    of_head("has an index outside of 0 to {}", lambda stage, mesh: unwrap(mesh, [(0, 0)], [5] * 672)),
    of_head("{}: {} is {}; must be from {} to {}", lambda stage, mesh: stage.SetMetadata("metersPerUnit", 0.0)),
    Advice("refers to {}, which is not there; put it back, or deactivate the prim", head(GONE), inactive(GONE)),
    Advice("which is not there; name another, or deactivate the prim", head(ASTRAY), inactive(ASTRAY)),
    of_head("lies over {}, which is not there; put it back", lambda stage,
        mesh: stage.GetRootLayer().subLayerPaths.append("./gone.usda")),
    of_head("has {} {} prims; name one of: {}", lambda stage, mesh: Sdf.CopySpec(stage.GetRootLayer(), SKIN,
        stage.GetRootLayer(), "/ball/other")),
    of_head("has no {} prim; export one or choose another file", lambda stage, mesh: stage.RemovePrim(SKIN)),
    Advice("has no prim {}; {}", in_order(changed(RECIPE, ('"scalp"', '"scalp"\nmesh = "/ball/skni"')), groom),
        in_order(changed(RECIPE, ("skni", "skin")), groom)),
    Advice("is no regular file but a {}; {}", in_order(lambda: os.mkfifo("r.toml"), line("groom r.toml -o out.usdc")),
        groom),
    Advice("is not JSON; write the file again", staged("cache.usdc", "/", lambda prim: spoil_layer(prim, "statistics",
        "{"), HAIR.replace("cache.usdc", "other.usdc")), in_order(simulated, hairs)),
    Advice("has layout {}; this Ringlet reads up to {}: update it", staged("groom.usdc", "/groom",
        lambda prim: prim.GetAttribute("ringlet:version").Set(99), "hair other.usdc -o out.usdc"), in_order(groom,
        line("hair out.usdc -o new.usdc"))),
    Advice("has a root on triangle {}, but {} has {}; the head has changed: {}", staged("groom.usdc", "/groom/locks",
        lambda prim: prim.GetAttribute("primvars:ringlet:root_triangle").Set([9999] * 8),
        "hair other.usdc -o out.usdc"), in_order(groom, line("hair out.usdc -o new.usdc"))),
    Advice("beside its triangle of {} (weights {}): it is not on the scalp; make the groom again",
        staged("groom.usdc", "/groom/locks",
        lambda prim: prim.GetAttribute("ringlet:root_barycentric").Set([(9, 9, 9)] * 8),
        "hair other.usdc -o out.usdc"), in_order(groom, line("hair out.usdc -o new.usdc"))),
    Advice("has no ringlet:id for each of its {} curves; write the file again", staged("groom.usdc", "/groom/locks",
        lambda prim: prim.GetAttribute("ringlet:id").Set([1, 2]), "hair other.usdc -o out.usdc"),
        in_order(groom, line("hair out.usdc -o new.usdc"))),
    Advice("has {} points at frame {}, its groom {}; simulate again", staged("cache.usdc", "/groom/locks",
        lambda prim: prim.GetAttribute("points").Set([(0, 0, 0)] * 7, 2), HAIR.replace("cache.usdc", "other.usdc")),
        in_order(simulated, hairs)),
]  # fmt: skip


def curves(change: Callable[[Usd.Prim], object]) -> Act:
    """Converts two curves of four points after a change."""

    def act() -> None:
        stage = Usd.Stage.CreateInMemory()
        UsdGeom.SetStageMetersPerUnit(stage, 0.01)
        stage.SetDefaultPrim(stage.DefinePrim("/hair", "BasisCurves"))
        made = UsdGeom.BasisCurves(stage.GetPrimAtPath("/hair"))
        made.CreateTypeAttr("cubic")
        made.CreateBasisAttr("bezier")
        made.CreateCurveVertexCountsAttr([4, 4])
        made.CreatePointsAttr([(x, y, 0) for x in range(2) for y in range(4)])
        change(made.GetPrim())
        stage.GetRootLayer().Export("curves.usda")
        line("convert curves.usda out.usdc")()

    return act


def set_to(**values: Any) -> Callable[[Usd.Prim], object]:
    return lambda prim: [prim.GetAttribute(name).Set(value) for name, value in values.items()]


def with_widths(values: list[float], interpolation: str = "vertex") -> Callable[[Usd.Prim], object]:
    def change(prim: Usd.Prim) -> None:
        UsdGeom.BasisCurves(prim).CreateWidthsAttr(values)
        UsdGeom.BasisCurves(prim).SetWidthsInterpolation(interpolation)

    return change


def with_primvar(name: str, values: list[float]) -> Callable[[Usd.Prim], object]:
    def change(prim: Usd.Prim) -> None:
        UsdGeom.PrimvarsAPI(prim).CreatePrimvar(name, Sdf.ValueTypeNames.FloatArray, "vertex").Set(values)

    return change


BOB = np.array([[0.0, 0.0, 0.0], [0.0, 0.1, 0.0]])
CURVES = [
    Advice("wrap is periodic; must be nonperiodic or pinned", curves(set_to(wrap="periodic")),
        curves(set_to(wrap="nonperiodic"))),
    Advice("basis is {}; must be bezier, bspline or catmullRom", curves(set_to(basis="hermite")),
        curves(set_to(basis="bspline"))),
    Advice("{}: curve {} has {} points; {} {} curves must have {}", curves(set_to(curveVertexCounts=[5, 3])),
        curves(set_to(curveVertexCounts=[4, 4]))),
    Advice("curveVertexCounts add up to {}, but there are {} points", curves(set_to(curveVertexCounts=[4, 7])),
        curves(set_to(curveVertexCounts=[4, 4]))),
    Advice("{}: curve {} has {} point(s); must have at least 2", curves(set_to(curveVertexCounts=[7, 1])),
        curves(set_to(curveVertexCounts=[4, 4]))),
    Advice("has length 0; remove it or draw it out", curves(set_to(points=[(1, 1, 1)] * 8)), curves(set_to(points=[(0,
        y, 0) for y in range(8)]))),
    Advice("point counts add up to {}, but there are {} points; export it again", lambda: Curves(BOB, np.array([0,
        3]), np.array([1])).check("a"), lambda: Curves(BOB, np.array([0, 2]), np.array([1])).check("a")),
    Advice("id {} is used by {} curves; ids must be unique", lambda: Curves.from_list([BOB, BOB], np.array([1,
        1])).check("a"), lambda: Curves.from_list([BOB, BOB], np.array([1, 2])).check("a")),
    Advice("curve {}, point {} is {}; must be finite, and at most {} from 0",
        lambda: Curves.from_list([BOB * np.nan]).check("a"), lambda: Curves.from_list([BOB]).check("a")),
    Advice("{}: curve {} has {} points; must have at least 3", lambda: Curves.from_list([BOB]).check_strands("a"),
        lambda: Curves.from_list([np.linspace(*BOB, 3)]).check_strands("a")),
    Advice("coincide at ({}) m; move them apart, or resample it", lambda: Curves.from_list([np.repeat(BOB, 2,
        axis=0)]).check_strands("a"), lambda: Curves.from_list([np.linspace(*BOB, 4)]).check_strands("a")),
    Advice("hairs: fraction is {}; must be more than 0 and at most 1",
        lambda: ringlet.build_hairs(ringlet.read_groom("groom.usdc"), fraction=2.0),
        lambda: ringlet.build_hairs(ringlet.read_groom("groom.usdc"), fraction=1.0)),
    Advice("check: own_radius is {}; must be from 0 to 1", lambda: ringlet.check_groom("groom.usdc", own_radius=2.0),
        lambda: ringlet.check_groom("groom.usdc", own_radius=1.0)),
    Advice("check: {} is {} m; must be at least 0 and under 1 m", lambda: ringlet.check_groom("groom.usdc",
        thickness=1.0), lambda: ringlet.check_groom("groom.usdc", thickness=0.01)),
    Advice("{} is {}; must be from 1 to {}", lambda: ringlet.write_hairs("groom.usdc", "out.usdc", points=1),
        lambda: ringlet.write_hairs("groom.usdc", "out.usdc", points=2)),
    Advice("holds no deformable curves; must be a .usdc, .usd or .usda file",
        line(f"convert groom.usdc out.hair --deformable {SHOT}"),
        line(f"convert groom.usdc out.usdc --deformable {SHOT}")),
    Advice("deformable curves are written at rest; leave them out",
        line(f"convert groom.usdc out.usdc --deformable {SHOT} --frames 1:2"),
        line(f"convert groom.usdc out.usdc --deformable {SHOT}")),
    Advice("is no archive, which is what Unreal imports; must end in .abc",
        line("convert groom.usdc out.usdc --unreal"), line("convert groom.usdc out.abc --unreal")),
    Advice("has no {}; leave --only out, or ask for its {}", line("convert groom.usdc out.hair --only hairs"),
        line("convert groom.usdc out.hair --only guides")),
]  # fmt: skip


def on(scalp: Mesh, text: str = "") -> Act:
    """Grooms a mesh."""
    return lambda: make_groom(parse_recipe(f"ringlet = 2\n[guides]\ncount = 6\nlength = 5\n{text}"), scalp)


def bent(**changes: Any) -> Mesh:
    return dataclasses.replace(ball(), **changes)


ROUND = ball()
SCALPS = [
    Advice("{}: the mesh is empty; choose another prim", on(bent(triangles=ROUND.triangles[:0], regions={})),
        on(ball())),
    Advice("{}: point {} is not finite; repair the mesh", on(bent(points=ROUND.points * np.nan)), on(ball())),
    Advice("{}: a face names point {}, but there are {}; repair the mesh", on(bent(points=ROUND.points[:-1])),
        on(ball())),
    Advice("{}: the scalp has no faces; choose the faces that carry hair", on(bent(regions={"scalp": np.zeros(0,
        np.int32)}), "[scalp]\nregion = 'scalp'\n"), on(ball(), "[scalp]\nregion = 'scalp'\n")),
    Advice("triangle(s) have no area, the first is {}; clean the mesh",
        on(bent(points=np.where(np.arange(len(ROUND.points))[:, None] < 40, ROUND.points[:1], ROUND.points))),
        on(ball())),
    Advice("an edge is shared by {} triangles; must be at most 2",
        on(bent(triangles=np.concatenate([ROUND.triangles] * 3), regions={})), on(ball())),
    Advice("neighbouring faces have opposite orientations; make their normals agree",
        on(bent(triangles=np.concatenate([ROUND.triangles[:1, ::-1], ROUND.triangles[1:]]))), on(ball())),
    Advice("face the inside of the mesh, where their hair would grow; turn the normals outwards",
        on(bent(triangles=ROUND.triangles[:, ::-1].copy())), on(ball())),
]  # fmt: skip


def asked(
    *steps: protocol.FromPage | Callable[[Session], object],
    file: str = RECIPE,
    before_last: Act = lambda: None,
    groomed: bool = False,
) -> Act:
    """Sends messages to a review, between other steps; the last after an act. groomed: when a groom is shown."""

    def act() -> None:
        session = Session(Path(file).resolve(), Project(Path.cwd()))
        page = session.join("one", leads=True)
        with patch.object(Grooming, "request"), patch.object(Grooming, "request_of"):
            if groomed:
                shown(session)
            for k, step in enumerate(steps):
                if k == len(steps) - 1:
                    before_last()
                step(session) if callable(step) else session.handle(page, step)

    return act


def shown(session: Session) -> None:
    """Makes the groom of a review, and shows it."""
    document = session.files.recipe
    made = GroomEvaluator(session.project).groom(document.model, draft=False, check_abort=lambda: None)
    session._show(made, document.revision)


def in_several() -> None:
    """Writes the recipe as one of several grooms."""
    wrote("all.recipe.toml", Path(RECIPE).read_text().replace('name = "small"', "").replace("\n[", "\n[grooms.a."))()


WIDER = protocol.Set(changes=[(["curl", "width"], 1.7)], gesture=1)
SAVE = protocol.Save()
BY_HAND = changed(RECIPE, ("pitch = 1.5", "pitch = 1.9"))
REVIEW = [
    Advice("save: name is '{}'; give a file name without a folder", asked(protocol.Save(name="sub/b")),
        asked(protocol.Save(name="b"))),
    Advice("save: {} is there already; give another name", asked(protocol.Save(name="small")),
        asked(protocol.Save(name="c"))),
    Advice("has unsaved changes; save them, or discard them", asked(WIDER, protocol.Open(name=SHOT)),
        in_order(asked(SAVE, protocol.Open(name=SHOT)), asked(WIDER, protocol.Open(name=SHOT, discard=True)))),
    Advice("was changed by another program; choose first what is kept", asked(WIDER, SAVE, before_last=BY_HAND),
        asked(protocol.Resolve(choice="mine"), SAVE)),
    Advice("has no conflict with its file; go on", asked(protocol.Resolve(choice="mine")), asked(SAVE)),
    Advice("no {} is open; open one with: ringlet view", asked(protocol.Set(file="shot", changes=[(["preroll"], 1)],
        gesture=1)), asked(protocol.Set(file="shot", changes=[(["preroll"], 1)], gesture=1), file=SHOT)),
    Advice("outside of the project {}; move it there", asked(protocol.Open(name="../b.recipe.toml")),
        asked(protocol.Open(name=SHOT))),
    Advice("{}: shape has {} operators; there is none at {}", in_order(in_several, asked(protocol.Arrange(
        action="remove", at=3), file="all.recipe.toml")), asked(protocol.Arrange(action="add", at=0, op="frizz"),
        protocol.Arrange(action="remove", at=0), file="all.recipe.toml")),
    Advice("preset: {} sets none of these tables; choose others", asked(protocol.Keep(name="mine", tables=["fiber"])),
        asked(protocol.Keep(name="mine", tables=["curl"]))),
    Advice("preset: {} is there already; give another name", asked(protocol.Keep(name="two", tables=["curl"]),
        protocol.Keep(name="two", tables=["curl"])), asked(protocol.Keep(name="three", tables=["curl"]))),
    Advice("is no recipe, shot or USD file; give one of them", in_order(wrote("a.txt", ""), asked(SAVE,
        file="a.txt")), asked(SAVE)),
    Advice("message: has {} bytes; must be at most {}", lambda: unpack(bytes(MOST + 1)),
        lambda: unpack(packed('{"kind": "save"}'))),
    Advice("message: its length is not the one it states; send it again",
        lambda: unpack(packed('{"kind": "save"}')[:-1]), lambda: unpack(packed('{"kind": "save"}'))),
]  # fmt: skip
MORE = [
    Advice("is {}; must be at least {}{}", recipe("[guides]\nlength = -1"), recipe("[guides]\nlength = '0.1 mm'")),
    Advice("is {}; must be at most {}{}", recipe("[guides]\nlength = 1e9"), recipe("[guides]\nlength = '10 m'")),
    Advice("has both 'count' and 'spacing'; give one of them", recipe("[guides]\nspacing = 4"),
        recipe("[guides]\ncount = 'none'\nspacing = 4")),
    Advice("has 'toward', but locks cross a mesh from any side; take it out, or the mesh",
        recipe(recipes.ROUND + "[[shape]]\nop = 'cut'\nmesh = 'round'\ntoward = [0, 1, 0]"),
        recipe(recipes.ROUND + "[[shape]]\nop = 'cut'\nmesh = 'round'")),
    Advice("has '{}', but no file that it is for; take it out{}", recipe(recipes.TAIL + "unit = 'm'"),
        recipe(recipes.TAIL)),
    Advice("but it varies along the line alone; give it a ramp",
        recipe("[scalp.edge]\nregion = 'front'\nwidth = { value = 1, map = 'paint' }"),
        recipe("[scalp.edge]\nregion = 'front'\nwidth = { value = 1, ramp = [[0, 1], [1, 0.5]] }")),
    Advice("has a text with a character of code 0; take it out", in_order(changed(RECIPE, ('"small"',
        '"sm\\u0000all"')), groom), in_order(changed(RECIPE, ("\\u0000", "")), groom)),
    Advice("lists too deep, or a number too long; shorten them", in_order(wrote("b.toml",
        "ringlet = 2\na = " + "[" * 100_000), line("groom b.toml -o out.usdc")), groom),
    Advice("a key of over {} parts; shorten it", in_order(wrote("b.toml", f"ringlet = 2\n{'.'.join('a' * 60)} = 1"),
        line("groom b.toml -o out.usdc")), groom),
    Advice("{}: cannot be written ({}); choose another place", line(f"groom {RECIPE} -o head.usda/out.usdc"), groom),
    Advice("{} is '{}', outside of {}; name a file in that folder, or below it", in_order(changed(RECIPE,
        ("ringlet = 2", 'ringlet = 2\nedits = "../e.toml"')), line(f"edit {RECIPE} --freeze 19000000")),
        in_order(changed(RECIPE, ("../e.toml", "e.toml")), line(f"edit {RECIPE} --freeze 19000000"))),
    Advice("{}: {} is {}; must be the name of a file", in_order(wrote("b.toml", "ringlet = 2\nextends = 3\n"),
        line("groom b.toml -o out.usdc")), in_order(changed("b.toml", ("3", f'"{RECIPE}"')),
        line("groom b.toml -o out.usdc"))),
    Advice("is no operator of what it extends{}", in_order(changed(RECIPE, ("[curl]",
        '[[shape]]\nop = "frizz"\n[curl]')), wrote("b.toml",
        f'ringlet = 2\nextends = "{RECIPE}"\n[shape.friz]\nmagnitude = 0.1\n'), line("groom b.toml -o out.usdc")),
        in_order(changed("b.toml", ("friz", "frizz")), line("groom b.toml -o out.usdc"))),
    Advice("shape.{} is {}; must be tables [[shape.{}]]", in_order(wrote("b.toml",
        f'ringlet = 2\nextends = "{RECIPE}"\nshape.append = 3\n'), line("groom b.toml -o out.usdc")),
        in_order(changed("b.toml", ("shape.append = 3", '[[shape.append]]\nop = "frizz"')),
        line("groom b.toml -o out.usdc"))),
    Advice("shape.{} is {}; must be a table of settings, or false", in_order(changed(RECIPE, ("[curl]",
        '[[shape]]\nop = "frizz"\n[curl]')), wrote("b.toml", f'ringlet = 2\nextends = "{RECIPE}"\nshape.frizz = 3\n'),
        line("groom b.toml -o out.usdc")), in_order(changed("b.toml", ("= 3", "= false")),
        line("groom b.toml -o out.usdc"))),
    Advice("{}: {} is {}; must be tables [{}.NAME]", in_order(wrote("b.toml", "ringlet = 2\ngrooms = 3\n"),
        line("groom b.toml -o out.usdc")), in_order(changed("b.toml", ("grooms = 3",
        f'[grooms.a]\nextends = "{RECIPE}"')), line("groom b.toml -o out.usdc"))),
    Advice("{}: {}.{} is {}; must be a table", in_order(wrote("b.toml", "ringlet = 2\n[grooms]\na = 3\n"),
        line("groom b.toml -o out.usdc")), in_order(changed("b.toml", ("[grooms]\na = 3",
        f'[grooms.a]\nextends = "{RECIPE}"')), line("groom b.toml -o out.usdc"))),
    Advice("has no frames {}; {}: ask for those", line(f"{HAIR} --frames 3:9"), line(f"{HAIR} --frames 3:4")),
    Advice("scalp.file is missing; name the file of the head", in_order(wrote("b.toml",
        "ringlet = 2\n[guides]\ncount = 3\nlength = 5\n"), line("groom b.toml -o out.usdc")), in_order(added("b.toml",
        '[scalp]\nfile = "head.usda"\n'), line("groom b.toml -o out.usdc"))),
    Advice("is a list in the shot; say which of it", in_order(added(SHOT,
        "\n[contact]\n[[collider]]\nmesh = '/ball/skin'\n"), line(f"{PLAN} --set collider.friction=0.1")),
        line(f"{PLAN} --set collider[0].friction=0.1")),
    Advice("in the shot; they count from 0", in_order(added(SHOT, "\n[contact]\n[[collider]]\nmesh = '/ball/skin'\n"),
        line(f"{PLAN} --set collider[1].friction=0.1")), line(f"{PLAN} --set collider[0].friction=0.1")),
    Advice("must end in .json, such as wedge.template.json",
        line(f"wedge {SHOT} --openjd plan.txt --set solver.newton=1"), line(f"{PLAN} --set solver.newton=1")),
    Advice("must end in .json for Open Job Description, .alf for Tractor or",
        line(f"farm {SHOT} --camera /cam -o plan.txt"), line(f"farm {SHOT} --camera /cam -o plan.alf")),
    Advice("{}: is finished hair, not a groom; make a recipe of it first", line(f"farm {SHOT} --camera /cam "
        "--groom head.usda"), line(f"farm {SHOT} --camera /cam --groom {RECIPE}")),
    Advice("was made from other locks ({}, the groom has {}); {}", in_order(added(SHOT,
        '\n[rest]\nmode = "lofted"\n'), line(f"loft {SHOT} --groom groom.usdc"), changed(RECIPE, ("count = 8",
        "count = 9")), line(f"sim {SHOT} -o out.usdc")), in_order(line(f"loft {SHOT}"),
        line(f"sim {SHOT} -o out.usdc"))),
    Advice("is there, but nothing touches; add a table [contact]{}",
        shot("[[cloth]]\nname = 'sheet'\nmesh = '/sheet'\n"), shot(shots.CLOTH)),
    Advice("loft: held is {}, but a lock has {} points; hold fewer", moved("held = 60\n[rest]\nmode = 'lofted'\n"),
        moved("held = 2\n[rest]\nmode = 'lofted'\n")),
    Advice("{} has {} values; must have {}, being {}", curves(with_primvar("a", [1.0, 2.0])), curves(with_primvar("a",
        [1.0] * 8))),
    Advice("its hairs have {} points, but it holds {}; export it again", converted("a.hair", hair(arrays=3)),
        converted("a.hair", hair())),
    Advice("too few for {} × {} numbers at byte {}; export it again", in_order(line("convert groom.usdc a.tfx"),
        lambda: converted("a.tfx", Path("a.tfx").read_bytes()[:-900])()), in_order(line("convert groom.usdc a.tfx"),
        line("convert a.tfx out.usdc --from-unit m"))),
    Advice("{}: cannot be read as USD ({}); write it again or choose another", in_order(wrote("t.usda", "hello"),
        line("hair t.usda -o out.usdc")), line("hair groom.usdc -o out.usdc")),
    Advice("{}: has no hairs; make them with: ringlet hair GROOM -o hair.usdc", lambda: io.read_hairs("groom.usdc"),
        in_order(line("hair groom.usdc -o hair.usdc"), lambda: io.read_hairs("hair.usdc"))),
    Advice("cannot be read as a picture ({}); give an .exr or .hdr file", in_order(wrote("l.exr", "no"),
        line("render hair.usdc -o a.png --light l.exr --width 16 --samples 1")),
        line("render hair.usdc -o a.png --light studio --width 16 --samples 1")),
    Advice("preset: its picture is no JPEG; keep it without one", asked(protocol.Keep(name="four", tables=["curl"],
        picture="data:image/jpeg;base64,AAAA")), asked(protocol.Keep(name="four", tables=["curl"]))),
    Advice("{}: ends in '{}'; must end in .toml", line("adopt hair.usdc -o a.usdc"),
        line("adopt hair.usdc -o a.recipe.toml")),
    Advice("{}: ends in '{}'; must end in {}", line("convert groom.usdc out.txt"),
        line("convert groom.usdc out.hair")),
    Advice("{} '{}' is 0 all over {}; paint where hair is to grow", on(bent(maps={"m": np.zeros((len(ROUND.triangles),
        3))}), "density = 'm'\n"), on(bent(maps={"m": np.ones((len(ROUND.triangles), 3))}), "density = 'm'\n")),
    Advice("has {} values; must have 1, being constant", curves(with_widths([1.0, 2.0], "constant")),
        curves(with_widths([1.0], "constant"))),
]  # fmt: skip
ROWS = [*FILES, *FORMATS, *RECIPES, *SHOTS, *PICTURES, *HEADS, *CURVES, *SCALPS, *REVIEW, *MORE]
