"""Tries that look for silent wrong values: python tests/fuzz/tries.py [AREA] [FIRST] [COUNT].

A try is a function of a random generator and an empty folder, which AREA and a number seed: ``tries.py heads 17 1``
repeats one. It makes input of random settings and asserts what holds for any: units, roots on the skin, order, round
trips, a resume. A UserError in one line is a refusal. All else that is raised is a finding, printed with its number.
"""

from __future__ import annotations

import json
import math
import sys
import tempfile
import traceback
import zlib
from collections import Counter
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Any

import numpy as np
from numpy.random import Generator
from pxr import Gf, Usd, UsdGeom, Vt

sys.path.append(str(Path(__file__).parents[1] / "python"))
import small_example
from commands import run
from ringlet.data.binding import root_places
from ringlet.data.toml import to_toml
from shapes import ball

import ringlet
from ringlet import Curves, Groom, Memory, Mesh
from ringlet.groom import make_groom, make_hairs, parse_recipe

SINGLE = 5e-7  # relative error of what passes through a file
MOST = {"count": 40, "points": 60, "shape_points": 30, "per_lock": 6, "levels": 4, "strands": 4, "density": 3}
LARGEST = {"m": 0.3, "deg": 180.0}  # of settings, by unit
OF_SECTIONS = {"Braid", "Twist", "Cornrow", "Knot", "Loc"}  # operators on the strands of sections
ONE_OF = {"count", "spacing", "curls", "pitch", "curls_per_cm", "density", "cover"}  # exclude one another
NAMES = {"curve": "tail", "line": "tail", "mesh": "round"}
HELPERS = {
    "curves": {"tail": {"points": [[0, 8, -8], [0, 6, -11], [0, -4, -12]]}},
    "meshes": {"round": {"middle": [0, 0, 0], "width": 30, "height": 30, "depth": 30}},
}


class Settings:
    """Random values of settings within the bounds of a schema."""

    def __init__(self, random: Generator, kind: str) -> None:
        self.random, self.schema = random, ringlet.schema()[kind]

    def table(self, name: str, share: float = 0.3, **given: Any) -> dict[str, Any]:
        """A table with a share of its settings."""
        made = {
            key: value
            for key, node in self.schema["$defs"][name]["properties"].items()
            if key not in given and key not in ONE_OF and self.random.random() < share
            if (value := self.value(key, node)) is not None
        }
        return made | given

    def value(self, key: str, node: dict[str, Any]) -> Any:
        """A value of one setting; None for one that refers to what is not there."""
        choices = [
            one for one in node.get("anyOf", [node]) if one.get("type") not in ("null", "string") or "enum" in one
        ]
        if key in NAMES:
            return NAMES[key]
        if not choices or key in ("map", "region", "lock", "seed", "preset", "where", "file", "prim"):
            return None
        one = choices[self.random.integers(len(choices))]
        if "$ref" in one:
            number = next((other for other in choices if "maximum" in other), None)
            return self.varied(key, number, node) if number and one["$ref"].rpartition("/")[2] != "Mask" else None
        if "enum" in one:
            return one["enum"][self.random.integers(len(one["enum"]))]
        if one.get("type") == "boolean":
            return bool(self.random.integers(2))
        return self.number(key, one, node) if one.get("type") in ("integer", "number") else None

    def number(self, key: str, bounds: dict[str, Any], node: dict[str, Any]) -> float | int:
        """A number within its bounds, of any size, and a bound itself now and then."""
        unit = node.get("unit", "")
        least = bounds.get("minimum", bounds.get("exclusiveMinimum", 0.0))
        most = min(bounds.get("maximum", 1.0), MOST.get(key, math.inf), LARGEST.get(unit, math.inf))
        if bounds["type"] == "integer":
            return int(self.random.integers(least, most + 1))
        if "minimum" in bounds and self.random.random() < 0.1:
            return self.in_text(least, unit)
        smallest = max(least, 1e-3 * most) if least >= 0.0 else least
        found = (
            self.random.uniform(least, most) if least < 0.0 else smallest * (most / smallest) ** self.random.random()
        )
        return self.in_text(found, unit)

    def in_text(self, value: float, unit: str) -> Any:
        """A length in metres as text, another number as it is."""
        return f"{1e3 * value:.9g} mm" if unit == "m" else float(f"{value:.9g}")

    def varied(self, key: str, bounds: dict[str, Any], node: dict[str, Any]) -> dict[str, Any]:
        """A value with chance."""
        return {"value": self.number(key, bounds, node), "vary": round(self.random.random(), 3)}

    @property
    def operators(self) -> list[str]:
        """Names of the definitions of all operators."""
        found = self.schema["properties"]["shape"]["items"]["discriminator"]["mapping"]
        return [place.rpartition("/")[2] for place in found.values()]

    def recipe(self, operators: int = 3) -> dict[str, Any]:
        """A recipe of a few locks, with random operators."""
        names = self.operators
        some = [names[self.random.integers(len(names))] for _ in range(self.random.integers(operators + 1))]
        ops = {name: self.schema["$defs"][name]["properties"]["op"]["const"] for name in names}
        locks = self.table(
            "Locks", 0.2, count=int(self.random.integers(1, 25)), points=int(self.random.integers(8, 60))
        )
        if OF_SECTIONS & set(some):
            size, strands = f"{self.random.uniform(25, 60):.3f} mm", int(self.random.integers(2, 4))
            locks |= {"sections": {"pattern": "grid", "size": size, "strands": strands}}
        return {
            "ringlet": 2,
            "seed": int(self.random.integers(100)),
            "scalp": {"region": "scalp"},
            **HELPERS,
            "guides": self.table("Grown", 0.2, count=int(self.random.integers(1, 20)), length=self.length()),
            "locks": locks,
            "shape": [self.table(name, op=ops[name]) for name in some],
            **(
                {"curl": self.table("Curl", 0.3, curls=self.random.uniform(0.0, locks["points"] / 8))}
                if self.random.random() < 0.5
                else {}
            ),
            "hairs": self.table("HairSettings", 0.2, per_lock=int(self.random.integers(1, 6))),
        }

    def length(self) -> str:
        """A length of hair."""
        return f"{10.0 ** self.random.uniform(0.5, 2.3):.4g} mm"


def grown(table: dict[str, Any], scalp: Mesh | None = None, memory: Memory | None = None) -> Groom:
    """The groom of a recipe's table."""
    return make_groom(parse_recipe(to_toml(table)), scalp or ball(), memory=memory)


def check_curves(curves: Curves, scalp: Mesh, what: str) -> None:
    """Asserts that curves are finite, have distinct ids, and grow where they are bound."""
    assert np.isfinite(curves.points).all(), f"{what}: not finite"
    assert len(np.unique(curves.ids)) == len(curves), f"{what}: ids that are not distinct"
    places = root_places(curves, scalp.points, scalp.triangles)
    off = np.linalg.norm(curves.roots - places, axis=1).max()
    size = np.abs(scalp.points).max()
    assert off <= 1e-5 * size, f"{what}: a root is {off:.2g} m off the skin"


def same(found: np.ndarray, wanted: np.ndarray, tolerance: float, what: str) -> None:
    """Asserts that two arrays agree."""
    assert found.shape == wanted.shape, f"{what}: {found.shape} instead of {wanted.shape}"
    worst = float(np.abs(found - wanted).max()) if found.size else 0.0
    assert worst <= tolerance, f"{what}: differs by {worst:.3g}"


# Areas


def recipes(random: Generator, folder: Path) -> None:
    """Roots, lengths, hairs, and the same groom again, after an edit, and from its file."""
    settings = Settings(random, "recipe")
    table, scalp = settings.recipe(), ball()
    groom = grown(table, scalp)
    check_curves(groom.locks, scalp, "locks")
    assert (groom.locks.counts == table["locks"]["points"]).all(), "locks have another number of points"
    lengths = groom.locks.lengths()
    assert (lengths > 0.0).all(), "a lock of no length"
    same(grown(table, scalp).locks.points, groom.locks.points, 0.0, "the same recipe again")

    hairs = make_hairs(groom)
    check_curves(hairs.curves, scalp, "hairs")
    some = make_hairs(groom, fraction=0.5)
    rows = np.searchsorted(hairs.curves.ids, some.curves.ids)
    if len(hairs.curves) > 1 and (np.diff(hairs.curves.ids) > 0).all():
        whole = hairs.curves.points.reshape(len(hairs.curves), -1, 3)[rows]
        same(some.curves.points.reshape(whole.shape), whole, 1e-6, "half of the hairs")

    memory = Memory()
    other = json.loads(json.dumps(table))
    other["seed"] += 1
    for one in (other, table):
        kept = grown(one, scalp, memory)
    same(kept.locks.points, groom.locks.points, 0.0, "after an edit and back")

    ringlet.write_groom(groom, folder / "g.usdc")
    read = ringlet.read_groom(folder / "g.usdc")
    same(read.locks.points, groom.locks.points, SINGLE, "from its file")
    assert (read.locks.ids == groom.locks.ids).all()


def asked(random: Generator, folder: Path) -> None:
    """Lengths, counts and widths are those that are asked for."""
    length, vary = 10.0 ** random.uniform(-2.5, -0.6), random.random()
    count, per_lock = int(random.integers(2, 40)), int(random.integers(1, 9))
    width = 10.0 ** random.uniform(-5, -3)
    table = {
        "ringlet": 2,
        "unit": str(random.choice(["mm", "cm", "m", "in"])),
        "scalp": {"region": "scalp"},
        "guides": {
            "count": count,
            "length": {"value": f"{1e3 * length} mm", "vary": vary},
            "gravity_bend": random.uniform(0, 3),
        },
        "collide": {"margin": 0},
        "hairs": {"per_lock": per_lock, "width": {"value": f"{1e3 * width} mm", "vary": 0, "ramp": [[0, 1]]}},
    }
    groom = grown(table)
    lengths = groom.guides.lengths()
    assert len(groom.guides) == count, f"{len(groom.guides)} guides of {count}"
    low, high = length * (1 - vary), length * (1 + vary)
    assert lengths.min() > 0.97 * low - 1e-4 and lengths.max() < 1.01 * high, (
        f"{lengths.min()}, {lengths.max()} of {low}, {high}"
    )
    hairs = make_hairs(groom).curves
    assert len(hairs) == per_lock * len(groom.locks), "hairs of a lock"
    same(hairs.point["width"], np.full(len(hairs.points), width), 1e-3 * width, "width")


def used(random: Generator, folder: Path) -> None:
    """A setting that is changed changes the locks or the hairs, or is refused."""
    settings = Settings(random, "recipe")
    defs = settings.schema["$defs"]
    name = str(random.choice([*settings.operators, "Curl", "HairSettings", "Grown", "Locks", "Hairline"]))
    table = settings.recipe(0)
    op = defs[name]["properties"].get("op", {}).get("const")
    place: dict[str, Any] = settings.table(name, 0.3, op=op) if op else {}
    key = str(random.choice([key for key in defs[name]["properties"] if key not in ("op", "seed")]))
    wanted = settings.value(key, defs[name]["properties"][key])
    if wanted is None:
        return
    tables = []
    for more in ({}, {key: wanted}):
        one = json.loads(json.dumps(table))
        where = {"Curl": "curl", "HairSettings": "hairs", "Grown": "guides", "Locks": "locks"}.get(name)
        if op:
            one["shape"] = [place | more]
        elif where:
            one[where] = one.get(where, {"curls": 2.0} if where == "curl" else {}) | more
        else:
            one["locks"]["hairline"] = more
        tables.append(one)
    before, after = (grown(one) for one in tables)
    if op and np.array_equal(grown(table).locks.points, before.locks.points):
        return  # the operator does nothing there
    default = defs[name]["properties"][key].get("default")
    if (
        wanted == default
        or tables[0] == tables[1]
        or (isinstance(default, dict) and default.get("value") == 0.0 == wanted)
    ):
        return
    changed = before.locks.points.shape != after.locks.points.shape or not np.array_equal(
        before.locks.points, after.locks.points
    )
    if not changed:
        hairs = [make_hairs(groom).curves for groom in (before, after)]
        changed = any(
            one.shape != other.shape or not np.array_equal(one, other)
            for one, other in ((hairs[0].points, hairs[1].points), (hairs[0].point["width"], hairs[1].point["width"]))
        )
    assert changed, f"UNUSED {name}.{key} = {wanted}"


def heads(random: Generator, folder: Path) -> None:
    """A head of another unit and axis, with unused points, has the same groom; one of another winding, none inside."""
    recipe = to_toml(Settings(random, "recipe").recipe(1) | {"scalp": {"file": "head.usda", "region": "scalp"}})
    grooms = []
    kinds = random.permutation(["flat faces", "turned", "left handed", "unused"])[: random.integers(3)]
    units = (0.01, float(random.choice([1.0, 0.001, 0.0254, 0.1])))
    for place, (unit, up) in enumerate(zip(units, ("Y", str(random.choice(["Y", "Z"]))), strict=True)):
        here = folder / str(place)
        here.mkdir()
        small_example.write_head(here / "head.usda", unit=unit, up=up)
        (here / "r.recipe.toml").write_text(recipe)
        if place == 1:
            for kind in kinds:
                _spoil(here / "head.usda", str(kind))
        grooms.append(ringlet.build_groom(here / "r.recipe.toml"))
    first, other = grooms
    check_curves(other.locks, other.scalp, "locks")
    inside = [np.linalg.norm(of.locks.points.astype(float), axis=1).min() < 0.085 for of in grooms]
    assert inside[0] or not inside[1] or other.conflicts, "hair inside"
    # Few samples of a sphere can be chosen in several ways, between which rounding decides.
    if not set(kinds) & {"turned", "flat faces"} and np.array_equal(other.guides.ids, first.guides.ids):
        _, rows, others = np.intersect1d(first.locks.ids, other.locks.ids, return_indices=True)
        found, wanted = (of.locks.take(which).points for of, which in ((other, others), (first, rows)))
        same(found, wanted, 2e-6, f"unit and axis, {', '.join(kinds)}")


def _spoil(path: Path, kind: str) -> None:
    """Changes a head in a way that leaves its surface as it is."""
    stage = Usd.Stage.Open(str(path))
    mesh = UsdGeom.Mesh(stage.GetPrimAtPath("/ball/skin"))
    points = np.array(mesh.GetPointsAttr().Get())
    counts, corners = (np.array(of.Get()) for of in (mesh.GetFaceVertexCountsAttr(), mesh.GetFaceVertexIndicesAttr()))
    if kind == "turned":
        corners = corners.reshape(-1, 3)[:, ::-1].ravel()
    elif kind == "left handed":
        corners = corners.reshape(-1, 3)[:, [0, 2, 1]].ravel()
        left = mesh.GetOrientationAttr().Get() == "leftHanded"
        mesh.CreateOrientationAttr("rightHanded" if left else "leftHanded")
    elif kind == "unused":
        points = np.concatenate([points, points[:1] * 3.0])
    elif kind == "flat faces":
        counts, corners = np.append(counts, 3), np.append(corners, [0, 0, 1])
    mesh.GetPointsAttr().Set(Vt.Vec3fArray.FromNumpy(points.astype(np.float32)))
    mesh.GetFaceVertexCountsAttr().Set(counts.tolist())
    mesh.GetFaceVertexIndicesAttr().Set(corners.tolist())
    stage.Save()


def shots(random: Generator, folder: Path) -> None:
    """Roots stay on a moving head, the first frame is the groom, and edges keep their lengths or are reported."""
    shot, groom = _scene(random, folder)
    cache = ringlet.simulate(shot, groom)
    clip_stage = Usd.Stage.Open(str(folder / "head.usda"))
    same(cache.points[0], groom.locks.points, 1e-6, "the first frame is the groom")
    assert np.isfinite(cache.points).all(), "not finite"
    first, edges = groom.locks.offsets[:-1], np.ones(len(groom.locks.points) - 1, bool)
    edges[groom.locks.offsets[1:-1] - 1] = False
    local = root_places(groom.locks, groom.scalp.points, groom.scalp.triangles)
    rest = np.linalg.norm(np.diff(groom.locks.points, axis=0), axis=1)[edges]
    for k, frame in enumerate(cache.frames):
        to_world = UsdGeom.Xformable(clip_stage.GetPrimAtPath("/ball/skin")).ComputeLocalToWorldTransform(frame)
        wanted = np.array([to_world.Transform(Gf.Vec3d(*(100.0 * place))) for place in local]) / 100.0
        same(cache.points[k][first], wanted, 2e-6, f"roots at frame {frame}")
        strain = np.linalg.norm(np.diff(cache.points[k], axis=0), axis=1)[edges] / rest
        reported = cache.statistics[k].get("max_strain", cache.statistics[k].get("max_stretch", 0.0))
        assert strain.max() < 1.1 or reported > 0.05, f"STRETCH {strain.max():.2f} at frame {frame}"


def rates(random: Generator, folder: Path) -> None:
    """The same motion at another frame rate, with as many steps a second, ends in the same place."""
    ends, seed = [], int(random.integers(1 << 30))
    for rate in (24, int(random.choice([12, 48]))):
        here = folder / str(rate)
        here.mkdir()
        shot, groom = _scene(np.random.default_rng(seed), here, rate=rate, steps=48, slides=True)
        ends.append(ringlet.simulate(shot, groom).points[-1])
    same(ends[1], ends[0], 1e-6, f"rate {rate}")


def _scene(
    random: Generator, folder: Path, *, rate: int = 24, steps: int = 24, slides: bool = False
) -> tuple[Any, Groom]:
    """A shot of a few locks on a ball that moves, with or without contact, and its groom.

    slides: the ball does not turn, and nothing touches
    """
    small_example.write_head(folder / "head.usda")
    stage = Usd.Stage.Open(str(folder / "head.usda"))
    stage.SetTimeCodesPerSecond(rate)
    root = UsdGeom.Xformable(stage.GetPrimAtPath("/ball"))
    root.ClearXformOpOrder()
    root.GetPrim().RemoveProperty("xformOp:rotateY")
    move, turn = root.AddTranslateOp(), root.AddRotateXYZOp()
    speed, spin = random.uniform(-30, 30, 3), (not slides) * random.uniform(-200, 200, 3)  # [cm/s], [degrees/s]
    seconds = 0.25
    for at in range(round(rate * seconds) + 1):
        t = at / rate
        move.Set(Gf.Vec3d(*(speed * t)), 1 + at)
        turn.Set(Gf.Vec3f(*(spin * t).tolist()), 1 + at)
    stage.SetEndTimeCode(1 + round(rate * seconds))
    stage.Save()
    recipe = {
        "ringlet": 2,
        "scalp": {"file": "head.usda", "region": "scalp"},
        "guides": {
            "count": int(random.integers(1, 5)),
            "length": f"{random.uniform(5, 80):.3f} mm",
            "lift": round(random.random(), 3),
        },
        "locks": {"points": int(random.integers(6, 24))},
        **(
            {"curl": {"curls": round(random.uniform(0.2, 0.7), 3), "width": f"{random.uniform(1, 10):.3f} mm"}}
            if random.random() < 0.5
            else {}
        ),
    }
    shot = {
        "ringlet": 2,
        "groom": "r.recipe.toml",
        "frames": [1, 1 + round(rate * seconds)],
        "preroll": 0,
        "solver": {"newton": int(random.integers(1, 8)), "substeps": max(1, steps // rate)},
        "strands": {"bend_scale": 10.0 ** random.uniform(-1, 1), "damping": float(random.choice([0.0, 0.004]))},
        **({"contact": {"radius": 10.0 ** random.uniform(-4, -2.7)}} if random.random() < 0.6 and not slides else {}),
    }
    (folder / "r.recipe.toml").write_text(to_toml(recipe))
    (folder / "s.shot.toml").write_text(to_toml(shot))
    return ringlet.read_shot(folder / "s.shot.toml"), ringlet.load_groom(folder / "r.recipe.toml")


def resumes(random: Generator, folder: Path) -> None:
    """A run that breaks off anywhere and is resumed has the frames of one that did not, to the bit."""
    shot, groom = _scene(random, folder)
    ringlet.write_groom(groom, folder / "g.usdc")
    groom = ringlet.read_groom(folder / "g.usdc")
    whole = ringlet.simulate(shot, groom)
    stops = int(random.integers(1, len(whole.frames)))

    def stop(frame: float, statistics: dict[str, Any]) -> None:
        if frame >= shot.frames[0] + stops:
            raise InterruptedError

    files = folder / "g.usdc", folder / "c.usdc"
    with suppress(InterruptedError):
        ringlet.write_simulation(shot, groom, *files, checkpoints=folder / "p", on_frame=stop)
    assert not (folder / "c.usdc").exists(), "a cache of a part of the frames"
    ringlet.write_simulation(shot, groom, *files, checkpoints=folder / "p", resume=True)
    read = ringlet.read_cache(folder / "c.usdc")
    same(read.frames, whole.frames, 0.0, "frames")
    same(read.points, whole.points, 1e-6, "resumed")
    for frame in random.permutation(read.frames)[:2]:
        with ringlet.open_cache(folder / "c.usdc") as cache:
            same(cache.points(float(frame)), whole.points[int(frame - whole.frames[0])], 1e-6, f"frame {frame}")


def formats(random: Generator, folder: Path) -> None:
    """Curves that pass through a format come back, or what is lost is reported."""
    from ringlet.io import read_curves

    suffix = str(random.choice([".abc", ".hair", ".tfx", ".obj", ".usda", ".usdc"]))
    unit = float(random.choice([1.0, 0.01, 0.001, 0.0254]))
    up = str(random.choice(["Y", "Z"]))
    stage = Usd.Stage.CreateNew(str(folder / "a.usda"))
    UsdGeom.SetStageMetersPerUnit(stage, unit)
    UsdGeom.SetStageUpAxis(stage, up)
    curves = UsdGeom.BasisCurves.Define(stage, "/hair")
    stage.SetDefaultPrim(curves.GetPrim())
    even = random.random() < 0.4
    counts = (
        np.full(random.integers(1, 12), random.choice([4, 8, 16, 32]))
        if even
        else random.integers(2, 40, random.integers(1, 12))
    )
    points = (random.normal(0, 0.2, (counts.sum(), 3)) + random.uniform(-1, 1, 3)) / unit
    curves.CreateTypeAttr("linear")
    curves.CreateCurveVertexCountsAttr(counts.tolist())
    curves.CreatePointsAttr(Vt.Vec3fArray.FromNumpy(points.astype(np.float32)))
    kinds = {"constant": 1, "uniform": len(counts), "vertex": counts.sum()}
    kind = str(random.choice(list(kinds)))
    curves.CreateWidthsAttr((1e-4 / unit * random.uniform(0.5, 2.0, kinds[kind])).tolist())
    curves.SetWidthsInterpolation(kind)
    stage.Save()
    report = ringlet.convert(folder / "a.usda", folder / f"b{suffix}")
    space = {} if suffix.startswith(".usd") else {"source_unit": report["unit"], "source_up": report["up"]}
    ringlet.convert(folder / f"b{suffix}", folder / "c.usdc", **space)
    before, after = (read_curves(folder / name) for name in ("a.usda", "c.usdc"))
    lost = " ".join(report["lost"])
    if len(after) != len(before) or (after.counts != before.counts).any():
        assert "point" in lost, f"{suffix}: counts changed, lost: {lost}"
        return
    same(after.points, before.points, 2e-6 * np.abs(before.points).max(), f"{suffix} points")
    if "width" not in lost:
        wide, was = (_widths(of) for of in (after, before))
        same(wide, was, 2e-3 * was.max(), f"{suffix} widths")


def _widths(curves: Curves) -> np.ndarray:
    """Width at each point [m]; nan where there is none."""
    of_curve = curves.curve.get("width", np.full(len(curves), np.nan))
    return curves.point.get("width", np.repeat(of_curve, curves.counts))


def names(random: Generator, folder: Path) -> None:
    """Names of files, regions and grooms of any characters change nothing, or are refused."""
    letters = "aZ9_-. :é漢'\"#%[]{}()&;,=+@!~^$\\"
    name = "".join(random.choice(list(letters), random.integers(1, 12)))
    where = str(random.choice(["file", "folder", "title", "region", "curve"]))
    plain = {"ringlet": 2, "scalp": {"file": "head.usda", "region": "scalp"}, "guides": {"count": 3, "length": 4}}
    named = json.loads(json.dumps(plain))
    here = folder / (name if where == "folder" else "x")
    here.mkdir()
    small_example.write_head(folder / "head.usda")
    head = here / (f"{name}.usda" if where == "file" else "head.usda")
    head.write_bytes((folder / "head.usda").read_bytes())
    named["scalp"]["file"] = head.name
    if where == "title":
        named["name"] = name
    elif where == "curve":
        named["curves"] = {name: HELPERS["curves"]["tail"]}
        named["shape"] = [{"op": "attract", "curve": name}]
        plain |= {"curves": HELPERS["curves"], "shape": [{"op": "attract", "curve": "tail"}]}
    elif where == "region":
        named["scalp"]["region"] = name
    for table, place in ((plain, folder), (named, here)):
        (place / "r.recipe.toml").write_text(to_toml(table))
    wanted = ringlet.build_groom(folder / "r.recipe.toml")
    done = run("groom", here / "r.recipe.toml", "-o", here / "g.usdc")
    assert done.exit_code in (0, 2), f"{where} {name!r}: exit {done.exit_code}: {done.output[-200:]}"
    if done.exit_code == 0:
        read = ringlet.read_groom(here / "g.usdc")
        same(read.locks.points, wanted.locks.points, SINGLE, f"{where} {name!r}")


def bounds(random: Generator, folder: Path) -> None:
    """Two settings at their greatest are done in bounded work, or refused."""
    settings = Settings(random, "recipe")
    defs = settings.schema["$defs"]
    found = [
        (name, key, bound["maximum"] if random.random() < 0.5 else bound.get("minimum", 0.0), node.get("unit", ""))
        for name in ("Clump", "PhaseGroups", "Locks", "Grown", "Curl", "HairSettings", "Braid", "Twist", "Knot", "Loc")
        for key, node in defs.get(name, {"properties": {}})["properties"].items()
        for bound in node.get("anyOf", [node])
        if "maximum" in bound and key not in ("count", "points", "shape_points", "per_lock", "density", "seed")
    ]
    table = settings.recipe(0)
    table["locks"]["sections"] = {"pattern": "grid", "size": "60 mm", "strands": 2}
    for place in random.permutation(len(found))[:2]:
        name, key, value, unit = found[place]
        where = {"Locks": "locks", "Grown": "guides", "Curl": "curl", "HairSettings": "hairs"}.get(name)
        value = settings.in_text(value, unit)
        if where:
            table[where] = table.get(where, {"curls": 1.0} if where == "curl" else {}) | {key: value}
        elif name == "PhaseGroups":
            table["curl"] = {"curls": 2.0, "phase_groups": {key: value}}
        else:
            table["shape"] = [*table["shape"], {"op": name.lower(), key: value}]
    if "spacing" in table["locks"]:
        del table["locks"]["count"]
    groom = grown(table)
    check_curves(groom.locks, groom.scalp, "locks")


AREAS: dict[str, Callable[[Generator, Path], None]] = {
    area.__name__: area for area in (recipes, asked, used, heads, shots, rates, resumes, formats, names, bounds)
}


@contextmanager
def limited(seconds: int) -> Iterator[None]:
    """Raises TimeoutError in work that takes longer."""
    import signal

    def stop(*_: object) -> None:
        raise TimeoutError(f"takes over {seconds} s")

    signal.signal(signal.SIGALRM, stop)
    signal.alarm(seconds)
    try:
        yield
    finally:
        signal.alarm(0)


def attempt(area: str, number: int, seconds: int = 120) -> str:
    """Runs a try: ``held``, ``refused``, or what is wrong in one line."""
    random = np.random.default_rng([zlib.crc32(area.encode()), number])
    with tempfile.TemporaryDirectory() as folder:
        try:
            with limited(seconds):
                AREAS[area](random, Path(folder))
        except ringlet.UserError as error:
            return "refused" if "\n" not in str(error) else f"refused in several lines: {error}"
        except AssertionError as error:
            return (
                str(error).splitlines()[0]
                if str(error)
                else f"asserts: {traceback.extract_tb(error.__traceback__)[-1].line}"
            )
        except Exception as error:
            place = traceback.extract_tb(error.__traceback__)[-1]
            return f"{type(error).__name__}: {str(error)[:200]!r} at {Path(place.filename).name}:{place.lineno}"
    return "held"


def main() -> None:
    """Runs tries of one area or of all, and prints counts and findings."""
    area, first, count = [*sys.argv[1:], *["all", "0", "20"][len(sys.argv) - 1 :]]
    for one in AREAS if area == "all" else [area]:
        counts: Counter[str] = Counter()
        for number in range(int(first), int(first) + int(count)):
            outcome = attempt(one, number)
            counts[outcome if outcome in ("held", "refused") else "wrong"] += 1
            if outcome not in ("held", "refused"):
                print(f"{one} {number}: {outcome}", flush=True)
        print(f"{one}: {int(first)} to {int(first) + int(count) - 1}: {dict(counts)}", flush=True)


if __name__ == "__main__":
    main()
