"""The material of hairs: Chiang's hair BSDF in MaterialX, and a UsdPreviewSurface for viewports that know no hair.

Both read the primvars of the hairs: melanin and redness, or ``displayColor`` where hair is dyed. Node definitions are
those of MaterialX 1.39, ``pbrlib``.
"""

from __future__ import annotations

from typing import Any

from pxr import Gf, Sdf, Usd, UsdGeom, UsdShade

from ringlet.data.curves import Curves
from ringlet.data.pigment import (
    AZIMUTHAL_ROUGHNESS,
    DEFAULT_COLOR,
    DYE,
    DYE_AMOUNT,
    HAIR_COLORS,
    MELANIN,
    REDNESS,
    ROUGHNESS,
    SURFACE,
    TILT,
    of_fiber,
)
from ringlet.io.usd.values import Types

SCOPE = "materials"
HAIR_BSDF, OWN_MATERIAL = "ND_chiang_hair_bsdf", "the hair material"  # its shader; its name in a scene
IOR = 1.55
CONTEXT = "mtlx"  # render context of MaterialX


def bind_hair_material(prim: Usd.Prim, values: Curves, stage: Usd.Stage | None = None) -> UsdShade.Material:
    """Defines the material of hairs under the root of their prim, and binds it to the prim.

    values: the hairs with their attributes; those without melanin get the usual colour
    stage:  where to define it; by default that of the prim, whose edit target may be a variant of the prim alone
    """
    root = prim.GetPath().GetPrefixes()[0]
    scope = UsdGeom.Scope.Define(stage or prim.GetStage(), root.AppendChild(SCOPE))
    path = scope.GetPath().AppendChild(prim.GetName())
    material = UsdShade.Material.Define(stage or prim.GetStage(), path)
    material.CreateSurfaceOutput(CONTEXT).ConnectToSource(_hair(material, values))
    material.CreateSurfaceOutput().ConnectToSource(_preview(material))
    UsdShade.MaterialBindingAPI.Apply(prim).Bind(material)
    return material


def _hair(material: UsdShade.Material, values: Curves) -> UsdShade.Output:
    """Chiang's BSDF with the absorption of the hair's pigments, as a surface shader."""
    around, usual = of_fiber(values, AZIMUTHAL_ROUGHNESS), HAIR_COLORS[DEFAULT_COLOR]
    if DYE in values.curve and {DYE_AMOUNT} & (values.curve.keys() | values.point.keys()):
        absorption = _absorption_of_color(material, around)
    else:
        pigments = {
            "melanin_concentration": _primvar(material, MELANIN, usual.melanin),
            "melanin_redness": _primvar(material, REDNESS, usual.redness),
        }
        kind = "deon_hair_absorption_from_melanin"
        absorption = _shader(material, "absorption", f"ND_{kind}", pigments, {"absorption": Types.Float3})
    lobes = ("R", "TT", "TRT")
    roughness = _shader(
        material,
        "roughness",
        "ND_chiang_hair_roughness",
        {"longitudinal": of_fiber(values, ROUGHNESS), "azimuthal": around},
        {f"roughness_{lobe}": Types.Float2 for lobe in lobes},
    )
    bsdf = _shader(
        material,
        "bsdf",
        HAIR_BSDF,
        {
            "ior": IOR,
            "cuticle_angle": 0.5 + of_fiber(values, TILT) / 180.0,  # 0 to 1 is -90° to 90°
            **{f"roughness_{lobe}": roughness.GetOutput(f"roughness_{lobe}") for lobe in lobes},
            "absorption_coefficient": absorption.GetOutput("absorption"),
        },
        {"out": Types.Token},
    )
    surface = _shader(material, "surface", "ND_surface", {"bsdf": bsdf.GetOutput("out")}, {"out": Types.Token})
    return surface.GetOutput("out")


def _absorption_of_color(material: UsdShade.Material, roughness: float) -> UsdShade.Shader:
    """The absorption at which dense hair has its ``displayColor``, less what the surfaces of fibres reflect."""
    color = _shader(
        material,
        "color",
        "ND_geompropvalue_color3",
        {"geomprop": "displayColor", "default": Gf.Vec3f(*HAIR_COLORS[DEFAULT_COLOR].reflectance.tolist())},
        {"out": Types.Color3f},
    )
    inner = _shader(
        material,
        "less_surface",
        "ND_subtract_color3FA",
        {"in1": color.GetOutput("out"), "in2": SURFACE},
        {"out": Types.Color3f},
    )
    scaled = _shader(
        material,
        "transmitted",
        "ND_divide_color3FA",
        {"in1": inner.GetOutput("out"), "in2": 1.0 - SURFACE},
        {"out": Types.Color3f},
    )
    return _shader(
        material,
        "absorption",
        "ND_chiang_hair_absorption_from_color",
        {"color": scaled.GetOutput("out"), "azimuthal_roughness": roughness},
        {"absorption": Types.Float3},
    )


def _preview(material: UsdShade.Material) -> UsdShade.Output:
    """A matte surface in ``displayColor``."""
    reader = _shader(
        material,
        "preview_color",
        "UsdPrimvarReader_float3",
        {"varname": "displayColor", "fallback": Gf.Vec3f(*HAIR_COLORS[DEFAULT_COLOR].reflectance.tolist())},
        {"result": Types.Float3},
    )
    preview = _shader(
        material,
        "preview",
        "UsdPreviewSurface",
        {"diffuseColor": reader.GetOutput("result"), "roughness": 0.6, "metallic": 0.0},
        {"surface": Types.Token},
    )
    return preview.GetOutput("surface")


def _primvar(material: UsdShade.Material, name: str, default: float) -> UsdShade.Output:
    node = _shader(
        material, name, "ND_geompropvalue_float", {"geomprop": name, "default": default}, {"out": Types.Float}
    )
    return node.GetOutput("out")


def _shader(
    material: UsdShade.Material, name: str, kind: str, inputs: dict[str, Any], outputs: dict[str, Sdf.ValueTypeName]
) -> UsdShade.Shader:
    """Defines a shader below a material; inputs are values, or outputs that they are connected to."""
    stage: Usd.Stage = material.GetPrim().GetStage()
    shader = UsdShade.Shader.Define(stage, material.GetPath().AppendChild(name))
    shader.CreateIdAttr(kind)
    for output, of in outputs.items():
        shader.CreateOutput(output, of)
    for key, value in inputs.items():
        if isinstance(value, UsdShade.Output):
            of = Types.Color3f if key == "diffuseColor" else value.GetTypeName()
            shader.CreateInput(key, of).ConnectToSource(value)
        else:
            shader.CreateInput(key, Types.Float3 if key == "fallback" else _type_of(value)).Set(value)
    return shader


def _type_of(value: Any) -> Sdf.ValueTypeName:
    return {str: Types.String, float: Types.Float, Gf.Vec3f: Types.Color3f}[type(value)]
