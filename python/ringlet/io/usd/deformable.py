"""Curves as elastic rods of the AOUSD proposal for deformable bodies, which simulators such as Newton import.

The schemas are no part of USD yet, so they are authored by name: https://github.com/PixarAnimationStudios/OpenUSD-proposals.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from pxr import Sdf, Usd, UsdGeom, UsdPhysics, UsdShade, Vt

from ringlet.data.curves import Curves
from ringlet.data.hair_scene import HairScene
from ringlet.data.stage import StageSpace
from ringlet.io.usd.groom import GROOM
from ringlet.io.usd.mesh import define_mesh
from ringlet.io.usd.names import identifier
from ringlet.io.usd.place import Place
from ringlet.io.usd.stage import new_stage, writing
from ringlet.io.usd.values import Types

ROOT_POINTS = 2  # fixed points of each curve: the first, and the second for its direction


@dataclass(frozen=True)
class Rod:
    """Material of an elastic rod of round section.

    radius:  [m]
    density: mass per volume [kg/m³]
    stretch, bend, twist: stiffnesses E A [N], E I [N m²] and G J [N m²]
    """

    radius: float
    density: float
    stretch: float
    bend: float
    twist: float


def write_deformable_scene(scene: HairScene, rod: Rod, path: Path, space: StageSpace) -> None:
    """Writes curves at rest as rods that are fixed at their roots, and surfaces as colliders, below ``/groom``."""
    with writing(path) as aside:
        stage = new_stage(aside, space)
        UsdPhysics.SetStageKilogramsPerUnit(stage, 1.0)
        UsdGeom.Xform.Define(stage, GROOM)
        material = _define_material(stage, f"{GROOM}/materials/rod", rod, space.meters_per_unit)
        taken, rods = ["materials"], list[tuple[Usd.Prim, Curves]]()
        for one in scene.sets:
            taken.append(identifier(one.name, taken))
            prim = _define_rods(stage, f"{GROOM}/{taken[-1]}", one.curves, rod, material, space, path)
            rods.append((prim, one.curves))
        for prim, curves in rods:  # after all names that are of the scene
            taken.append(identifier(f"{prim.GetName()}_roots", taken))
            _fix_roots(stage, f"{GROOM}/{taken[-1]}", prim, curves)
        for mesh, _ in scene.bodies:
            taken.append(identifier(mesh.name.split("/")[-1].split(" ")[-1], taken))
            prim = define_mesh(stage, f"{GROOM}/{taken[-1]}", mesh, space, path)
            UsdPhysics.CollisionAPI.Apply(prim)
            UsdPhysics.MeshCollisionAPI.Apply(prim).CreateApproximationAttr(UsdPhysics.Tokens.none)
        stage.Save()


def _define_material(stage: Usd.Stage, path: str, rod: Rod, unit: float) -> UsdShade.Material:
    """The material in kilograms, seconds and the unit of the stage."""
    UsdGeom.Scope.Define(stage, str(Sdf.Path(path).GetParentPath()))
    material = UsdShade.Material.Define(stage, path)
    UsdPhysics.MaterialAPI.Apply(material.GetPrim()).CreateDensityAttr(rod.density * unit**3)
    material.GetPrim().AddAppliedSchema("PhysicsCurvesDeformableMaterialAPI")
    values = {
        "curvesStretchStiffness": rod.stretch / unit,
        "curvesShearStiffness": rod.stretch / unit,  # rods of Ringlet have no shear: as stiff as stretch
        "curvesBendStiffness": rod.bend / unit**3,
        "curvesTwistStiffness": rod.twist / unit**3,
    }
    for name, value in values.items():
        _set(material.GetPrim(), name, Types.Float, value)
    return material


def _define_rods(
    stage: Usd.Stage, path: str, curves: Curves, rod: Rod, material: UsdShade.Material, space: StageSpace, file: Path
) -> Usd.Prim:
    defined = UsdGeom.BasisCurves.Define(stage, path)
    defined.CreateTypeAttr(UsdGeom.Tokens.linear)
    defined.CreateWrapAttr(UsdGeom.Tokens.nonperiodic)
    defined.CreateCurveVertexCountsAttr(Vt.IntArray.FromNumpy(curves.counts))
    diameter = 2.0 * rod.radius / space.meters_per_unit
    defined.CreateWidthsAttr([diameter])
    defined.SetWidthsInterpolation(UsdGeom.Tokens.constant)
    prim = defined.GetPrim()
    place = Place(prim, space, file, curves)
    points = place.local(curves.points, Usd.TimeCode.Default())
    defined.CreatePointsAttr(points)
    defined.CreateExtentAttr(UsdGeom.Boundable.ComputeExtentFromPlugins(defined, Usd.TimeCode.Default()))

    prim.AddAppliedSchema("PhysicsDeformableBodyAPI")
    prim.AddAppliedSchema("PhysicsCurvesDeformableSimAPI")
    UsdPhysics.CollisionAPI.Apply(prim)
    _set(prim, "restShapePoints", Types.Point3fArray, points)
    _set(prim, "thicknesses", Types.FloatArray, [diameter])
    _set(prim, "thicknesses:elementType", Types.Token, "constant")
    UsdShade.MaterialBindingAPI.Apply(prim).Bind(material, materialPurpose="physics")
    return prim


def _fix_roots(stage: Usd.Stage, path: str, prim: Usd.Prim, curves: Curves) -> None:
    """Fixes the first points of each curve to the transform of the groom, in whose frame their places are."""
    points = UsdGeom.PointBased(prim).GetPointsAttr().Get()
    rows = (curves.offsets[:-1, None] + np.arange(ROOT_POINTS)).ravel()
    to_groom = UsdGeom.XformCache().ComputeRelativeTransform(prim, prim.GetParent())[0]
    fixed = stage.DefinePrim(path, "PhysicsAttachment")
    fixed.CreateRelationship("physics:src0").SetTargets([prim.GetPath()])
    fixed.CreateRelationship("physics:src1").SetTargets([prim.GetParent().GetPath()])
    _set(fixed, "type0", Types.Token, "point")
    _set(fixed, "type1", Types.Token, "xform")
    _set(fixed, "indices0", Types.IntArray, Vt.IntArray.FromNumpy(rows.astype(np.int32)))
    places: NDArray = np.array([to_groom.Transform(points[int(row)]) for row in rows], np.float32)
    _set(fixed, "coords1", Types.Point3fArray, Vt.Vec3fArray.FromNumpy(places))


def _set(prim: Usd.Prim, name: str, kind: Sdf.ValueTypeName, value: object) -> None:
    prim.CreateAttribute(f"physics:{name}", kind).Set(value)
