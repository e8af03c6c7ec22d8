"""A groom as USD: its guides and locks, and a reference to the head.

- /groom: Xform, with the recipe
- /groom/locks: BasisCurves, one per lock, in the rest pose
- /groom/guides: BasisCurves, the guides
- /groom/accessories: what the hair wears, such as bands and beads: meshes with ``ringlet:vertices``, the points of
  /groom/locks that carry them rigidly
- /groom/body: the head, a reference to its file, or the mesh itself without a file

With variants, locks and guides are in the variants of the set ``groom``.
"""

from __future__ import annotations

import json
import re
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
from pxr import Sdf, Usd, UsdGeom, Vt

from ringlet.data.accessory import Accessory
from ringlet.data.binding import check_roots, root_places
from ringlet.data.curves import Curves
from ringlet.data.errors import UserError
from ringlet.data.former_names import present
from ringlet.data.groom import GROOM as ROW
from ringlet.data.groom import Groom
from ringlet.data.mesh import Mesh
from ringlet.data.reads import recorded, unrecorded
from ringlet.data.settings import did_you_mean
from ringlet.data.stage import StageSpace
from ringlet.io.usd.curves import define_curves, own_curves, set_display_color, set_points, set_rest, set_roots
from ringlet.io.usd.damage import check_bytes
from ringlet.io.usd.mesh import define_mesh, mesh_at, read_usd_mesh, select_mesh
from ringlet.io.usd.model import GROOM_API, WORN_API, make_model, set_extents_hint
from ringlet.io.usd.names import identifier
from ringlet.io.usd.offsets import NAME as OFFSETS_NAME
from ringlet.io.usd.offsets import define_offsets, offsets_at
from ringlet.io.usd.place import Place, rounded
from ringlet.io.usd.stage import (
    CAGE,
    LIMIT,
    SUFFIXES,
    Source,
    new_stage,
    parse_json,
    prims,
    read_usd_space,
    reading,
    relative,
    writing,
)
from ringlet.io.usd.values import Types, read_time

GROOM, LOCKS, GUIDES, BODY = "/groom", "/groom/locks", "/groom/guides", "/groom/body"
ACCESSORIES = "/groom/accessories"
OF_EACH = {"region", "edge", "hairs", "color", "fiber", "absent"}  # settings of one of several grooms
VARIANTS, BASE = "groom", "base"
VERSION, SEVERAL = 1, 2  # versions of this layout, with one groom and with several
REMEDY = "make the groom again, or bind it anew: ringlet sim SHOT --rebind"
WEIGHT_TOLERANCE = 1e-3  # largest error of a root's barycentric coordinates


@recorded()
def write_groom(groom: Groom, path: Path | str, variants: Mapping[str, Groom] | None = None) -> None:
    """Writes a groom in the unit, up-axis and rate of its head, with a relative reference to the head.

    variants: grooms on the same head by name, as a variant set of ``/groom``; ``groom`` is the selection ``base``

    Raises UserError for a variant on another head, and for a path that is a file of the head.
    """
    head = _head_file(groom)
    space = read_usd_space(head) if head else groom.space
    with writing(path) as aside:
        stage = new_stage(aside, space)
        root = UsdGeom.Xform.Define(stage, GROOM).GetPrim()
        root.AddAppliedSchema(GROOM_API)
        several = any(made.grooms for made in (groom, *(variants or {}).values()))
        _set(root, "version", Types.Int, SEVERAL if several else VERSION)
        _set(root, "surface", Types.Token, CAGE if groom.cage else LIMIT)
        if groom.region is not None:
            _set(root, "region", Types.String, groom.region)
        scalp = (
            _reference(stage, head, groom.scalp_prim)
            if head
            else define_mesh(stage, BODY, groom.scalp, space, path).GetPath()
        )
        root.CreateRelationship("ringlet:scalp", custom=True).SetTargets([scalp])
        if not variants:
            _define(stage, groom, space, path)
        else:
            choice = root.GetVariantSets().AddVariantSet(VARIANTS)
            for name, variant in ((BASE, groom), *variants.items()):
                _check_variant(name, variant, groom)
                choice.AddVariant(name)
                choice.SetVariantSelection(name)
                with choice.GetVariantEditContext():
                    _define(stage, variant, space, path)
            choice.SetVariantSelection(BASE)
        make_model(root, groom.recipe)
        set_extents_hint(root)
        stage.Save()


def as_written(groom: Groom) -> Groom:
    """The groom after a round trip through its file, bit for bit, so that its simulations are the same.

    The file stores points and widths in single precision, in the unit of the head. A head that is not USD is stored
    with the groom.
    """
    head, scalp = _head_file(groom), groom.scalp
    space = read_usd_space(head) if head else groom.space
    if head is None:
        scalp = replace(scalp, points=rounded(scalp.points, space))
    guides, locks = (_curves_written(curves, space) for curves in (groom.guides, groom.locks))
    return replace(groom, guides=guides, locks=locks, scalp=scalp)


def _curves_written(curves: Curves, space: StageSpace) -> Curves:
    written = curves.with_points(rounded(curves.points, space))
    if "width" in curves.point:
        widths = np.asarray(curves.point["width"] / space.meters_per_unit, np.float32)
        written.point = {**curves.point, "width": widths * np.float32(space.meters_per_unit)}
    return written


def _head_file(groom: Groom) -> Path | None:
    """USD file of the head that a groom file references; None when the groom file contains the head."""
    return groom.scalp_file if groom.scalp_file and groom.scalp_file.suffix in SUFFIXES else None


def _define(stage: Usd.Stage, groom: Groom, space: StageSpace, file: Path | str) -> None:
    """Writes the prims and attributes that differ between variants."""
    root = stage.GetPrimAtPath(GROOM)
    _set(root, "hairs", Types.String, json.dumps(groom.hairs))
    if groom.edge is not None:
        _set(root, "edge", Types.Double, groom.edge)
    for name, settings in (("color", groom.color), ("fiber", groom.fiber)):
        if settings is not None:
            _set(root, name, Types.String, json.dumps(settings))
    _hide(stage, groom)
    if groom.grooms:
        _set(root, "grooms", Types.String, json.dumps(groom.grooms))
    if groom.recipe is not None:
        _set(root, "recipe", Types.String, groom.recipe)
    _define_guides(stage, LOCKS, groom.locks, groom, space, file)
    _define_guides(stage, GUIDES, groom.guides, groom, space, file)
    if groom.offsets is not None:
        define_offsets(stage, f"{GROOM}/{OFFSETS_NAME}", groom.offsets)
    taken = list[str]()
    for accessory in groom.accessories:
        taken.append(identifier(accessory.mesh.name, taken))
        prim = define_mesh(stage, f"{ACCESSORIES}/{taken[-1]}", accessory.mesh, space, file)
        prim.AddAppliedSchema(WORN_API)
        _set(prim, "vertices", Types.IntArray, Vt.IntArray.FromNumpy(accessory.vertices.astype(np.int32)))


def _hide(stage: Usd.Stage, groom: Groom) -> None:
    """Makes the meshes of the head that hair replaces invisible."""
    if not groom.hidden:
        return
    _set(stage.GetPrimAtPath(GROOM), "hidden", Types.StringArray, groom.hidden)
    for path in map(Sdf.Path, groom.hidden):
        if prim := stage.GetPrimAtPath(path.ReplacePrefix(path.GetPrefixes()[0], BODY)):
            UsdGeom.Imageable(prim).CreateVisibilityAttr(UsdGeom.Tokens.invisible)


def _check_variant(name: str, variant: Groom, groom: Groom) -> None:
    if variant is not groom and name == BASE:
        raise UserError(f"variant '{name}': is what the groom itself is called in the file; choose another name")
    if not re.fullmatch(r"[\w-]+", name):
        raise UserError(f"variant '{name}': is no name for USD; use letters, digits, _ and - only")
    scalp, variant_scalp = ((g.scalp_file and g.scalp_file.resolve(), g.scalp_prim, g.region) for g in (groom, variant))
    if scalp != variant_scalp or not np.array_equal(groom.scalp.points, variant.scalp.points):
        raise UserError(f"variant '{name}': grows on another scalp ({variant.scalp.name}); must be {groom.scalp.name}")


def read_groom(path: Path | str, variant: str | None = None, *, bound: bool = True) -> Groom:
    """Reads a groom, or the groom under a cache or hairs, with the scalp from its file.

    variant: variant to read, instead of the selected one
    bound:   refuse roots that are not on the scalp

    Raises UserError for a file that is no groom, an unknown variant, and a head that is missing or has changed.
    """
    with reading(path) as source:
        groom_prim(source)
        if variant is not None:
            _select(source, variant)
        return groom_at(source, bound=bound)


def groom_at(source: Source, *, bound: bool = True) -> Groom:
    """The groom of an open stage; ``bound`` and errors as for ``read_groom``."""
    root = groom_prim(source)
    scalp_file, scalp_prim = scalp_source(source)
    scalp = read_usd_mesh(scalp_file, scalp_prim, source.cage)
    return Groom(
        guides=_curves(source, GUIDES, scalp if bound else None),
        locks=_curves(source, LOCKS, scalp if bound else None),
        scalp=scalp,
        scalp_file=scalp_file,
        scalp_prim=scalp_prim,
        region=_get(root, "region"),
        edge=_get(root, "edge"),
        hidden=list(_get(root, "hidden") or []),
        cage=source.cage,
        space=source.space,
        hairs=_settings(source, root, "hairs") or {},
        color=_settings(source, root, "color"),
        fiber=_settings(source, root, "fiber"),
        grooms=_grooms(source, root),
        recipe=_get(root, "recipe"),
        variant=root.GetVariantSets().GetVariantSet(VARIANTS).GetVariantSelection() or None,
        accessories=[accessory for _, accessory in read_accessories(source)],
        offsets=offsets_at(prim, source.where(prim)) if (prim := root.GetChild(OFFSETS_NAME)) else None,
    )


def read_accessories(source: Source) -> list[tuple[Usd.Prim, Accessory]]:
    """What the hair of a groom wears at rest, with the prims; raises UserError for carriers that are not there."""
    top = source.stage.GetPrimAtPath(ACCESSORIES)
    worn = [prim for prim in prims(top) if UsdGeom.Mesh(prim)] if top else []
    count = len(UsdGeom.PointBased(source.stage.GetPrimAtPath(LOCKS)).GetPointsAttr().Get() or ()) if worn else 0
    found = []
    for prim in worn:
        vertices = np.array(_get(prim, "vertices") or (), np.int64)
        if not len(vertices) or vertices.min() < 0 or vertices.max() >= count:
            raise UserError(
                f"{source.where(prim)}: ringlet:vertices must name points of {LOCKS}, which has {count}; {REMEDY}"
            )
        found.append((prim, Accessory(mesh_at(source, prim), vertices)))
    return found


def _settings(source: Source, root: Usd.Prim, name: str) -> dict[str, Any] | None:
    """Settings of a table that a recipe may lack, by their present names."""
    text = _get(root, name)
    if text is None:
        return None
    where = f"ringlet:{name}"
    return present({name: parse_json(source, text, where)}, f"{source.path}: {where}")[0][name]


def _grooms(source: Source, root: Usd.Prim) -> dict[str, dict[str, Any]]:
    """Settings of several grooms, by name; raises UserError for damaged ones."""
    grooms = parse_json(source, _get(root, "grooms") or "{}", "ringlet:grooms")
    if not isinstance(grooms, dict) or not all(
        isinstance(one, dict) and one.keys() >= OF_EACH for one in grooms.values()
    ):
        raise UserError(f"{source.path}: ringlet:grooms is damaged; make the groom again")
    grooms = present({"grooms": grooms}, f"{source.path}: ringlet:grooms")[0]["grooms"]
    for path in (LOCKS, GUIDES) if grooms else ():
        primvar = UsdGeom.PrimvarsAPI(source.stage.GetPrimAtPath(path)).GetPrimvar(f"ringlet:{ROW}")
        rows = primvar.Get() if primvar else None
        if rows is None or not len(rows) or min(rows) < 0 or max(rows) >= len(grooms) or list(rows) != sorted(rows):
            raise UserError(f"{source.path}: {path} does not give the groom of each curve; make the groom again")
    return grooms


def is_groom(path: Path | str) -> bool:
    """Whether a USD file is a groom of Ringlet's, or lies over one; does not count as reading it."""
    with unrecorded(), reading(path) as source:
        root = source.stage.GetPrimAtPath(GROOM)
        return bool(root) and _get(root, "version") is not None


def groom_prim(source: Source) -> Usd.Prim:
    """The prim ``/groom``; raises UserError for a stage that is no groom or has a later layout."""
    root = source.stage.GetPrimAtPath(GROOM)
    version = _get(root, "version") if root else None
    if version is None:
        raise UserError(
            f"{source.path}: is not a Ringlet groom; make one with: ringlet groom RECIPE.toml -o groom.usdc"
        )
    check_version(source, version, SEVERAL)
    for path in (LOCKS, GUIDES):
        if not source.stage.GetPrimAtPath(path):
            raise UserError(f"{source.path}: has no {path}; make the groom again")
    return root


def check_version(source: Source, version: Any, latest: int = VERSION) -> None:
    """Raises UserError for a layout later than ``latest``."""
    if not isinstance(version, int) or version > latest:
        raise UserError(f"{source.path}: has layout {version}; this Ringlet reads up to {latest}: update it")


def _select(source: Source, variant: str) -> None:
    """Selects a variant in the session layer; raises UserError for an unknown one."""
    choice = source.stage.GetPrimAtPath(GROOM).GetVariantSets().GetVariantSet(VARIANTS)
    names = choice.GetVariantNames()
    if variant not in names:
        hint = did_you_mean(variant, names) if names else "; it has none"
        raise UserError(f"{source.path}: has no variant '{variant}'{hint}")
    source.stage.SetEditTarget(source.stage.GetSessionLayer())
    choose_variant(source.stage, variant)


def choose_variant(stage: Usd.Stage, variant: str) -> None:
    """Selects a variant of the groom in the edit target."""
    stage.GetPrimAtPath(GROOM).GetVariantSets().GetVariantSet(VARIANTS).SetVariantSelection(variant)


def scalp_source(source: Source) -> tuple[Path, str]:
    """File of the scalp and its prim path there: the target of the reference on ``/groom/body``, or the groom itself.

    Raises UserError for a groom without a scalp.
    """
    relationship = source.stage.GetRelationshipAtPath(f"{GROOM}.ringlet:scalp")
    targets = relationship.GetTargets() if relationship else []
    if not targets:
        raise UserError(f"{source.path}: does not name its scalp (ringlet:scalp); make the groom again")
    for spec in source.stage.GetPrimAtPath(BODY).GetPrimStack():
        for reference in spec.referenceList.GetAddedOrExplicitItems():
            file = Path(spec.layer.ComputeAbsolutePath(reference.assetPath))
            root = reference.primPath or _default_prim(file)
            return file, str(targets[0].ReplacePrefix(BODY, root))
    return Path(source.stage.GetRootLayer().realPath), str(targets[0])


def _reference(stage: Usd.Stage, head: Path, scalp: str | None) -> Sdf.Path:
    """References the head under ``/groom/body`` with its animation; returns the path of the scalp."""
    with reading(head) as source:
        prim = select_mesh(source, scalp).GetPath()
        top = prim.GetPrefixes()[0]
        default = source.stage.GetDefaultPrim()
        whole = bool(default) and default.GetPath() == top
        if source.stage.HasAuthoredTimeCodeRange():
            stage.SetStartTimeCode(source.stage.GetStartTimeCode())
            stage.SetEndTimeCode(source.stage.GetEndTimeCode())
    body = stage.DefinePrim(BODY)
    name = relative(head, stage.GetRootLayer().realPath)
    body.GetReferences().AddReference(Sdf.Reference(name) if whole else Sdf.Reference(name, top))
    scalp_path = prim.ReplacePrefix(top, BODY)
    _rest_of_skin(stage, scalp_path)
    return scalp_path


def _rest_of_skin(stage: Usd.Stage, scalp: Sdf.Path) -> None:
    """Writes the primvar ``rest`` of the skin, over the head; not where the head has one, or is instanced."""
    prim = stage.GetPrimAtPath(scalp)
    if not prim or prim.IsInstanceProxy() or UsdGeom.PrimvarsAPI(prim).HasPrimvar("rest"):
        return
    points = UsdGeom.PointBased(prim).GetPointsAttr()
    value = points.Get(read_time(Usd.TimeCode.Default(), points))
    if value:
        set_rest(UsdGeom.PointBased(stage.OverridePrim(scalp)), value)


def _define_guides(
    stage: Usd.Stage, path: str, curves: Curves, groom: Groom, space: StageSpace, file: Path | str
) -> None:
    """Writes locks or guides with the primvars that other programs need."""
    defined = define_curves(stage, path, curves, space, guide=True)
    prim = defined.GetPrim()
    place = Place(prim, space, file, curves)
    set_rest(defined, set_points(defined, curves.points, place, Usd.TimeCode.Default(), groom.scalp.points))
    set_roots(prim, curves, groom.scalp)
    set_display_color(prim, curves)


def _curves(source: Source, path: str, scalp: Mesh | None) -> Curves:
    """Reads locks or guides; raises UserError when a root is not on the scalp, if one is given."""
    curves = own_curves(source, source.stage.GetPrimAtPath(path)).check(f"{source.path} {path}")
    if scalp is not None:
        _check_bound(source, path, curves, scalp)
    return curves


def _check_bound(source: Source, path: str, curves: Curves, scalp: Mesh) -> None:
    """Raises UserError when a root is on no triangle of the scalp, beside its triangle, or off the scalp."""
    triangles = curves.curve.get("root_triangle", np.zeros(1))
    if (bad := np.flatnonzero((triangles < 0) | (triangles >= len(scalp.triangles)))).size:
        raise UserError(
            f"{source.path}: {path} has a root on triangle {triangles[bad[0]]}, but {scalp.name} has "
            f"{len(scalp.triangles)}; the head has changed: {REMEDY}"
        )
    weights = np.asarray(curves.curve.get("root_barycentric", np.full((1, 3), 1 / 3)))
    error = np.abs(weights - weights.clip(0.0, 1.0)).max(axis=1) + np.abs(weights.sum(axis=1) - 1.0)
    if (bad := np.flatnonzero(~(error <= WEIGHT_TOLERANCE))).size:  # also true for NaN
        raise UserError(
            f"{source.path}: {path} has the root of lock {curves.ids[bad[0]]} beside its triangle of {scalp.name} "
            f"(weights {', '.join(f'{w:g}' for w in weights[bad[0]])}): it is not on the scalp; make the groom again"
        )
    has_places = {"root_triangle", "root_barycentric"} <= curves.curve.keys()
    if path == LOCKS and has_places:  # drawn guides may begin near the scalp
        places = root_places(curves, scalp.points, scalp.triangles)
        check_roots(curves.roots, places, curves.ids, f"{source.path} on {scalp.name}", REMEDY)


def _default_prim(file: Path) -> Sdf.Path:
    check_bytes(file)
    layer = Sdf.Layer.FindOrOpen(str(file)) if file.exists() else None
    return Sdf.Path(f"/{layer.defaultPrim}") if layer and layer.defaultPrim else Sdf.Path.absoluteRootPath


def _set(prim: Usd.Prim, name: str, kind: Sdf.ValueTypeName, value: Any) -> None:
    prim.CreateAttribute(f"ringlet:{name}", kind, custom=True, variability=Sdf.VariabilityUniform).Set(value)


def _get(prim: Usd.Prim, name: str) -> Any:
    attribute = prim.GetAttribute(f"ringlet:{name}")
    return attribute.Get() if attribute else None
