"""Surfaces of a stage: which prims are visible surfaces, and which visible geometry is none."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator

from pxr import Usd, UsdGeom

from ringlet.io.usd.refinement import unrefined
from ringlet.io.usd.stage import Source, prims

SHOWN = (UsdGeom.Tokens.default_, UsdGeom.Tokens.render)
CURVES = (UsdGeom.Curves, UsdGeom.Points)  # geometry without a surface that hair could lie on


def is_surface(prim: Usd.Prim) -> bool:
    """Whether a prim is a mesh, or instances of meshes."""
    return bool(UsdGeom.Mesh(prim) or UsdGeom.PointInstancer(prim))


def is_empty(prim: Usd.Prim) -> bool:
    """Whether a mesh has no faces, an instancer no instances, or a prim of curves no curves: it shows nothing."""
    mesh, instancer, curves = UsdGeom.Mesh(prim), UsdGeom.PointInstancer(prim), UsdGeom.Curves(prim)
    if mesh:
        listed = mesh.GetFaceVertexCountsAttr()
    else:
        listed = instancer.GetProtoIndicesAttr() if instancer else curves.GetCurveVertexCountsAttr()
    return not any(listed.Get(time) for time in (Usd.TimeCode.Default(), *listed.GetTimeSamples()))


def filled(prims: Iterable[Usd.Prim]) -> list[Usd.Prim]:
    """The prims that are not empty; where all of them are, they stay, and whoever reads one refuses it."""
    every = list(prims)
    return [prim for prim in every if not is_empty(prim)] or every


def is_shown(prim: Usd.Prim) -> bool:
    """Whether a prim is visible in a render."""
    imageable = UsdGeom.Imageable(prim)
    return (
        imageable.ComputePurpose() in SHOWN
        and imageable.ComputeVisibility(Usd.TimeCode.EarliestTime()) != UsdGeom.Tokens.invisible
    )


def _is_shown_at_times(prim: Usd.Prim) -> bool:
    """Whether the visibility of a prim, or of one above it, changes over time."""
    above = (UsdGeom.Imageable(prim.GetStage().GetPrimAtPath(path)) for path in prim.GetPath().GetPrefixes())
    return any(one and one.GetVisibilityAttr().ValueMightBeTimeVarying() for one in above)


def shown_root(source: Source) -> Usd.Prim:
    """The prim whose surfaces a render shows where a file is referenced: the default prim, or else the root."""
    return source.stage.GetDefaultPrim() or source.stage.GetPseudoRoot()


def shown_surfaces(source: Source) -> list[Usd.Prim]:
    """Surfaces that are visible in a render, under the default prim."""
    return [prim for prim in prims(shown_root(source)) if is_surface(prim) and is_shown(prim) and not is_empty(prim)]


def passed_over(source: Source, root: Usd.Prim | None = None, named: Collection[str] = ()) -> Iterator[str]:
    """A sentence for each visible prim with a surface that is not read, or not as a render shows it.

    root:  prim whose surfaces are read; by default the default prim, for which those outside it are reported as well
    named: paths of prims that are read by name
    """
    default = shown_root(source).GetPath()
    for prim in prims(root or source.stage.GetPseudoRoot()):
        if any(prim.GetPath().HasPrefix(path) for path in named):
            continue
        if not (UsdGeom.Gprim(prim) or is_surface(prim)) or any(kind(prim) for kind in CURVES):
            continue
        if _is_shown_at_times(prim):
            as_at_first = "is touched all the time" if is_shown(prim) else "is never touched"
            yield f"{source.where(prim)}: its visibility changes over time; it {as_at_first}, as at its first sample"
        if not is_shown(prim):
            continue
        if note := unrefined(source, prim):
            yield note
        if not is_surface(prim):
            yield f"{source.where(prim)}: is a {prim.GetTypeName()}, which hair does not touch; convert it to a Mesh"
        elif root is None and not prim.GetPath().HasPrefix(default):
            yield f"{source.where(prim)}: is outside of the default prim {default}; name it as a collider to touch it"
