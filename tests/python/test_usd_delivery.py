"""Files as renderers and simulators take them: material, velocities, rest, texture coordinates and purposes."""

from __future__ import annotations

import importlib.util

import numpy as np
import pytest
from pxr import Usd, UsdGeom, UsdShade
from ringlet.data.pigment import HAIR_COLORS, absorption
from ringlet.io import HairWriter, problems, read_groom, read_space, write_cache, write_groom
from usd_scenes import hairs_of, make_groom, write_head

from ringlet import Cache

# The head is the user's; MaterialX nodes are unknown to a USD without MaterialX, such as usd-core.
KNOWN = "/body", "shaderId 'ND_"
RISE = np.array([0, 0.01, 0])
FRAMES = (1.0, 2.0, 3.0)


@pytest.fixture(params=[(0.01, "Y"), (1.0, "Z")], ids=["cm-Y", "m-Z"])
def folder(tmp_path, request):
    """A groom, its cache and its hairs, which rise 0.01 m, 0.03 m in the second frame."""
    unit, axis = request.param
    head = write_head(tmp_path / "head.usdc", unit=unit, axis=axis)
    groom = make_groom(head)
    del groom.locks.curve["frame"]
    groom.guides.curve = {name: groom.locks.curve[name][:2] for name in ("root_triangle", "root_barycentric")}
    write_groom(groom, tmp_path / "groom.usdc")
    rises = [k * k * RISE for k in range(3)]
    moved = np.stack([groom.locks.points + rise for rise in rises]).astype(np.float32)
    write_cache(Cache(np.array(FRAMES), moved), tmp_path / "groom.usdc", tmp_path / "cache.usdc", read_space(head))
    hairs = hairs_of(groom)
    hairs.curve |= {"melanin": np.linspace(0.2, 0.9, 10), "redness": np.full(10, 0.3)}
    hairs.curve |= {"roughness": np.full(10, 0.3), "azimuthal_roughness": np.full(10, 0.4), "tilt": np.full(10, 3.0)}
    with HairWriter(tmp_path / "hair.usdc", groom, hairs, tmp_path / "cache.usdc", velocities=True) as writer:
        for frame, rise in zip(FRAMES, rises, strict=True):
            writer.add(frame, (hairs.points + rise).astype(np.float32))
    return tmp_path


OPEN = list[Usd.Stage]()  # stages live as long as their prims are looked at


@pytest.fixture(autouse=True)
def close_stages():
    yield
    OPEN.clear()


def prims(folder, name="hair.usdc"):
    OPEN.append(stage := Usd.Stage.Open(str(folder / name)))
    return {name: stage.GetPrimAtPath(f"/groom/{name}") for name in ("locks", "guides", "hairs", "body/skin")}


def inputs(shader):
    return {one.GetBaseName(): one for one in shader.GetInputs()}


def upstream(value):
    """The shader that an input or output is connected to."""
    return UsdShade.Shader(value.GetConnectedSources()[0][0].source.GetPrim())


def test_velocities_are_in_units_per_second(folder):
    space = read_space(folder / "groom.usdc")
    up = np.array([0.0, 0.0, 1.0]) if space.up_axis == "Z" else np.array([0.0, 1.0, 0.0])
    found = prims(folder)
    for prim in (found["locks"], found["hairs"]):
        attribute = UsdGeom.PointBased(prim).GetVelocitiesAttr()
        assert attribute.GetTimeSamples() == list(FRAMES)
        for frame, steps in zip(FRAMES, (1.0, 2.0, 3.0), strict=True):  # of 0.01 m a frame
            value = np.array(attribute.Get(frame)) * space.meters_per_unit
            np.testing.assert_allclose(value, np.tile(0.01 * steps * 24.0 * up, (len(value), 1)), atol=1e-4)
    assert not UsdGeom.PointBased(prims(folder, "groom.usdc")["locks"]).GetVelocitiesAttr().HasAuthoredValue()


def test_rest_is_on_guides_hairs_and_skin(folder):
    for name, prim in prims(folder).items():
        rest = UsdGeom.PrimvarsAPI(prim).GetPrimvar("rest")
        assert rest.GetInterpolation() == "vertex" and rest.GetTypeName().role == "Point", name
        np.testing.assert_array_equal(rest.Get(), UsdGeom.PointBased(prim).GetPointsAttr().Get(), err_msg=name)


def test_texture_coordinates_and_purposes_are_those_that_programs_expect(folder):
    for name, prim in prims(folder).items():
        assert UsdGeom.PrimvarsAPI(prim).GetPrimvar("st").HasAuthoredValue(), name
        purpose = UsdGeom.Imageable(prim).ComputePurpose()
        assert purpose == ("guide" if name in ("locks", "guides") else "default"), name


def test_no_primvar_is_varying(folder):
    for name in ("groom.usdc", "cache.usdc", "hair.usdc"):
        stage = Usd.Stage.Open(str(folder / name))
        for prim in stage.Traverse():
            if UsdGeom.BasisCurves(prim):
                kinds = {p.GetInterpolation() for p in UsdGeom.PrimvarsAPI(prim).GetPrimvarsWithAuthoredValues()}
                assert kinds <= {"constant", "uniform", "vertex"}, prim
                assert UsdGeom.BasisCurves(prim).GetWidthsInterpolation() in ("constant", "vertex")


def test_hairs_have_a_material_of_their_pigments(folder):
    prim = prims(folder)["hairs"]
    material, _ = UsdShade.MaterialBindingAPI(prim).ComputeBoundMaterial()
    surface = upstream(material.GetSurfaceOutput("mtlx"))
    bsdf = upstream(inputs(surface)["bsdf"])
    assert (surface.GetShaderId(), bsdf.GetShaderId()) == ("ND_surface", "ND_chiang_hair_bsdf")
    np.testing.assert_allclose(inputs(bsdf)["cuticle_angle"].Get(), 0.5 + 3.0 / 180.0, rtol=1e-6)
    roughness = upstream(inputs(bsdf)["roughness_TRT"])
    np.testing.assert_allclose([inputs(roughness)[n].Get() for n in ("longitudinal", "azimuthal")], [0.3, 0.4])
    melanin = upstream(inputs(bsdf)["absorption_coefficient"])
    assert melanin.GetShaderId() == "ND_deon_hair_absorption_from_melanin"
    primvars = [
        inputs(upstream(inputs(melanin)[f"melanin_{n}"]))["geomprop"].Get() for n in ("concentration", "redness")
    ]
    assert primvars == ["melanin", "redness"]
    assert all(UsdGeom.PrimvarsAPI(prim).GetPrimvar(name).HasAuthoredValue() for name in primvars)
    preview = upstream(material.GetSurfaceOutput())
    assert preview.GetShaderId() == "UsdPreviewSurface"
    assert inputs(upstream(inputs(preview)["diffuseColor"]))["varname"].Get() == "displayColor"


def test_dyed_hair_takes_its_display_color(folder):
    groom = read_groom(folder / "groom.usdc")
    hairs = hairs_of(groom)
    hairs.curve |= {"melanin": np.full(10, 0.5), "dye": np.tile([0.5, 0.1, 0.1], (10, 1)), "dye_amount": np.ones(10)}
    with HairWriter(folder / "dyed.usdc", groom, hairs, folder / "groom.usdc") as writer:
        writer.add(None, hairs.points)
    assert problems(folder / "dyed.usdc") == []
    material, _ = UsdShade.MaterialBindingAPI(prims(folder, "dyed.usdc")["hairs"]).ComputeBoundMaterial()
    bsdf = upstream(inputs(upstream(material.GetSurfaceOutput("mtlx")))["bsdf"])
    color = upstream(inputs(upstream(inputs(bsdf)["absorption_coefficient"]))["color"])
    assert inputs(upstream(inputs(upstream(inputs(color)["in1"]))["in1"]))["geomprop"].Get() == "displayColor"


def test_materialx_has_the_nodes_with_our_inputs_and_our_melanin(folder):
    materialx = pytest.importorskip("MaterialX")
    document = materialx.createDocument()
    materialx.loadLibraries(materialx.getDefaultDataLibraryFolders(), materialx.getDefaultDataSearchPath(), document)
    types = {"float": "float", "float2": "vector2", "float3": "vector3", "color3f": "color3", "string": "string"}
    stage = Usd.Stage.Open(str(folder / "hair.usdc"))
    shaders = [UsdShade.Shader(p) for p in stage.Traverse() if UsdShade.Shader(p)]
    nodes = [shader for shader in shaders if shader.GetShaderId().startswith("ND_")]
    assert len(nodes) == 6
    for shader in nodes:
        definition = document.getNodeDef(shader.GetShaderId())
        assert definition is not None, shader.GetShaderId()
        for name, one in inputs(shader).items():
            expected = definition.getActiveInput(name)
            assert expected is not None, (shader.GetShaderId(), name)
            kind = "BSDF" if name == "bsdf" else types[str(one.GetTypeName())]
            assert expected.getType() == kind, (shader.GetShaderId(), name)
        outputs = {out.getName() for out in definition.getActiveOutputs()}
        assert {out.GetBaseName() for out in shader.GetOutputs()} <= outputs
    melanin = document.getNodeDef("ND_deon_hair_absorption_from_melanin")
    eumelanin = -np.log(np.array(melanin.getActiveInput("eumelanin_color").getValue().asTuple()))
    brown = HAIR_COLORS["brown"]
    np.testing.assert_allclose(-np.log1p(-brown.melanin) * eumelanin, absorption(brown.melanin, 0.0), rtol=1e-3)


def test_the_validator_of_nvidia_finds_no_failure(folder):
    if importlib.util.find_spec("usd_validation_nvidia") is None:
        pytest.skip("usd-validation-nvidia is not installed")
    from usd_validation_nvidia import ValidationEngine

    for name in ("groom.usdc", "cache.usdc", "hair.usdc"):
        issues = ValidationEngine().validate(str(folder / name)).issues()
        bad = [f"{issue.severity.name} {issue.message} {issue.at}" for issue in issues if issue.severity]
        bad = [line for line in bad if not line.startswith("WARNING") and not any(word in line for word in KNOWN)]
        assert bad == [], name
