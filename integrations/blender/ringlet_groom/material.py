"""The hair material for Cycles: the Principled Hair BSDF of Chiang with the pigments of the recipe."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

import bpy
import numpy as np

# Absorption of the pigments at a concentration of 1, as Ringlet and as Cycles have it. Both are proportional in red,
# green and blue, so that one concentration becomes another and the color stays (d'Eon et al. 2011).
EUMELANIN = 0.419 / 0.506
PHEOMELANIN = 0.187 / 0.343
MOST = 1.0 - 1e-4  # melanin of Cycles
NAME = "Ringlet hair"


def cycles_melanin(melanin: np.ndarray, redness: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Melanin and redness of Cycles at which hair absorbs what Ringlet's melanin and redness say, same shape."""
    amount = -np.log1p(-np.minimum(np.asarray(melanin, np.float64), 0.9999))
    red = np.asarray(redness, np.float64)
    dark, reddish = EUMELANIN * amount * (1.0 - red), PHEOMELANIN * amount * red
    total = dark + reddish
    share = np.divide(reddish, total, out=np.zeros_like(total), where=total > 0)
    return np.minimum(-np.expm1(-total), MOST).astype(np.float32), share.astype(np.float32)


def with_pigments(arrays: Mapping[str, np.ndarray]) -> dict[str, np.ndarray]:
    """Arrays of curves whose ``melanin`` and ``redness`` are those of Cycles."""
    found = dict(arrays)
    if "melanin" in found:
        melanin = found["melanin"]
        redness = found.get("redness", np.zeros_like(melanin))
        if len(redness) != len(melanin):  # one of the curves, the other of their points
            counts = found["counts"]
            melanin, redness = (
                np.repeat(values, counts) if len(values) == len(counts) else values for values in (melanin, redness)
            )
        found["melanin"], found["redness"] = cycles_melanin(melanin, redness)
    return found


def viewport_color(arrays: Mapping[str, np.ndarray], fiber: Mapping[str, float], *, dyed: bool) -> np.ndarray:
    """Mean color of hairs, linear, shape (3,): of their dye, or of the absorption of their pigments (Chiang et al.
    2016)."""
    if dyed and "color" in arrays:
        return arrays["color"].mean(axis=0)
    melanin, redness = (float(np.mean(arrays.get(name, fiber[name]))) for name in ("melanin", "redness"))
    melanin, redness = (float(values) for values in cycles_melanin(np.array(melanin), np.array(redness)))
    rough = fiber["azimuthal_roughness"]
    falloff = 5.969 - 0.215 * rough + 2.532 * rough**2 - 10.73 * rough**3 + 5.574 * rough**4 + 0.245 * rough**5
    amount = -math.log1p(-melanin)
    absorption = amount * (
        (1.0 - redness) * np.array([0.506, 0.841, 1.653]) + redness * np.array([0.343, 0.733, 1.924])
    )
    return np.exp(-falloff * np.sqrt(absorption))


def is_ours(material: bpy.types.Material) -> bool:
    """Whether a material has Ringlet's hair node."""
    return material.node_tree is not None and NAME in material.node_tree.nodes


def hair_material(
    material: bpy.types.Material, fiber: Mapping[str, float], color: np.ndarray, *, pigments: bool, dyed: bool
) -> None:
    """Updates a material. Users may change it; Ringlet changes its hair node and its color in the viewport.

    color:    in the viewport, linear, shape (3,)
    pigments: whether the hairs have attributes of their pigments; a usual brown otherwise
    dyed:     whether their ``color`` counts instead
    """
    if material.node_tree is None:  # before Blender 5
        material.use_nodes = True
    material.diffuse_color = (*color.tolist(), 1.0)
    nodes = material.node_tree.nodes
    hair = nodes.get(NAME) or _new_hair(material)
    hair.parametrization = "MELANIN"  # Blender 5 has no inputs by name but those of the parametrization
    melanin, redness = cycles_melanin(np.array(fiber["melanin"]), np.array(fiber["redness"]))
    values: dict[str, Any] = {
        "Roughness": fiber["roughness"],
        "Radial Roughness": fiber["azimuthal_roughness"],
        "Offset": math.radians(fiber["tilt"]),
        "Random Roughness": 0.0,
        "Random Color": 0.0,
        "Melanin": float(melanin),
        "Melanin Redness": float(redness),
    }
    for key, value in values.items():
        hair.inputs[key].default_value = value
    if dyed:
        hair.parametrization = "COLOR"
    for attribute, key, wanted in (
        ("melanin", "Melanin", pigments and not dyed),
        ("redness", "Melanin Redness", pigments and not dyed),
        ("color", "Color", dyed),
    ):
        _connect(material, hair, attribute, key, wanted)


def _new_hair(material: bpy.types.Material) -> bpy.types.Node:
    tree = material.node_tree
    tree.nodes.clear()
    output = tree.nodes.new("ShaderNodeOutputMaterial")
    hair = tree.nodes.new("ShaderNodeBsdfHairPrincipled")
    hair.name = hair.label = NAME
    hair.model = "CHIANG"
    output.location, hair.location = (300, 0), (0, 0)
    tree.links.new(hair.outputs[0], output.inputs["Surface"])
    return hair


def _connect(material: bpy.types.Material, hair: bpy.types.Node, attribute: str, key: str, wanted: bool) -> None:
    """Connects an attribute of the curves to an input, or takes the connection away."""
    tree, name = material.node_tree, f"Ringlet {attribute}"
    reader = tree.nodes.get(name)
    if not wanted:
        if reader is not None:
            tree.nodes.remove(reader)
        return
    if reader is None:
        reader = tree.nodes.new("ShaderNodeAttribute")
        reader.name, reader.attribute_name = name, attribute
        reader.location = (-300, -200 * len(tree.nodes))
    tree.links.new(reader.outputs["Color" if key == "Color" else "Fac"], hair.inputs[key])
