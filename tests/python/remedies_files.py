"""Rows of the tests of advice: the messages of files, grooms, shots and simulations; as in ``remedies``."""

from __future__ import annotations

import contextlib
import dataclasses
import os
import struct
import sys
from collections.abc import Callable
from functools import cache
from pathlib import Path
from types import SimpleNamespace
from typing import Any
from unittest.mock import patch

import numpy as np
import small_example
import test_settings_act as recipes
import test_shot_settings_act as shots
from cloth_scene import garment, sheet, simulated
from floor_scene import CONTACT, floor, still
from floor_scene import SHOT as FLOOR_SHOT
from floor_scene import groom as floor_groom
from PIL import Image
from pxr import Gf, Sdf, Usd, UsdGeom, UsdSkel, Vt
from remedies import (
    EDITS,
    RECIPE,
    ROUND,
    SHOT,
    Act,
    Advice,
    _with,
    added,
    bent,
    changed,
    groom,
    in_order,
    line,
    made,
    on,
    recipe,
    shot,
    wrote,
)
from remedies import (
    simulated as simulated_again,
)
from ringlet.adoption.clumps import find_clumps
from ringlet.api.caches import scalp_clip
from ringlet.api.pictures import lock_points
from ringlet.cli.bench import parameters
from ringlet.data import regular
from ringlet.data.accessory import Accessory
from ringlet.data.cache import CachedCloth
from ringlet.data.curves import offsets_from_counts
from ringlet.data.frames import frames_within
from ringlet.data.groom import HairOffsets
from ringlet.data.mesh import Clip
from ringlet.data.pigment import curve_reflectance
from ringlet.data.reads import recorded
from ringlet.data.settings import check_texts
from ringlet.data.share import share
from ringlet.data.texture import Texture
from ringlet.groom.rebind import rebind
from ringlet.groom.several import join_grooms
from ringlet.io.alembic.library import library
from ringlet.io.texture import read_texture
from ringlet.io.usd.host_meshes import PolygonMesh
from ringlet.picture.tone import develop
from ringlet.shot import Collider, parse_shot
from ringlet.sim import Checkpoints, Obstacle, simulate
from ringlet.sim.direct import open_pardiso
from ringlet.sim.run_inputs import run_inputs
from ringlet.validate import run_case
from shapes import sheet as flat_scalp
from test_io_bad_input import retype
from test_io_mesh import skinned_cube
from test_shot_variation import factors
from test_shot_variation import groom as two_locks
from usd_scenes import add_cube
from wear import write_wear

import ringlet
from ringlet import Curves, Mesh, io
from ringlet.groom import make_groom, parse_recipe

OPEN_PARDISO = open_pardiso
ADOPT = "adopt a.obj -o a.recipe.toml --head head.usda --from-unit m"


def hair_obj(*roots: tuple[float, float, float]) -> Act:
    """Writes hairs of 5 cm that stand on places [m]."""
    lines = [[np.array(root) * (1 + 0.1 * k) for k in range(6)] for root in roots]
    text = "".join(f"v {x} {y} {z}\n" for one in lines for x, y, z in one)
    numbers = [" ".join(str(6 * k + i + 1) for i in range(6)) for k in range(len(lines))]
    return wrote("a.obj", text + "".join(f"l {one}\n" for one in numbers))


PLACES = [
    (0.09 * np.sin(polar) * np.sin(around), 0.09 * np.cos(polar), 0.09 * np.sin(polar) * np.cos(around))
    for polar in np.pi * np.array([1, 2]) / 8
    for around in np.pi * np.arange(4) / 2
]
TUFT = hair_obj(*PLACES)
SMALL = "--width 16 --samples 1"


def straight(count: int) -> np.ndarray:
    return np.linspace(0, 0.1, 12)[None, :, None] * np.ones(3) + 0.01 * np.arange(count)[:, None, None]


ADOPTING = [
    Advice("locks is {}, but there are {} hairs; ask for at most as many",
        lambda: find_clumps(straight(3), np.full(3, 0.1), {}, 4), lambda: find_clumps(straight(3), np.full(3, 0.1), {},
        3)),
    Advice("different roots, which span no surface; give it a head with --head", in_order(hair_obj(*PLACES[:2]),
        line("adopt a.obj -o a.recipe.toml --from-unit m")), line(ADOPT)),
    Advice("its roots lie on a line, {} mm wide, which spans no surface; give it a head", in_order(hair_obj((0,
        0.09, 0),
        (0, 0.1, 0), (0, 0.11, 0), (0, 0.12, 0)), line("adopt a.obj -o a.recipe.toml --from-unit m")), in_order(TUFT,
        line(ADOPT))),
    Advice("half of the roots are more than {} m away from it", in_order(TUFT, line(ADOPT.replace("unit m",
        "unit ft"))), line(ADOPT)),
    Advice("has no curves; export the hair as curves or choose another file",
        line("adopt head.usda -o a.recipe.toml"), in_order(TUFT, line(ADOPT))),
]  # fmt: skip


@cache
def _adopted() -> dict[str, bytes]:
    in_order(TUFT, line(ADOPT))()
    return {path.name: path.read_bytes() for path in Path().glob("a.*")}


def adopted() -> None:
    """Writes the recipe of adopted hairs, and its files."""
    for name, content in _adopted().items():
        Path(name).write_bytes(content)


OFFSETS = "a.hairs.usdc"


def spoilt(name: str, change: Callable[[Usd.Stage], object], then: Callable[[str], object]) -> Act:
    """Changes a copy of a stage, and gives the copy to a function."""

    def act() -> None:
        copy = f"other{Path(name).suffix}"
        Path(copy).write_bytes(Path(name).read_bytes())
        stage = Usd.Stage.Open(copy)
        stage.Reload()
        change(stage)
        stage.Save()
        then(copy)

    return act


def attribute(prim: str, name: str, value: object) -> Callable[[Usd.Stage], object]:
    """Sets an attribute; None takes it out."""

    def change(stage: Usd.Stage) -> None:
        if value is None:
            stage.GetPrimAtPath(prim).RemoveProperty(name)
        else:
            stage.GetPrimAtPath(prim).GetAttribute(name).Set(value)

    return change


def of_offsets(part: str, name: str, value: object) -> Advice:
    change = attribute("/groom/offsets", f"ringlet:offsets:{name}", value)
    return Advice(part, in_order(adopted, spoilt(OFFSETS, change, io.read_offsets)), in_order(adopted,
        lambda: io.read_offsets(OFFSETS)))  # fmt: skip


def adopted_hairs(**changes: object) -> Act:
    """Makes the hairs of an adopted groom, with other values for all of them."""

    def act() -> None:
        adopted()
        made = ringlet.build_groom("a.recipe.toml")
        for name, value in changes.items():
            getattr(made.offsets, name)[:] = value
        ringlet.build_hairs(made)

    return act


def touching() -> None:
    """Writes a file of contacts of the small example."""
    held, made = ringlet.read_cache("cache.usdc"), ringlet.read_groom("groom.usdc")
    ones = np.ones(2, np.float32)
    touches = [ringlet.data.cache.Touches(made.locks.points[:2], ones, ones)] * len(held.frames)
    io.write_touches(dataclasses.replace(held, touches=touches), "cache.usdc", "touches.usdc", made.space)


def camera(turn: float = 0.0, change: Callable[[UsdGeom.Camera], object] = lambda camera: None) -> None:
    """Writes a camera in front of the small head, turned from it by degrees."""
    stage = Usd.Stage.CreateInMemory()
    UsdGeom.SetStageMetersPerUnit(stage, 0.01)
    made = UsdGeom.Camera.Define(stage, "/cam")
    made.AddTranslateOp().Set(Gf.Vec3d(0, 0, 60))
    made.AddRotateYOp().Set(turn)
    change(made)
    stage.GetRootLayer().Export("cam.usda")


def seen(change: Callable[[UsdGeom.Camera], object], prim: str = "/cam") -> Act:
    return in_order(lambda: camera(0.0, change), lambda: io.read_camera("cam.usda", prim))


def looked_at(lock: int, first: int) -> Act:
    """Finds the hairs of a lock among those of the locks from a row on."""

    def act() -> None:
        found = io.read_hairs("hair.usdc")
        lock_points(Path("hair.usdc"), found.take(found.curve["lock"] >= first), lock)

    return act


def on_sheet(stage: str = "hair.usdc", **settings: Any) -> Act:
    """Asks for a sheet of pictures, which is not drawn."""

    def act() -> None:
        with patch("ringlet.picture.sheet"):
            ringlet.write_sheet(stage, "s.png", **settings)

    return act


def cloths(text: str) -> Act:
    return in_order(wrote("c.shot.toml", SMALL_SHOT + "[contact]\n" + text),
        line("sim c.shot.toml --groom groom.usdc -o out.usdc --frames 1:1"))  # fmt: skip


SMALL_SHOT = small_example.SHOT
FAR_HAIR = "--camera /cam --camera-file cam.usda"
HEAD_TEXT = 'ringlet = 2\n[scalp]\nfile = "head.obj"\nunit = "cm"\nhide = ["/a"]\n[guides]\ncount = 3\nlength = 5\n'
OBJ_HEAD = in_order(wrote("head.obj", "v 0 0 0\nv 0 0 9\nv 9 0 0\nf 1 2 3\n"), wrote("head.toml", HEAD_TEXT))
WORN = '[[cloth]]\nfile = "wear.usda"\nmesh = "/wear/scarf"\n'
HIGHER = '[[cloth]]\nfile = "higher.usda"\nmesh = "/wear/scarf"\n'


def wear_higher() -> None:
    write_wear(Path(), lambda mesh: UsdGeom.Xformable(mesh).AddTranslateOp().Set(Gf.Vec3d(0, 0.1, 0)))
    Path("wear.usda").rename("higher.usda")
    write_wear(Path())


LOFTED = "[rest]\nmode = 'lofted'\n"
COMMANDS = [
    Advice("fraction is {}; must be more than 0 and at most 1", lambda: ringlet.convert("groom.usdc", "out.usdc",
        fraction=2.0), lambda: ringlet.convert("groom.usdc", "out.usdc", fraction=1.0)),
    Advice("scalp.hide names prims of a USD file, which {} is not; remove it", in_order(OBJ_HEAD,
        line("groom head.toml -o out.usdc")), in_order(changed("head.toml", ('hide = ["/a"]', "")),
        line("groom head.toml -o out.usdc"))),
    Advice("has no hair in front of it; turn it, or choose another", in_order(lambda: camera(180.0),
        line(f"hair groom.usdc -o out.usdc {FAR_HAIR}")), in_order(lambda: camera(0.0),
        line(f"hair groom.usdc -o out.usdc {FAR_HAIR}"))),
    Advice("its hairs are made already; ask its groom or its cache for other ones", in_order(
        line("hair groom.usdc -o demand.usdc --on-demand"), line("hair demand.usdc -o out.usdc --points 4")),
        line("hair groom.usdc -o out.usdc --points 4")),
    Advice("has no effect on a turntable; leave it out", lambda: ringlet.write_turntable("hair.usdc", "turn",
        look_at=19000000, views=1, width=16, samples=1), lambda: ringlet.write_turntable("hair.usdc", "turn", views=1,
        width=16, samples=1)),
    Advice("picture: contacts have no motion blur; leave out the shutter", in_order(touching,
        lambda: ringlet.write_touches_picture("touches.usdc", "t.png", shutter=180.0, width=16, samples=1)),
        lambda: ringlet.write_touches_picture("touches.usdc", "t.png", width=16, samples=1)),
    Advice("has no frames to draw a sheet of; give hairs made with --cache", on_sheet("groom.usdc"), on_sheet()),
    Advice("has no hairs in it; choose another, or make all hairs", looked_at(19000000, 1), in_order(
        looked_at(41000000, 1), looked_at(19000000, 0))),
    Advice("but rest.file is missing; name what ringlet loft wrote",
        lambda: ringlet.simulate(parse_shot(SMALL_SHOT + LOFTED), "groom.usdc"), in_order(
        wrote("l.shot.toml", SMALL_SHOT + LOFTED), line("loft l.shot.toml --groom groom.usdc"),
        lambda: ringlet.simulate(parse_shot(SMALL_SHOT + LOFTED + f"file = '{Path('l.rest.usdc').resolve()}'\n"),
        "groom.usdc"))),
    Advice("names no file for its scalp; write the head as USD and name it in the recipe",
        lambda: scalp_clip(floor_groom()), lambda: scalp_clip(ringlet.read_groom("groom.usdc"))),
    Advice("the scalp that hair grows on; name another mesh", cloths('[[cloth]]\nmesh = "/ball/skin"\n'), in_order(
        lambda: write_wear(Path()), cloths(WORN))),
    Advice("two cloths are called '{}'; give one of them another `name`", in_order(wear_higher, cloths(WORN + HIGHER)),
        cloths(WORN + HIGHER + "name = 'higher'\n")),
    Advice("{}, which is a cloth already; take one of them away", in_order(lambda: write_wear(Path()), cloths(WORN +
        WORN)), cloths(WORN)),
    Advice("parameters are given as --PARAMETER VALUE, such as", lambda: list(parameters(["strands", "5"])),
        lambda: list(parameters(["--strands", "5"]))),
    Advice("a sheet shows several frames; choose them with --frames",
        line("render hair.usdc --sheet -o s.png --frame 1"),
        on_sheet(frames=(1, 1))),
    Advice("{}: is an input of this command{}; choose another name", line("hair groom.usdc -o head.usda"),
        line("hair groom.usdc -o out.usdc")),
    Advice("is a name of format 1, and {} that of format {}; rename it, or run", in_order(added(RECIPE,
        "\n[clean]\nmargin = '1 mm'\n"), groom), in_order(line(f"upgrade {RECIPE}"), groom)),
    Advice("does not come with this installation of Ringlet; install it again", lambda: share("benches"),
        lambda: share("bench")),
    Advice("validate: there is no case '{}'", lambda: run_case("cantilevr"), lambda: run_case("cantilever")),
    Advice("sim: frames are {}:{}; {}", lambda: ringlet.simulate(SHOT, "groom.usdc", frames=(4, 1)),
        lambda: ringlet.simulate(SHOT, "groom.usdc", frames=(1, 1))),
]  # fmt: skip


def at_root(lock: Curves, **changes: Any) -> Act:
    """Checks curves with other attributes."""
    return lambda: dataclasses.replace(lock, **changes).check("a")


def vanished(back: bool) -> Act:
    def act() -> None:
        with recorded() as reads:
            io.read_space("head.usda")
        content = Path("head.usda").read_bytes()
        Path("head.usda").unlink()
        if back:
            Path("head.usda").write_bytes(content)
        try:
            reads.contents()
        finally:
            Path("head.usda").write_bytes(content)

    return act


def gap(frames: list[float], asked: str = "") -> Act:
    """Makes hairs of a cache with some frames."""

    def act() -> None:
        held = ringlet.read_cache("cache.usdc")
        points = held.points[[int(frame) - 1 for frame in frames]]
        ringlet.write_cache(ringlet.Cache(np.array(frames), points), "groom.usdc", "gap.usdc")
        line(f"hair groom.usdc --cache gap.usdc -o out.usdc {asked}")()

    return act


def cached(factor: float) -> Act:
    """Writes a cache with points that far away."""

    def act() -> None:
        points = ringlet.read_groom("groom.usdc").locks.points[None] * factor
        ringlet.write_cache(ringlet.Cache(np.array([1.0]), points), "groom.usdc", "far.usdc")

    return act


def rooted(change: Callable[[ringlet.Groom], np.ndarray | None]) -> Act:
    """Checks the roots of three locks on points of their scalp, after a change."""

    def act() -> None:
        made = floor_groom()
        changed = change(made)
        made.check_roots(made.scalp.points if changed is None else changed, "frame 1", "sim")

    return act


LINE = Curves.from_list([np.linspace((0, 0, 0), (0, 0.1, 0), 4)])
DATA = [
    Advice("{}: {} is not one number for each {}; write it again", at_root(LINE, point={"pin": np.zeros((4, 2))}),
        at_root(LINE, point={"pin": np.zeros(4)})),
    Advice("{}: {} is {} on {}; must be {}", at_root(LINE, curve={"width": np.array([-1.0])}), at_root(LINE,
        curve={"width": np.array([1e-4])})),
    Advice("of {} points are wrong; must be finite and at most {} m from the head", cached(np.nan), cached(1.0)),
    Advice("curves: {} points; must be under {}", lambda: offsets_from_counts([2**31 - 1, 5]),
        lambda: offsets_from_counts([2**31 - 7, 5])),
    Advice("has no frame from {} to {}; the nearest are {}", lambda: frames_within(np.array([0.4, 1.4]), (1, 1), "a"),
        lambda: frames_within(np.array([0.4, 1.4]), (0.4, 1.4), "a")),
    Advice("has no frame {}, but those before and after", gap([1.0, 2.0, 4.0]), in_order(gap([1.0, 2.0, 4.0],
        "--frames 1:2"), gap([1.0, 2.0, 3.0, 4.0]))),
    of_offsets("its arrays of hairs do not fit one another", "tip", [0.5]),
    of_offsets("holds values that are not finite or out of range", "root_falloff", 2.0),
    of_offsets("{}: has no {}{}; adopt the hair again", "tip", None),
    of_offsets("does not fit its {} hairs; adopt the hair again", "across", [(0.0, 0.0)] * 3),
    Advice("holds no offsets of hairs; make it with: ringlet adopt", lambda: io.read_offsets("groom.usdc"), in_order(
        TUFT, line(ADOPT), lambda: io.read_offsets(OFFSETS))),
    Advice("has no hairs of lock {}, and of {} locks in all; take hairs.file away", adopted_hairs(lock=5), in_order(
        adopted, changed("a.recipe.toml", ('file = "a.hairs.usdc"', "")), line("groom a.recipe.toml -o out.usdc"),
        line("hair out.usdc -o more.usdc"))),
    Advice("hairs.file: has a root on triangle {}, but {} has {}; the head has changed", adopted_hairs(
        root_triangle=10**6), in_order(TUFT, line(ADOPT), adopted_hairs())),
    Advice("the locks are not bound to a scalp; make the groom again from its recipe", spoilt("groom.usdc",
        lambda stage: [stage.GetPrimAtPath(f"/groom/{name}").RemoveProperty("primvars:ringlet:root_triangle")
        for name in ("locks", "guides")], lambda name: line(f"hair {name} -o out.usdc")()), in_order(groom,
        line("hair out.usdc -o new.usdc"))),
    Advice("but the groom was made on one with {}; make the groom again on this mesh",
        rooted(lambda made: made.scalp.points[:3]), rooted(lambda made: None)),
    Advice("is rooted, has no area or is not finite; mend the mesh or its animation",
        rooted(lambda made: 0 * made.scalp.points), rooted(lambda made: None)),
    Advice("picture: --{} has no effect on {}; leave it out", on_sheet(samples=2), on_sheet()),
    Advice("is not one finite number for each curve or point; write it again",
        lambda: curve_reflectance(dataclasses.replace(LINE, curve={"melanin": np.array([np.nan])}), "a"),
        lambda: curve_reflectance(dataclasses.replace(LINE, curve={"melanin": np.array([0.5])}), "a")),
    Advice("{}: cannot be read ({}); put it back", vanished(back=False), vanished(back=True)),
    Advice("{}: has {} bytes; must be at most {}", lambda: regular.read_bytes(Path(RECIPE), most=9),
        lambda: regular.read_bytes(Path(RECIPE), most=999)),
    Advice("has a text with half of a UTF-16 pair; write it in UTF-8", lambda: check_texts({"name": "\ud83d"}, "a"),
        lambda: check_texts({"name": "\ud83d\ude00".encode("utf-16", "surrogatepass").decode("utf-16")}, "a")),
]  # fmt: skip


def region_of(faces: list[int]) -> Act:
    """Gives the region of the small head other faces."""

    def act() -> None:
        stage = Usd.Stage.Open("head.usda")
        UsdGeom.Subset(stage.GetPrimAtPath("/ball/skin/scalp")).GetIndicesAttr().Set(Vt.IntArray(faces))
        stage.Save()

    return act


def on_mesh(mesh: Mesh, text: str, **given: Any) -> Act:
    """Grooms a mesh by a recipe."""
    return lambda: make_groom(parse_recipe(f"ringlet = 2\n{text}"), mesh, **given)


def painted(value: float) -> Mesh:
    """A ball that is painted all over, but at a corner of its first triangle."""
    values = np.full((len(ROUND.triangles), 3), value)
    values[0, 0] = 1e-9 if value == 0.0 else value
    return bent(maps={"m": values}, vectors={"m": np.full((len(ROUND.triangles), 3, 3), value)})


def of_texture(uv: np.ndarray | None) -> Act:
    picture = Texture.from_values(np.ones((2, 2)))
    return on_mesh(bent(textures={"m": picture}, uv=uv), PAINTED)


def uv(value: float) -> np.ndarray:
    return np.full((len(ROUND.triangles), 3, 2), value)


def named_grooms(name: str, *tables: str) -> Act:
    return wrote(name, "ringlet = 2\n" + "".join(f"[grooms.g{k}]\nextends = '{RECIPE}'\n{table}\n" for k, table
        in enumerate(tables)))  # fmt: skip


def bounded(name: str, value: int, act: Act) -> Act:
    """Runs with a smaller bound than that of the code, which takes files of gigabytes to reach."""

    def within() -> None:
        with patch(f"ringlet.{name}", value):
            act()

    return within


def with_edge(text: str, mesh: Mesh = ROUND, more: str = "") -> Act:
    guides = f"[guides]\ncount = 6\nlength = 2\n{more}"
    return on_mesh(mesh, f"[scalp.edge]\nwidth = 1\n{text}\n[curves.line]\npoints = {ON_SKIN}\n{guides}")


def edited(name: str, lock: Callable[[ringlet.Groom], int], **changes: Any) -> Act:
    return lambda: ringlet.edit_lock(name, lock(ringlet.build_groom(name)), **changes)


def first(made: ringlet.Groom) -> int:
    return int(made.locks.ids[0])


def drawn(*lines: np.ndarray) -> dict[str, Any]:
    return {"drawn_guides": Curves.from_list(list(lines))}


def rows_along(*lines: np.ndarray) -> Act:
    text = recipes.ROWS + "[[shape]]\nop = 'cornrow'\nwidth = 2\npitch = 5\nlength = 4\npath = 'line'\n"
    return lambda: make_groom(parse_recipe(_with(recipes.BASE, text)), recipes.scalp(), helpers={"line":
        Curves.from_list(list(lines))})  # fmt: skip


def rebound(height: float, **changes: Any) -> Act:
    """Binds a groom of three locks anew to a mesh that has other triangles, at a height [m]."""

    def act() -> None:
        made = floor_groom()
        made.locks.curve["root_triangle"] = np.full(3, 9, np.int32)
        other = dataclasses.replace(floor(), points=floor().points + [0, height, 0])
        rebind(dataclasses.replace(made, scalp=other, **changes))

    return act


def joined(**changes: Any) -> Act:
    return lambda: join_grooms({"a": floor_groom(), "b": dataclasses.replace(floor_groom(), **changes)})


def knot(points: int, more: str = "") -> Act:
    shape = f"[[shape]]\nop = 'knot'\npitch = 12\n{more}"
    return made(recipes.STRANDS.replace("points = 60", f"points = {points}") + shape)


def braid(points: int, pitch: float) -> Act:
    shape = f"[[shape]]\nop = 'braid'\nwidth = 2\npitch = {pitch}"
    return made(recipes.STRANDS.replace("points = 60", f"points = {points}") + shape)


LOOSE = "[locks]\ncount = 40\n[locks.sections]\n"
PAINTED = "[guides]\ncount = 6\nlength = { value = 5, map = 'm' }\n"
EVERYWHERE = {"all": np.arange(len(ROUND.triangles), dtype=np.int32), **ROUND.regions}
ON_SKIN = [[0.0, 9.0, 0.1], [0.0, 8.0, 4.1], [0.0, 6.4, 6.3]]
ROW = 0.09 * np.stack([np.full(12, 0.12), np.cos(np.linspace(-1, 1, 12)), -np.sin(np.linspace(-1, 1, 12))], axis=1)
STANDING = np.linspace((0, 0, 0), (0, 0.06, 0), 4)
MIRROR = "[guides]\ncount = 6\nlength = 5\n[guides.mirror]\n"
HAIRLINE = "[locks]\ncount = 9\n[locks.hairline]\nwidth = 50\n"
FINE = patch("ringlet.groom.scalp.IDS_PER_TRIANGLE", 50)  # in place of a million


def on_cells(cells: int) -> Act:
    def act() -> None:
        with FINE:
            on_mesh(flat_scalp(cells=cells), "[guides]\ncount = 40\nlength = 5\n")()

    return act


GROOMS = [
    Advice("by its map '{}'; must be at most {}{}, paint it again", on_mesh(painted(1e6), PAINTED),
        on_mesh(painted(1.0), PAINTED)),
    Advice("{} '{}' is {} on lock {}; must be at least 0 and finite, paint it again", on_mesh(painted(-1.0), PAINTED),
        on_mesh(painted(1.0), PAINTED)),
    Advice("{} '{}' is not finite at the root of lock {}; paint it again", on(painted(np.nan), "direction = 'm'"),
        on(painted(1.0), "direction = 'm'")),
    Advice("a picture, but {} has no texture coordinates; unwrap it", of_texture(None), of_texture(uv(0.5))),
    Advice("has texture coordinates that are no numbers at the root of lock {}; unwrap it again",
        of_texture(uv(np.nan)), of_texture(uv(0.5))),
    Advice("hairs: region '{}' of {} has no faces; choose the faces that carry hair", in_order(
        lambda: Path("kept.usda").write_bytes(Path("head.usda").read_bytes()), region_of([]),
        line("hair groom.usdc -o out.usdc")), in_order(lambda: Path("head.usda").write_bytes(
        Path("kept.usda").read_bytes()), line("hair groom.usdc -o out.usdc"))),
    Advice("scalp.edge.region has no border: it is all of a closed surface", with_edge("region = 'all'",
        bent(regions=EVERYWHERE)), in_order(with_edge("region = 'scalp'"), with_edge("lines = ['line']"))),
    Advice("at most {} m is allowed: draw it on the skin", on_mesh(ROUND, "[scalp.edge]\nlines = ['tail']\n" +
        recipes.TAIL + "[guides]\ncount = 6\nlength = 2\n"), with_edge("lines = ['line']")),
    Advice("scalp.edge: nothing is left of its lines on {}; change its mask", with_edge("region = 'scalp'\nmask = 0.2"),
        with_edge("region = 'scalp'\nmask = 0.6")),
    Advice("is 0 nearly all along scalp.edge; paint where hair is to grow", bounded("groom.edge.MOST_CANDIDATES", 1000,
        with_edge("region = 'scalp'", painted(0.0), "density = 'm'")), with_edge("region = 'scalp'", painted(1.0),
        "density = 'm'")),
    Advice("points have shape {}; must be finite, of shape (k, 3)", in_order(EDITS, edited(RECIPE, first,
        points=np.zeros((4, 2)))), edited(RECIPE, first, points=0.1 * STANDING + (0, 0.09, 0))),
    Advice("edit of lock {}: {} is no setting of an operator{}", in_order(EDITS,
        line(f"edit {RECIPE} --set 19000000:hair.width=1mm")), line(f"edit {RECIPE} --set 19000000:hairs.width=1mm")),
    Advice("not a finite number on lock {}; rewrite it", made(
        "[[shape]]\nop = 'frizz'\nmask = { where = '1 / (id - id)' }"), made(
        "[[shape]]\nop = 'frizz'\nmask = { where = '1 / (id - id + 1)' }")),
    Advice("{}: {} has {} entries; must have at most {}", in_order(named_grooms("all.toml", *[""] * 65),
        line("groom all.toml -o out.usdc")), in_order(named_grooms("all.toml", "", ""),
        line("groom all.toml -o out.usdc"))),
    Advice("cannot be that of one groom; move it out of the grooms", in_order(named_grooms("all.toml", "unit = 'cm'"),
        line("groom all.toml -o out.usdc")), in_order(changed("all.toml", ("unit = 'cm'", ""), ("ringlet = 2",
        "ringlet = 2\nunit = 'cm'")), line("groom all.toml -o out.usdc"))),
    Advice("turns of {} and its strands; leave it out, or set it to {} (at least {}), or lower its windings",
        knot(20), in_order(knot(150), knot(30, "windings = 1"))),
    Advice("turns of {}; leave it out, or set it to {} (at least {}), or raise its pitch", braid(60, 1),
        in_order(braid(300, 1), braid(60, 5))),
    Advice("locks.hairline leaves no hair: raise its density, or make it narrower", made(HAIRLINE + "density = 0"),
        in_order(made(HAIRLINE + "density = 1"), made(HAIRLINE.replace("50", "1")))),
    Advice("locks.sections leaves no hair: its gap is as wide as its size", made(LOOSE + "size = 6\ngap = 7\n"),
        in_order(made(LOOSE + "size = 6\n"), made(LOOSE + "size = 12\ngap = 7\n"))),
    Advice("there is no guide on the side that is kept; turn 'across' round", on_mesh(dataclasses.replace(flat_scalp(),
        points=flat_scalp().points * (1, 1, 1)), "[guides]\nfile = 'g.obj'\nmirror = {}\n", **drawn(STANDING - (0.05,
        0, 0))), on_mesh(flat_scalp(), "[guides]\nfile = 'g.obj'\nmirror = { across = [-1, 0, 0] }\n",
        **drawn(STANDING - (0.05, 0, 0)))),
    Advice("nearer to 0", on_mesh(ROUND, MIRROR + "offset = 20"), on_mesh(ROUND, MIRROR + "offset = 0")),
    Advice("is another mesh than that of the adopted hair; adopt it again", rebound(0.0, offsets=HairOffsets), in_order(
        TUFT, line(ADOPT), line("groom a.recipe.toml -o out.usdc"), lambda: ringlet.rebind_groom("out.usdc"))),
    Advice("which is another mesh; at most {} m is allowed: make the groom again from its recipe", rebound(0.05),
        rebound(0.005)),
    Advice("runs in section {}, as another one does; draw a part line between them, or remove one", rows_along(ROW,
        ROW + 0.001), rows_along(ROW)),
    Advice("curves do not fit on its triangles; subdivide the mesh", on_cells(1), on_cells(8)),
    Advice("samples on {}, {} m apart; must be at most {}: make it larger", made(
        "[locks]\ncount = 'none'\nspacing = '0.1 mm'"), made("[locks]\ncount = 'none'\nspacing = 4")),
    Advice("roots are not on the scalp ({}); that of curve {}", on_mesh(flat_scalp(), "[guides]\nfile = 'g.obj'\n",
        **drawn(STANDING + (0, 0.02, 0))), in_order(on_mesh(flat_scalp(), "[guides]\nfile = 'g.obj'\n",
        **drawn(STANDING)), on_mesh(flat_scalp(), "[guides]\nfile = 'g.obj'\ntolerance = 3\n", **drawn(STANDING + (0,
        0.02, 0))))),
    Advice("{} is 0 all over {}; paint where hair is to grow", on(bent(maps={"m": np.zeros((
        len(ROUND.triangles), 3))}), "[locks]\ndensity = 'm'\n[locks.sections]\nsize = 6\nstrands = 2\n"),
        on(painted(1.0), "[locks]\ndensity = 'm'\n[locks.sections]\nsize = 6\nstrands = 2\n")),
    Advice("{}: lock {} belongs to no groom; there are: {}", in_order(named_grooms("all.toml",
        "edits = 'a.edits.toml'"), line(f"edit all.toml --freeze {10**15 + 5 * 10**12}")), edited("all.toml", first)),
    Advice("grooms.{}: grows on another scalp ({}) than {} ({}); must be the same", joined(scalp=flat_scalp()),
        joined()),
    Advice("adopted hairs cannot be combined with other grooms; keep them in a recipe of their own", in_order(adopted,
        wrote("all.toml", "ringlet = 2\n[grooms.hair]\nextends = 'a.recipe.toml'\n"),
        line("groom all.toml -o out.usdc")), line("groom a.recipe.toml -o out.usdc")),
    Advice("has '{}', but {} {}; take it out", recipe("[curves.tail]\nfile = 'a.usda'\nunit = 'm'"), recipe(
        "[curves.tail]\nfile = 'a.usda'")),
    Advice("but no curves were read from it; pass drawn_guides", on_mesh(flat_scalp(), "[guides]\nfile = 'g.obj'\n"),
        on_mesh(flat_scalp(), "[guides]\nfile = 'g.obj'\n", **drawn(STANDING))),
]  # fmt: skip


def cube(
    change: Callable[[UsdGeom.Mesh], object] = lambda mesh: None, then: Callable[[str], object] = io.read_mesh
) -> Act:
    """Writes a cube after a change, and reads it."""

    def act() -> None:
        stage = Usd.Stage.CreateInMemory()
        UsdGeom.SetStageMetersPerUnit(stage, 1.0)
        stage.SetTimeCodesPerSecond(24)
        stage.SetDefaultPrim(UsdGeom.Xform.Define(stage, "/head").GetPrim())
        change(add_cube(stage))
        stage.GetRootLayer().Export("cube.usda")
        then("cube.usda")

    return act


def at_times(*samples: tuple[float, int]) -> Callable[[UsdGeom.Mesh], object]:
    """Gives a mesh numbers of points at times."""
    return lambda mesh: [mesh.GetPointsAttr().Set([Gf.Vec3f(k, k * k, -k) for k in range(count)], time)
        for time, count in samples]  # fmt: skip


def typed(name: str, kind: Sdf.ValueTypeName, value: object) -> Callable[[UsdGeom.Mesh], object]:
    """Gives an attribute another type, as a file that was written by hand has it."""
    return lambda mesh: retype(mesh, name, kind, value)


def with_floats(values: list[float], indices: list[int] | None = None) -> Callable[[UsdGeom.Mesh], object]:
    def change(mesh: UsdGeom.Mesh) -> None:
        primvar = UsdGeom.PrimvarsAPI(mesh).CreatePrimvar("m", Sdf.ValueTypeNames.FloatArray, "vertex")
        primvar.Set(values)
        if indices:
            primvar.SetIndices(indices)

    return change


def beads(count: int) -> Callable[[UsdGeom.Mesh], object]:
    """Adds an instancer of the cube."""

    def change(mesh: UsdGeom.Mesh) -> None:
        made = UsdGeom.PointInstancer.Define(mesh.GetPrim().GetStage(), "/head/beads")
        made.CreatePrototypesRel().SetTargets([mesh.GetPath()])
        made.CreateProtoIndicesAttr([0] * count)
        made.CreatePositionsAttr([Gf.Vec3f(k, 0, 0) for k in range(count)])

    return change


def clip(*frames: float) -> Callable[[str], object]:
    return lambda name: io.read_clip(name, frames=frames or None)


def skinned(change: Callable[[UsdSkel.BindingAPI, UsdSkel.Skeleton], object]) -> Act:
    """Reads a cube that is bound to a skeleton, after a change."""

    def act() -> None:
        Path("skin").mkdir(exist_ok=True)
        path = skinned_cube(Path("skin") / f"{len(list(Path('skin').iterdir()))}.usda", {0: 0.0, 10: 1.0})
        stage = Usd.Stage.Open(str(path))
        change(
            UsdSkel.BindingAPI(stage.GetPrimAtPath("/head/skin")), UsdSkel.Skeleton(stage.GetPrimAtPath("/head/bones"))
        )
        stage.Save()
        io.read_clip(path, frames=(0, 10))

    return act


def archive(fill: Callable[[Any, Any, int], object]) -> Act:
    """Writes an Alembic archive at 24 frames a second, and reads all of it."""

    def act() -> None:
        lib = library(Path("a.abc"))
        made = lib.abc.CreateArchiveWithInfo("a.abc", 24.0, "test", "")
        fill(lib, made.getTop(), made.addTimeSampling(lib.core.TimeSampling(1 / 24, 1 / 24)))
        del made
        opened("a.abc")

    return act


def opened(name: str) -> None:
    """Reads all frames of a file of hair."""
    with io.open_scene(name) as scene:
        for one in scene.sets:
            for frame in scene.frames:
                one.points(float(frame))


def strand(
    *samples: int, counts: int = 0, widths: int = 0, name: str = "hair", cycle: float = 1.0
) -> Callable[[Any, Any, int], object]:
    """A curve with numbers of points in its samples; ``counts`` of them are said to be there."""

    def fill(lib: Any, top: Any, times: int) -> None:
        own = top.getArchive().addTimeSampling(lib.core.TimeSampling(cycle / 24, 1 / 24))
        schema = lib.geom.OCurves(top, name, own).getSchema()
        for count in samples:
            sample = lib.geom.OCurvesSchemaSample()
            sample.setPositions(
                lib.imath.V3fArrayFromBuffer(np.linspace((0, 0, 0), (0, 1, 0), count, dtype=np.float32))
            )
            sample.setType(lib.geom.CurveType.kLinear)
            sample.setBasis(lib.geom.BasisType.kNoBasis)
            sample.setCurvesNumVertices(lib.imath.IntArrayFromBuffer(np.array([counts or count], np.int32)))
            if widths:
                value = lib.imath.FloatArrayFromBuffer(np.full(widths, 0.1, np.float32))
                sample.setWidths(lib.geom.OFloatGeomParamSample(value, lib.geom.GeometryScope.kVertexScope))
            schema.set(sample)

    return fill


def triangle(*samples: int, face: int = 0) -> Callable[[Any, Any, int], object]:
    """A triangle with numbers of points in its samples, and a set of one face."""

    def fill(lib: Any, top: Any, times: int) -> None:
        schema = lib.geom.OPolyMesh(top, "skin", times).getSchema()
        for count in samples:
            sample = lib.geom.OPolyMeshSchemaSample()
            sample.setPositions(
                lib.imath.V3fArrayFromBuffer(np.array([(k, k * k, 0) for k in range(count)], np.float32))
            )
            sample.setFaceIndices(lib.imath.IntArrayFromBuffer(np.array([0, 1, 2], np.int32)))
            sample.setFaceCounts(lib.imath.IntArrayFromBuffer(np.array([3], np.int32)))
            schema.set(sample)
        faces = lib.geom.OFaceSetSchemaSample()
        faces.setFaces(lib.imath.IntArrayFromBuffer(np.array([face], np.int32)))
        schema.createFaceSet("chin").getSchema().set(faces)

    return fill


def both(*fills: Callable[[Any, Any, int], object]) -> Callable[[Any, Any, int], object]:
    return lambda lib, top, times: [fill(lib, top, times) for fill in fills]


def without_alembic(act: Act) -> Act:
    def within() -> None:
        with patch.dict(sys.modules, {"alembic3d": None}):
            act()

    return within


def pixels(content: bytes | None = None) -> Act:
    """Reads a picture of 8 × 8 pixels, or a file of other content."""

    def act() -> None:
        Image.fromarray(np.arange(192, dtype=np.uint8).reshape(8, 8, 3)).save("p.png")
        if content is not None:
            Path("p.png").write_bytes(content or Path("p.png").read_bytes()[:45])
        read_texture("p.png")

    return act


def more_points(stage: Usd.Stage) -> None:
    """Gives the head of a cache a point more at frame 2."""
    points = UsdGeom.PointBased(stage.GetPrimAtPath("/groom/body/skin")).GetPointsAttr()
    rest = list(points.Get())
    points.Set(rest, 1)
    points.Set([*rest, rest[0]], 2)


def surfaces(name: str) -> None:
    with io.open_cache(name) as held:
        held.surfaces(2.0)


def sheet_cache(file: str | None = "wear.usda") -> None:
    """Writes a cache with a sheet over the small head."""
    write_wear(Path())
    locks = ringlet.read_groom("groom.usdc").locks.points
    at = np.full((1, 81, 3), 0.1, np.float32) + np.linspace(0, 0.01, 81)[:, None].astype(np.float32)
    cloth = CachedCloth("scarf", file and Path(file), "/wear/scarf", at)
    ringlet.write_cache(ringlet.Cache(np.array([1.0]), locks[None], cloths=[cloth]), "groom.usdc", "sheet.usdc")


def written(variant: str = "b", **changes: Any) -> Act:
    """Writes the small groom with a variant, which has changes."""

    def act() -> None:
        made = ringlet.read_groom("groom.usdc")
        ringlet.write_groom(made, "out.usdc", variants={variant: dataclasses.replace(made, **changes)})

    return act


def with_locks(**changes: Callable[[Curves], dict[str, np.ndarray]]) -> Act:
    """Writes the small groom with other attributes of its locks."""

    def act() -> None:
        made = ringlet.read_groom("groom.usdc")
        locks = dataclasses.replace(made.locks, **{name: change(made.locks) for name, change in changes.items()})
        ringlet.write_groom(dataclasses.replace(made, locks=locks), "out.usdc")

    return act


def of_groom(
    part: str, change: Callable[[Usd.Stage], object], name: str = "groom.usdc", before: Act = lambda: None
) -> Advice:
    """Reads a groom after a change of its file; it is made again."""
    return Advice(part, in_order(before, spoilt(name, change, ringlet.read_groom)), in_order(before,
        lambda: ringlet.read_groom(name)))  # fmt: skip


def worn() -> None:
    made = ringlet.read_groom("groom.usdc")
    bead = dataclasses.replace(floor(), name="bead", points=0.01 * floor().points + made.locks.points[4])
    ringlet.write_groom(dataclasses.replace(made, accessories=[Accessory(bead, np.arange(4))]), "worn.usdc")


def several() -> None:
    in_order(named_grooms("all.toml", "", ""), line("groom all.toml -o several.usdc"))()


def polygons(**changes: Any) -> Act:
    given: dict[str, Any] = {"points": np.eye(3), "counts": np.array([3]), "indices": np.arange(3)}
    return lambda: PolygonMesh("a", **{**given, **changes}).check()


def strands_of(count: int | None) -> Act:
    """Writes a cache with so many points."""

    def act() -> None:
        made = ringlet.read_groom("groom.usdc")
        points = made.locks.points[None, :count]
        ringlet.write_cache(ringlet.Cache(np.array([1.0]), points), "groom.usdc", "out.usdc")

    return act


def lost(back: bool) -> Act:
    """Reads a groom that another stage holds, and whose head is gone."""

    def act() -> None:
        stage, content = Usd.Stage.Open("groom.usdc"), Path("head.usda").read_bytes()
        Path("head.usda").unlink()
        try:
            if back:
                Path("head.usda").write_bytes(content)
            ringlet.read_groom("groom.usdc")
        finally:
            Path("head.usda").write_bytes(content)
            del stage

    return act


def cubes_hair(count: int) -> Act:
    """Reads two curves of four points, of which so many are there at frame 2."""
    places = [(x, y, 0) for x in range(2) for y in range(4)]

    def change(mesh: UsdGeom.Mesh) -> None:
        made = UsdGeom.BasisCurves.Define(mesh.GetPrim().GetStage(), "/head/hair")
        made.CreateTypeAttr("linear")
        made.CreateCurveVertexCountsAttr([4, 4])
        made.CreatePointsAttr(places)
        for frame, points in ((1, places), (2, places[:count])):
            made.GetPointsAttr().Set(points, frame)
            made.GetCurveVertexCountsAttr().Set([4] * (len(points) // 4), frame)

    return cube(change, opened)


def direct(open_pardiso: Callable[[], object] = open_pardiso) -> None:
    """Asks for PARDISO where it is installed, else for any method."""
    from ringlet import DirectSolver

    installed = open_pardiso() or open_pardiso is not OPEN_PARDISO
    with patch("ringlet.sim.direct.open_pardiso", open_pardiso):
        DirectSolver(np.zeros(1, np.int32), np.zeros(1, np.int32), 1, method="pardiso" if installed else "automatic")


ORTHOGRAPHIC, PERSPECTIVE = (lambda camera, kind=kind: camera.CreateProjectionAttr(kind) for kind in (
    "orthographic", "perspective"))  # fmt: skip
FLOATS, INTEGERS = Sdf.ValueTypeNames.FloatArray, Sdf.ValueTypeNames.IntArray
DEMAND = "hair groom.usdc -o demand.usdc --on-demand"
TOO_FEW = lambda prim: UsdGeom.PrimvarsAPI(prim).CreatePrimvar("ringlet:m", FLOATS, "vertex").Set([1.0, 2.0])  # noqa: E731
LOCKS_PRIM = "/groom/locks"


def damaged_crate() -> None:
    content = bytearray(Path("groom.usdc").read_bytes())
    content[16:24] = struct.pack("<q", len(content))
    Path("d.usdc").write_bytes(content)


def with_ocio(module: Any, act: Act) -> Act:
    def within() -> None:
        with patch.dict(sys.modules, {"PyOpenColorIO": module}), patch.dict(os.environ, {"OCIO": "show.ocio"}):
            act()

    return within


def ocio_of(config: Callable[[], Any]) -> Any:
    """A stand-in for OpenColorIO with a configuration."""
    return SimpleNamespace(Exception=RuntimeError, Config=SimpleNamespace(CreateFromEnv=config))


def unreadable() -> Any:
    raise RuntimeError("no such file")


def shown() -> None:
    develop(np.ones((1, 1, 3)))


FILES = [
    Advice("has no layers of lights; leave light_layers out, or write an .exr",
        lambda: ringlet.PictureSettings(light_layers=True).refuse_lights("a.png"),
        lambda: ringlet.PictureSettings().refuse_lights("a.png")),
    Advice("but OpenColorIO is not installed; try: pip install", with_ocio(None, shown), shown),
    Advice("cannot be read ({}); name another, or unset the variable", with_ocio(ocio_of(unreadable), shown), shown),
    Advice("has no linear colour space of Rec. 709", with_ocio(ocio_of(lambda: SimpleNamespace(
        getColorSpace=lambda name: None, getDefaultDisplay=str)), shown), shown),
    Advice("Alembic needs alembic3d, which is not installed", without_alembic(line("convert groom.usdc a.abc")),
        line("convert groom.usdc a.abc")),
    Advice("cannot be read as Alembic ({}); export it again", in_order(line("convert groom.usdc a.abc"),
        lambda: Path("a.abc").write_bytes(Path("a.abc").read_bytes()[:400]), lambda: opened("a.abc")), in_order(
        line("convert groom.usdc a.abc"), lambda: opened("a.abc"))),
    Advice("{}: has {} frames; must be at most {}", bounded("data.limits.FRAMES", 2, archive(strand(2, 2, 2))),
        bounded("data.limits.FRAMES", 2, archive(strand(2, 2)))),
    Advice("the number of points changes at frame {}; export it with one topology", archive(both(strand(2, 3,
        cycle=2.0), strand(2, 2, 2, name="other"))), archive(both(strand(2, 2, cycle=2.0), strand(2, 2, 2,
        name="other")))),
    Advice("curves do not fit its {} points; export it again", archive(strand(4, counts=3)), archive(strand(4))),
    Advice("{}: its number of points changes over time; export it with one topology", archive(triangle(3, 4)),
        archive(triangle(3, 3))),
    Advice("{}: {}; name one of: {}", in_order(line("convert hair.usdc b.abc"), lambda: io.read_curves("b.abc")),
        lambda: io.read_curves("b.abc", "hairs")),
    Advice("has {} points at frame {}, {} at first; export it with one topology", archive(strand(2, 3)),
        archive(strand(2, 2))),
    Advice("{}/{}: names a face that is not among {}; export it again", archive(triangle(3, face=7)), archive(triangle(
        3))),
    Advice("has {} widths for {} curves and {} points; export it again", archive(strand(4, widths=3)), archive(strand(
        4, widths=4))),
    Advice("there are no curves to write, and {} holds nothing else; choose", line("convert head.usda out.hair"),
        in_order(line("convert head.usda out.usdc"), line("convert head.usda out.abc"))),
    Advice("has neither curves nor surfaces; export it again or choose another", cube(lambda mesh: mesh.GetPrim(
        ).SetActive(False), opened), cube(then=opened)),
    Advice("a hair has {} points; must have at most {}: resample them", bounded("io.hair.MOST_SEGMENTS", 9,
        line("convert groom.usdc out.hair")), bounded("io.hair.MOST_SEGMENTS", 9,
        line("convert groom.usdc out.hair --points 10"))),
    Advice("{}: line {} uses point {}", in_order(wrote("l.obj", "v 0 0 0\nv 0 1 0\nl 0 1\n"),
        lambda: io.read_curves("l.obj")), in_order(wrote("l.obj", "v 0 0 0\nv 0 1 0\nl 1 -1\n"),
        lambda: io.read_curves("l.obj"))),
    Advice("meshes of Alembic are read by ringlet convert alone; run", in_order(line("convert head.usda h.abc"),
        changed(RECIPE, ("head.usda", "h.abc"), ('region = "scalp"', "")), groom), in_order(
        line("convert h.abc h.usdc"), changed(RECIPE, ("h.abc", "h.usdc")), groom)),
    Advice("has no prims such as {}; leave it out (false in a variant)", in_order(OBJ_HEAD, changed("head.toml", (
        'hide = ["/a"]', 'mesh = "/a"')), line("groom head.toml -o out.usdc")), in_order(changed("head.toml", (
        'mesh = "/a"', "")), line("groom head.toml -o out.usdc"))),
    Advice("is not a picture that can be read; save it as PNG or TIFF", pixels(b"no picture"), pixels()),
    Advice("{}: cannot be read as a picture ({}); save it again", pixels(b""), pixels()),
    Advice("pixels; must be at most {}, which are 16 384", bounded("io.texture.MOST_PIXELS", 63, pixels()),
        bounded("io.texture.MOST_PIXELS", 64, pixels())),
    Advice("the mesh has changed since the simulation: simulate again", spoilt("cache.usdc", more_points, surfaces),
        in_order(simulated_again, lambda: surfaces("cache.usdc"))),
    Advice("is orthographic; choose a perspective camera", seen(ORTHOGRAPHIC), seen(PERSPECTIVE)),
    Advice("all must be finite, and those of the lens above 0", seen(lambda camera: camera.CreateFocalLengthAttr(0.0)),
        seen(lambda camera: camera.CreateFocalLengthAttr(50.0))),
    Advice("is scaled to nothing; give its transform a scale of 1", seen(lambda camera: camera.AddScaleOp().Set(
        Gf.Vec3f(0))), seen(lambda camera: camera.AddScaleOp().Set(Gf.Vec3f(1)))),
    Advice("is a {}, not a camera; there are: {}", lambda: io.read_camera("head.usda", "/ball/skin"), seen(
        PERSPECTIVE)),
    Advice("there is no whole frame from {} to {}; give a longer range", cube(at_times((1.2, 8), (1.8, 8)), clip()),
        cube(at_times((1.2, 8), (2.8, 8)), clip())),
    Advice("moves from {} to {}; must be fewer than {} frames", cube(at_times((0, 8), (1e6, 8)), clip()), cube(
        at_times((0, 8), (2, 8)), clip())),
    Advice("more than {} places; shorten the shot, or leave it out", bounded("io.usd.clips.MAX_POSITIONS", 20, cube(
        at_times((1, 8), (3, 8)), clip(1, 3))), bounded("io.usd.clips.MAX_POSITIONS", 20, cube(at_times((1, 8), (3, 8)),
        clip(2, 2)))),
    Advice("has {} points at frame {}, {} before; must not change", cube(at_times((1, 8), (2, 9)), clip()), cube(
        at_times((1, 8), (2, 8)), clip())),
    Advice("its {} differ from those in its rest pose; must not change over time", cube(lambda mesh: [at_times((1, 8), (
        2, 8))(mesh), mesh.GetFaceVertexCountsAttr().Set([4] * 6, 1), mesh.GetFaceVertexCountsAttr().Set([3, 5, 4, 4, 4,
        4], 2)], clip(1, 2)), cube(at_times((1, 8), (2, 8)), clip(1, 2))),
    Advice("its cloth {} is not there; put {} back, or simulate again", in_order(sheet_cache, spoilt("sheet.usdc",
        lambda stage: stage.RemovePrim("/groom/cloths"), ringlet.read_cache)), in_order(sheet_cache,
        lambda: ringlet.read_cache("sheet.usdc"))),
    Advice("comes from no file; write its mesh as USD and read it from there", lambda: sheet_cache(None), sheet_cache),
    Advice("{}: widths are from {} to {} m; must be from 0 to {} m", with_locks(point=lambda locks: {**locks.point,
        "width": np.full(len(locks.points), 1e30)}), with_locks(point=lambda locks: {**locks.point, "width": np.full(
        len(locks.points), 1e-4)})),
    Advice("being {}: one for each curve or point; write it again", spoilt("groom.usdc", lambda stage: TOO_FEW(
        stage.GetPrimAtPath(LOCKS_PRIM)), ringlet.read_groom), lambda: ringlet.read_groom("groom.usdc")),
    of_groom("has {} widths for {} points; write the file again", lambda stage: [UsdGeom.Curves(stage.GetPrimAtPath(
        LOCKS_PRIM)).SetWidthsInterpolation("vertex"), UsdGeom.Curves(stage.GetPrimAtPath(LOCKS_PRIM)).GetWidthsAttr(
        ).Set([1.0])]),
    Advice("{}: {} has {} values; must have {}, being {}", with_locks(point=lambda locks: {**locks.point,
        "ramp": np.ones(3)}), with_locks(point=lambda locks: {**locks.point, "ramp": np.ones(len(locks.points))})),
    Advice("cannot be read as USD (damaged: {}); write it again or choose another", in_order(damaged_crate,
        lambda: ringlet.read_groom("d.usdc")), lambda: ringlet.read_groom("groom.usdc")),
    Advice("is no name for USD; use letters, digits, _ and - only", written("a b"), written("a-b")),
    Advice("variant '{}': grows on another scalp ({}); must be {}", written(scalp_prim="/ball/other"), written()),
    of_groom("ringlet:grooms is damaged; make the groom again", attribute("/groom", "ringlet:grooms", "[]"),
        "several.usdc", several),
    of_groom("does not give the groom of each curve; make the groom again", attribute(LOCKS_PRIM,
        "primvars:ringlet:groom", None), "several.usdc", several),
    of_groom("does not name its scalp (ringlet:scalp); make the groom again", lambda stage: stage.GetPrimAtPath(
        "/groom").GetRelationship("ringlet:scalp").ClearTargets(True)),
    of_groom("ringlet:vertices must name points of {}, which has {}", lambda stage: [prim.GetAttribute(
        "ringlet:vertices").Set([10**6]) for prim in stage.GetPrimAtPath("/groom/accessories").GetChildren()],
        "worn.usdc", worn),
    of_groom("{}: has no {}; make the groom again", lambda stage: stage.RemovePrim("/groom/guides")),
    Advice("mesh '{}': {} has the shape {}; must be {}", polygons(indices=np.arange(4)), polygons()),
    Advice("has a value that is not finite; mend the mesh", polygons(points=np.eye(3) * np.nan), polygons()),
    Advice("has no faces of three corners; give it some", polygons(counts=np.array([1, 2])), polygons()),
    Advice("a corner is outside of its {} points; send it again", polygons(indices=np.array([0, 1, 3])), polygons()),
    Advice("there is no Mesh at or below {}; name one, or a prim above one", cube(lambda mesh: UsdGeom.Xform.Define(
        mesh.GetPrim().GetStage(), "/head/hat"), lambda name: io.read_bodies(name, "/head/hat")), in_order(
        cube(then=lambda name: io.read_bodies(name, "/head/skin")), cube(then=lambda name: io.read_bodies(name,
        "/head")))),
    Advice("has no instances of meshes; make it invisible, or leave it out", cube(beads(0),
        lambda name: io.read_bodies(name, "/head/beads")), in_order(cube(beads(2), lambda name: io.read_bodies(name,
        "/head/beads")), cube(then=io.read_bodies))),
    Advice("values, too few for being {}; paint it again", cube(with_floats([1.0] * 3)), cube(with_floats([1.0] * 8))),
    Advice("has no hairs on demand; make them with: ringlet hair GROOM --on-demand", lambda: io.read_on_demand(
        "groom.usdc"), in_order(line(DEMAND), lambda: io.read_on_demand("demand.usdc"))),
    Advice("the groom under it has other locks than when it was made; make the hairs again", in_order(line(DEMAND),
        changed(RECIPE, ("count = 8", "count = 9")), line(f"groom {RECIPE} -o groom.usdc"), lambda: io.read_on_demand(
        "demand.usdc")), in_order(line(DEMAND), lambda: io.read_on_demand("demand.usdc"))),
    Advice("its hairs are damaged; make them again: ringlet hair GROOM --on-demand", in_order(line(DEMAND), spoilt(
        "demand.usdc", attribute("/groom/hairs", "primvars:ringlet:layout:tip", [0.5]), io.read_on_demand)), in_order(
        line(DEMAND), lambda: io.read_on_demand("demand.usdc"))),
    Advice("has {} points for curves of {}; not written", strands_of(-1), strands_of(None)),
    Advice("has {} points, {} in its rest pose; must not change", cube(lambda mesh: [mesh.CreateSubdivisionSchemeAttr(
        "catmullClark"), at_times((1, 8), (2, 9))(mesh)], clip(1, 2)), cube(lambda mesh: [
        mesh.CreateSubdivisionSchemeAttr("catmullClark"), at_times((1, 8), (2, 8))(mesh)], clip(1, 2))),
    Advice("its instances have {} points, more than {}; leave it out", bounded("io.usd.pose.MAX_INSTANCED", 20,
        cube(beads(3), io.read_bodies)), bounded("io.usd.pose.MAX_INSTANCED", 20, cube(then=io.read_bodies))),
    Advice("at rest; export it with one topology", cubes_hair(4), cubes_hair(8)),
    Advice("has no bind pose, which needs a transform for each joint; export it again", skinned(lambda skin, bones:
        bones.GetBindTransformsAttr().Set([Gf.Matrix4d(1)])), skinned(lambda skin, bones: None)),
    Advice("its joints and weights do not fit its points or its skeleton; bind it again", skinned(lambda skin, bones:
        skin.GetJointIndicesPrimvar().Set([9] * 8)), skinned(lambda skin, bones: None)),
    Advice("its joints and weights do not fit each other; bind it again", skinned(lambda skin, bones:
        skin.GetJointWeightsPrimvar().SetElementSize(2)), skinned(lambda skin, bones: None)),
    Advice("{}: uses {}, which is not there; put it back", lost(back=False), lost(back=True)),
    Advice("holds no contacts; make them with: ringlet sim", lambda: io.read_touches("cache.usdc"), in_order(
        added(SHOT, "\n[contact]\n"), line(f"sim {SHOT} --groom groom.usdc -o out.usdc --contacts c.usdc"),
        lambda: io.read_touches("c.usdc"))),
    Advice("has no contacts at frame {}; it holds {} to {}", in_order(touching, lambda: io.read_touches("touches.usdc",
        9.0)), lambda: io.read_touches("touches.usdc", 1.0)),
    Advice("has indices that are not among its values; write it again", cube(with_floats([1.0], [5] * 8)), cube(
        with_floats([1.0], [0] * 8))),
    Advice("{} are no rows of three numbers; export it again", cube(typed("points", FLOATS, [1.0] * 8)), cube()),
    Advice("{}: {} is no list of whole numbers; export it again", cube(typed("faceVertexCounts", FLOATS, [4.0] * 6)),
        cube(typed("faceVertexCounts", INTEGERS, [4] * 6))),
]  # fmt: skip


def vary(text: str, **painted: np.ndarray) -> Act:
    """Varies the material of two locks; their points may be painted."""
    return lambda: factors(text, two_locks(point=painted))


def bumped(mesh: Mesh, change: Callable[[Mesh], object]) -> Mesh:
    change(mesh)
    return mesh


def collapse(mesh: Mesh) -> None:
    mesh.points[mesh.triangles[5]] *= [0, 1, 0]


def tilt(mesh: Mesh) -> None:
    mesh.points[:, 1] = 0.1 * mesh.points[:, 0]


def over_floor(*garments: Any, **given: Any) -> Act:
    """Simulates a frame of three locks, and sheets, over a floor."""
    return lambda: simulated(*garments, text=ONE, **given)


def checkpoints(friction: float = 0.3) -> Checkpoints:
    """The folder of a run, whose inputs have a friction."""
    shot = parse_shot(f"{ONE}friction = {friction}\n")
    with recorded() as reads:
        return Checkpoints(Path("part"), run_inputs(shot, floor_groom(), reads, None), every=1)


def begun(friction: float, resume: bool) -> Act:
    return lambda: checkpoints(friction).begin(resume)


def held_twice() -> None:
    with ringlet.hold_checkpoints("part"), ringlet.hold_checkpoints("part"):
        pass


def held() -> None:
    with ringlet.hold_checkpoints("part"), ringlet.hold_checkpoints("another"):
        pass
    with ringlet.hold_checkpoints("part"):
        pass


def interrupted(touches: bool, resume: bool = True) -> Act:
    """Stops a run that keeps no contacts, and goes on; ``touches`` asks for contacts then."""

    def stop(*frame: Any) -> None:
        raise KeyboardInterrupt

    def act() -> None:
        made, given = floor_groom(), {"obstacles": [Obstacle(floor(), still(floor()))]}
        for after, more in ((stop, {}), (None, {"resume": resume, "touches": touches})):
            with contextlib.suppress(KeyboardInterrupt):
                simulate(
                    parse_shot(ONE.replace("1, 1]", "1, 3]")),
                    made,
                    still(made.scalp),
                    on_frame=after,
                    checkpoints=checkpoints(),
                    **given,
                    **more,
                )

    return act


def colliding(*samples: np.ndarray) -> Obstacle:
    """The floor, with its points at frames 1 and 4."""
    return Obstacle(floor(), Clip(np.array([1.0, 4.0])[: len(samples)], np.stack(samples), 24.0))


FLOOR = floor().points
ONE = FLOOR_SHOT.replace("1, 12]", "1, 1]") + CONTACT
VALUES = np.ones(62)
TWO_FLOORS = [Obstacle(floor(), still(floor()), Collider(name=name)) for name in ("floor", "lower")]
SIMULATIONS = [
    Advice("has the frames {}; give at least one, each later than the one before", shot(shots.CLOTH +
        "shrink = [[3, 1], [2, 0.5]]"), shot(shots.CLOTH + "shrink = [[2, 1], [3, 0.5]]")),
    Advice("belongs to a run in progress; let it end, or choose another place", held_twice, held),
    Advice("was left by another run: {}; put it back, or run without --resume to start over", in_order(begun(0.1,
        False), begun(0.2, True)), in_order(begun(0.1, True), begun(0.2, False))),
    Advice("cloth needs triangles with an area: remove or repair them", over_floor(garment(bumped(sheet(), collapse))),
        over_floor(garment(sheet(cells=2)))),
    Advice("belong to none); remove or hold them", over_floor(garment(dataclasses.replace(sheet(cells=2),
        points=np.concatenate([sheet(cells=2).points, [[0, 0.05, 0]]])))), over_floor(garment(sheet(cells=2)))),
    Advice("which has a value that is no number on {}; paint it again", over_floor(garment(dataclasses.replace(sheet(
        cells=2), maps={"m": np.full((8, 3), np.nan)}), pin=[{"map": "m"}])), over_floor(garment(dataclasses.replace(
        sheet(cells=2), maps={"m": np.ones((8, 3))}), pin=[{"map": "m"}]))),
    Advice("reaches no vertex; choose another subset or map", over_floor(garment(dataclasses.replace(sheet(cells=2),
        maps={"m": np.zeros((8, 3))}), pin=[{"map": "m"}])), over_floor(garment(sheet(cells=2), pin=[{"map":
        "stiff"}]))),
    Advice("give the one that is meant a [[collider]] of its own, with", over_floor(garment(sheet(cells=2), pin=[{"to":
        "floor"}]), obstacles=[TWO_FLOORS[0]] * 2), over_floor(garment(sheet(cells=2), pin=[{"to": "floor"}]),
        obstacles=TWO_FLOORS)),
    Advice("method is pardiso, which is not installed", lambda: direct(open_pardiso=lambda: False), direct),
    Advice("has {} points at frame {}, {} in its rest pose; must not change", over_floor(obstacles=[colliding(
        np.zeros((5, 3)))]), over_floor(obstacles=[colliding(FLOOR)])),
    Advice("move it out, or leave that mesh out of the colliders", over_floor(garment(bumped(sheet(cells=2), tilt))),
        in_order(over_floor(garment(sheet(cells=2))), over_floor(garment(bumped(sheet(cells=2), tilt)), obstacles=[]))),
    Advice("{}: at frame {} triangle {} has no area or is not finite ({} of {}); {}", over_floor(obstacles=[colliding(
        FLOOR * [1, 1, 0])]), in_order(over_floor(obstacles=[colliding(FLOOR)]), over_floor(obstacles=[]))),
    Advice("the run that left it did not keep what touched; leave out --contacts", interrupted(touches=True), in_order(
        interrupted(touches=False), interrupted(touches=True, resume=False))),
    Advice("has {} numbers a point; must be one, paint another", vary('bend = { map = "m" }', m=np.ones((62, 3))),
        vary('bend = { map = "m" }', m=VALUES)),
    Advice("shot: {}.map '{}' is {} on lock {}; must be at least 0 and finite, paint it again", vary(
        'bend = { map = "m" }', m=-VALUES), vary('bend = { map = "m" }', m=VALUES)),
    Advice("{}; must be at least {}, change its ramp or map", vary("stretch = { ramp = [[0, 1], [1, 1e-7]] }"), vary(
        "stretch = { ramp = [[0, 1], [1, 1e-6]] }")),
    Advice("{}, change its ramp or map", vary("radius = { ramp = [[0, 1], [1, 1e-30]] }"), vary(
        "radius = { ramp = [[0, 1], [1, 0.5]] }")),
]  # fmt: skip
ROWS = [*ADOPTING, *COMMANDS, *DATA, *GROOMS, *FILES, *SIMULATIONS]
