"""Deformation of meshes by skeletons and blend shapes, evaluated at any time code."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from pxr import Sdf, Usd, UsdSkel, Vt

from ringlet.data.errors import UserError
from ringlet.io.usd.values import float3


class Skinning:
    """The skeletons of a stage, with the meshes that are bound to them."""

    def __init__(self, stage: Usd.Stage) -> None:
        self._cache = UsdSkel.Cache()
        self._deformers: dict[Sdf.Path, Deformer | None] = {}
        everything = Usd.TraverseInstanceProxies()
        for prim in Usd.PrimRange(stage.GetPseudoRoot(), everything):
            if root := UsdSkel.Root(prim):
                self._cache.Populate(root, everything)

    def deformer(self, prim: Usd.Prim) -> Deformer | None:
        """What deforms a prim; None for a prim without skeleton."""
        path = prim.GetPath()
        if path not in self._deformers:
            self._deformers[path] = self._find(prim)
        return self._deformers[path]

    def _find(self, prim: Usd.Prim) -> Deformer | None:
        query = self._cache.GetSkinningQuery(prim)
        if not query:
            return None
        skeleton = self._cache.GetSkelQuery(UsdSkel.BindingAPI(prim).GetInheritedSkeleton())
        return Deformer(query, skeleton) if skeleton else None


@dataclass(frozen=True)
class Deformer:
    """Blend shapes and joints of one mesh; linear blend or dual quaternion skinning, as the mesh names it."""

    query: UsdSkel.SkinningQuery
    skeleton: UsdSkel.SkeletonQuery

    @property
    def samples(self) -> list[float]:
        """Time samples of the animation."""
        animation, samples = self.skeleton.GetAnimQuery(), list[float]()
        if animation and self.query.HasJointInfluences():
            samples += animation.GetJointTransformTimeSamples()
        if animation and self.query.HasBlendShapes():
            samples += animation.GetBlendShapeWeightTimeSamples()
        return samples

    def deform(
        self, points: NDArray[np.float64], time: Usd.TimeCode, where: str
    ) -> tuple[NDArray[np.float64], Usd.Prim]:
        """Deforms points of the mesh, shape (n, 3); returns them with the prim in whose local space they are.

        Points without a pose at that time stay as they are: those of an animation in samples alone, at rest. Raises
        UserError for joints that do not fit the mesh, and for a skeleton without pose.
        """
        if time.IsDefault() and self.samples and not self._has_default():
            return points, self.query.GetPrim()
        deformed = float3(points)
        if self.query.HasBlendShapes():
            self._apply_blend_shapes(deformed, time)
        if not self._is_bound_to_joints(where):
            return np.array(deformed, np.float64), self.query.GetPrim()
        transforms = self.skeleton.ComputeSkinningTransforms(time) if self.skeleton.HasBindPose() else None
        if not transforms:
            raise UserError(
                f"{where}: its skeleton {self.skeleton.GetPrim().GetPath()} has no bind pose, which needs a transform "
                "for each joint; export it again"
            )
        if not self.query.ComputeSkinnedPoints(transforms, deformed, time):
            raise UserError(f"{where}: its joints and weights do not fit its points or its skeleton; bind it again")
        return np.array(deformed, np.float64), self.skeleton.GetPrim()

    def _is_bound_to_joints(self, where: str) -> bool:
        indices = UsdSkel.BindingAPI(self.query.GetPrim()).GetJointIndicesPrimvar()
        if indices and indices.HasAuthoredValue() and not self.query.HasJointInfluences():
            raise UserError(f"{where}: its joints and weights do not fit each other; bind it again")
        return self.query.HasJointInfluences()

    def _has_default(self) -> bool:
        animation = UsdSkel.Animation(self.skeleton.GetAnimQuery().GetPrim())
        attributes = (
            animation.GetTranslationsAttr(),
            animation.GetRotationsAttr(),
            animation.GetScalesAttr(),
            animation.GetBlendShapeWeightsAttr(),
        )
        return all(a.Get() is not None for a in attributes if a.GetNumTimeSamples())

    def _apply_blend_shapes(self, points: Vt.Vec3fArray, time: Usd.TimeCode) -> None:
        animation = self.skeleton.GetAnimQuery()
        weights = animation.ComputeBlendShapeWeights(time) if animation else None
        if not weights:
            return
        shapes = UsdSkel.BlendShapeQuery(UsdSkel.BindingAPI(self.query.GetPrim()))
        if mapper := self.query.GetBlendShapeMapper():
            weights = mapper.Remap(weights)
        amounts, blend_shapes, sub_shapes = shapes.ComputeSubShapeWeights(weights)
        places, offsets = shapes.ComputeBlendShapePointIndices(), shapes.ComputeSubShapePointOffsets()
        shapes.ComputeDeformedPoints(amounts, blend_shapes, sub_shapes, places, offsets, points)
