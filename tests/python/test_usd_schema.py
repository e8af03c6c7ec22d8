"""Files of Ringlet as models of a pipeline: kind, asset info and extents; and the schema of what only Ringlet knows."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from commands import run
from pxr import Kind, Usd, UsdGeom
from ringlet.io import problems
from small_example import RECIPE, SHOT, write_head

import ringlet

SCHEMA = Path(ringlet.__file__).parent / "io/usd/schema"
REGISTERED = """
import json, sys
from pxr import Usd
registry, found = Usd.SchemaRegistry(), {}
for file in sys.argv[1:]:
    stage = Usd.Stage.Open(file)
    for prim in stage.Traverse():
        known = [registry.FindAppliedAPIPrimDefinition(name) for name in prim.GetAppliedSchemas()]
        known = {name for one in known if one for name in one.GetPropertyNames()}
        for one in prim.GetAuthoredProperties():
            if "ringlet:" in one.GetName() and one.GetName() not in known:
                found.setdefault(one.GetName(), str(prim.GetPath()))
            if "ringlet:" in one.GetName() and one.GetName() in known:
                assert not one.IsCustom() and one.GetDocumentation(), one.GetPath()
print(json.dumps([found, stage.GetPrimAtPath("/groom").HasAPI("RingletGroomAPI")]))
"""
READ = """
import hashlib, sys, numpy as np
import ringlet
from ringlet import io
groom, hairs = ringlet.read_groom(sys.argv[1]), io.read_hairs(sys.argv[2])
arrays = [groom.locks.points, hairs.points, *groom.locks.curve.values(), *groom.locks.point.values()]
text = repr((groom.hairs, groom.color, groom.fiber, groom.region, groom.edge, groom.hidden, sorted(groom.locks.curve)))
print(hashlib.sha1(b"".join(np.ascontiguousarray(one).tobytes() for one in arrays) + text.encode()).hexdigest())
"""


@pytest.fixture(scope="module")
def files(tmp_path_factory):
    """A groom, its simulation of two frames, and its hairs in points and on demand."""
    folder = tmp_path_factory.mktemp("schema")
    write_head(folder / "head.usda")
    (folder / "small.recipe.toml").write_text(RECIPE)
    (folder / "small.shot.toml").write_text(SHOT)
    groom = ringlet.build_groom(folder / "small.recipe.toml")
    ringlet.write_groom(groom, folder / "groom.usdc")
    cache = ringlet.simulate(folder / "small.shot.toml", groom, frames=(1, 2))
    ringlet.write_cache(cache, folder / "groom.usdc", folder / "cache.usdc")
    ringlet.write_hairs(folder / "cache.usdc", folder / "hair.usdc")
    ringlet.write_hairs(folder / "cache.usdc", folder / "demand.usdc", on_demand=True)
    return folder


def registered(script, *arguments, schema=True):
    """What a script prints in a process that has the schema, or has it not."""
    environment = {**os.environ, "PXR_PLUGINPATH_NAME": str(SCHEMA) if schema else ""}
    command = [sys.executable, "-c", script, *map(str, arguments)]
    return subprocess.run(command, env=environment, capture_output=True, text=True, timeout=120, check=True).stdout


def bounds(stage, time):
    purposes = [UsdGeom.Tokens.default_, UsdGeom.Tokens.guide]
    cache = UsdGeom.BBoxCache(time, purposes, useExtentsHint=False)
    found = cache.ComputeUntransformedBound(stage.GetPrimAtPath("/groom")).ComputeAlignedRange()
    return np.array([found.GetMin(), found.GetMax()])


@pytest.mark.parametrize("name", ["groom", "cache", "hair", "demand"])
def test_a_file_is_a_model_with_a_kind_a_name_and_extents(files, name):
    stage = Usd.Stage.Open(str(files / f"{name}.usdc"))
    root = stage.GetPrimAtPath("/groom")
    assert Usd.ModelAPI(root).GetKind() == Kind.Tokens.component and root.IsModel()
    assert Usd.ModelAPI(root).GetAssetName() == "small"
    hint = UsdGeom.ModelAPI(root).GetExtentsHintAttr()
    assert hint.GetTimeSamples() == ([] if name == "groom" else [1.0, 2.0])
    for time in (Usd.TimeCode.Default(), *map(Usd.TimeCode, hint.GetTimeSamples())):
        box = np.array(hint.Get(time)).reshape(-1, 2, 3)  # a box for each purpose; those without geometry are empty
        full = box[(box[:, 0] <= box[:, 1]).all(axis=1)]
        assert len(full) == 2  # what is rendered, and guides
        np.testing.assert_allclose([full[:, 0].min(axis=0), full[:, 1].max(axis=0)], bounds(stage, time), rtol=1e-6)
    assert problems(files / f"{name}.usdc") == []


def test_a_head_that_is_a_model_makes_the_groom_an_assembly(tmp_path):
    write_head(tmp_path / "head.usda")
    stage = Usd.Stage.Open(str(tmp_path / "head.usda"))
    Usd.ModelAPI(stage.GetDefaultPrim()).SetKind(Kind.Tokens.component)
    stage.Save()
    (tmp_path / "small.recipe.toml").write_text(RECIPE)
    ringlet.write_groom(ringlet.build_groom(tmp_path / "small.recipe.toml"), tmp_path / "groom.usdc")
    made = Usd.Stage.Open(str(tmp_path / "groom.usdc"))
    root = made.GetPrimAtPath("/groom")
    assert Usd.ModelAPI(root).GetKind() == Kind.Tokens.assembly and root.GetChild("body").IsModel()
    assert problems(tmp_path / "groom.usdc") == []


def test_converted_hair_is_a_model_too(files, tmp_path):
    ringlet.convert(files / "hair.usdc", tmp_path / "a.usdc")
    stage = Usd.Stage.Open(str(tmp_path / "a.usdc"))
    root = stage.GetPrimAtPath("/groom")
    assert Usd.ModelAPI(root).GetKind() == Kind.Tokens.component
    assert UsdGeom.ModelAPI(root).GetExtentsHintAttr().GetTimeSamples() == [1.0, 2.0]
    assert problems(tmp_path / "a.usdc") == []


def test_the_schema_registers_and_knows_what_files_have(files):
    """Inputs of hairs on demand are the kernel's and change with it; of them the schema names what others need."""
    names = [files / f"{name}.usdc" for name in ("groom", "cache", "hair", "demand")]
    found, has_api = json.loads(registered(REGISTERED, *names))
    assert has_api
    unknown = {name for name, prim in found.items() if not (prim == "/groom/hairs" and not name.endswith(":id"))}
    assert unknown == set()
    assert json.loads(registered(REGISTERED, files / "groom.usdc", schema=False))[0] != {}


def test_the_schema_changes_nothing_of_what_ringlet_reads(files):
    arguments = READ, files / "groom.usdc", files / "demand.usdc"
    assert registered(*arguments) == registered(*arguments, schema=False)


def test_hairs_on_demand_are_expanded_in_parts_for_a_farm(files, tmp_path):
    whole = run("hair", files / "demand.usdc", "-o", tmp_path / "whole.usdc")
    part = run("hair", files / "demand.usdc", "-o", tmp_path / "part.usdc", "--frames", "2:2")
    assert whole.exit_code == part.exit_code == 0
    assert ringlet.io.read_hair_frames(tmp_path / "part.usdc").tolist() == [2.0]
    for name in ("whole", "part"):
        found = ringlet.io.read_hairs(tmp_path / f"{name}.usdc", 2.0)
        np.testing.assert_allclose(found.points, ringlet.io.read_hairs(files / "hair.usdc", 2.0).points, atol=2e-5)
