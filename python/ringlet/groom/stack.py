"""A groom from its recipe: the stages, and what is added to their locks."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ringlet.data.curves import Curves, offsets_from_counts
from ringlet.data.errors import UserError
from ringlet.data.groom import ADOPTED, HAIR_SHARE, OFFSETS, Groom, HairOffsets
from ringlet.data.mesh import Mesh
from ringlet.data.painted import painted
from ringlet.data.quantities import Varied
from ringlet.data.random import Random
from ringlet.data.stage import StageSpace
from ringlet.groom.color import colored
from ringlet.groom.conflicts import inward, not_strands, without_place
from ringlet.groom.edge import Edge, EdgeScalp
from ringlet.groom.folds import fold_warnings
from ringlet.groom.hair_measures import raise_density
from ringlet.groom.hair_settings import HairSettings
from ringlet.groom.operators import Context, Drawn
from ringlet.groom.pins import pinned
from ringlet.groom.plausibility import odd_sizes
from ringlet.groom.recipe import Recipe
from ringlet.groom.scalp import Scalp
from ringlet.groom.stages import Memory, Progress, Run, curling, key_of, sculpting, shaping
from ringlet.groom.worn import accessories, loaded


def make_groom(
    recipe: Recipe,
    scalp: Mesh,
    *,
    drawn_guides: Curves | None = None,
    helpers: Mapping[str, Curves] | None = None,
    hidden: Sequence[str] = (),
    meshes: Mapping[str, Mesh] | None = None,
    colliders: Sequence[Mesh] = (),
    offsets: HairOffsets | None = None,
    scalp_file: Path | None = None,
    scalp_prim: str | None = None,
    space: StageSpace | None = None,
    progress: Progress | None = None,
    memory: Memory | None = None,
) -> Groom:
    """Evaluates the operator stack of a recipe: guides, then one curled groom guide per lock.

    scalp:        the mesh in its rest pose [m]
    drawn_guides: the curves of ``[guides] file`` [m]
    helpers:      the curves of the files of ``[curves]``, by name [m]
    hidden:       paths of the meshes of the head's file that the hair replaces
    meshes:       the meshes of the files of ``[meshes]``, by name [m]
    colliders:    surfaces that locks stay out of besides the scalp, such as a shirt [m]
    offsets:      the hairs of ``[hairs] file``
    scalp_file, scalp_prim, space: source of the mesh, stored in the groom
    progress:     called with (stage, 0, 1) before and (stage, 1, 1) after every stage
    memory:       cache between calls, so that an edit recomputes only the stages from there on

    Raises UserError, with the name of the recipe, for settings that do not fit the mesh.
    """
    memory = memory or Memory()
    try:
        run = _begin(recipe, scalp, colliders, drawn_guides, helpers or {}, meshes or {}, memory, progress)
        adopted = OFFSETS in run.curves.curve
        unsculpted = run.through([("guides", recipe.guides)])
        guides = run.through(sculpting(recipe))
        run.shapes = run.through(shaping(recipe))
        before_contact = run.through(curling(recipe, adopted))
        curves = run.through([("collide", recipe.collide)])
        painted_on = run.scalp.mesh
        locks = _with_maps_of_hairs(pinned(curves, recipe.pin, painted_on, recipe.seed), recipe.hairs, painted_on)
        locks = colored(locks, recipe.color, recipe.fiber, painted_on)
        locks = loaded(run.worn, _with_mask_of_hairs(locks, recipe, painted_on))
    except UserError as error:
        where = recipe.path.name if recipe.path else "recipe"
        raise UserError(f"{where}: {error}", error.fixes) from error
    surface = run.scalp
    groom = Groom(
        guides=guides,
        locks=locks,
        scalp=scalp,
        scalp_file=scalp_file,
        scalp_prim=scalp_prim,
        region=recipe.scalp.region,
        edge=surface.length if isinstance(surface, EdgeScalp) else None,
        cage=recipe.scalp.surface == "cage",
        space=space or StageSpace(),
        hairs=recipe.hairs.model_dump(mode="json", exclude={k for k, v in recipe.hairs if v is None} - {"points"}),
        color=recipe.color and recipe.color.model_dump(mode="json"),
        fiber=recipe.fiber and recipe.fiber.model_dump(mode="json"),
        recipe=recipe.text,
        shapes=run.shapes,
        unsculpted=unsculpted,
        hidden=list(hidden),
        accessories=accessories(run.worn, locks),
        offsets=offsets,
        conflicts=[
            *without_place(recipe, unsculpted, curves),
            *odd_sizes(recipe, surface, unsculpted, curves),
            *run.messages,
            *inward(before_contact, surface),
            *not_strands(curves),
            *fold_warnings(curves),
        ],
    )
    if recipe.hairs.cover is not None:
        raise_density(groom, recipe.hairs)
    return groom


def _begin(
    recipe: Recipe,
    scalp: Mesh,
    colliders: Sequence[Mesh],
    drawn_guides: Curves | None,
    helpers: Mapping[str, Curves],
    meshes: Mapping[str, Mesh],
    memory: Memory,
    progress: Progress | None,
) -> Run:
    """A run of the stages that begins with drawn guides, if any; its key is of everything that is given."""
    key, surface = _scalp(recipe, scalp, colliders, memory)
    if isinstance(recipe.guides, Drawn) and drawn_guides is None:
        raise UserError(f"guides.file is '{recipe.guides.file}', but no curves were read from it; pass drawn_guides")
    if drawn_guides is not None:
        key = key_of(key, drawn_guides.points.tobytes(), drawn_guides.offsets.tobytes(), drawn_guides.ids.tobytes())
        fitted = {name: values for name, values in drawn_guides.curve.items() if name.startswith(ADOPTED)}
        key = key_of(key, *_contents(fitted))
    helpers = {**{name: c for name, h in recipe.curves.items() if (c := h.inline_curve())}, **helpers}
    helpers = {name: helper.check(f"curves.{name}").distinct() for name, helper in helpers.items()}
    for name, helper in helpers.items():
        key = key_of(key, name.encode(), helper.points.tobytes(), helper.offsets.tobytes())
    if recipe.scalp.edge is not None:
        surface = _on_edge(recipe, recipe.scalp.edge, surface, helpers)
        key = key_of(key, recipe.scalp.edge.model_dump_json().encode())
    helper = Context(recipe.seed, surface, "gradients", curves=helpers).helper
    gradients = {name: one.of(surface, helper) for name, one in recipe.gradients.items()}
    surface.mesh = replace(scalp, gradients=gradients) if gradients else scalp
    key = key_of(key, *(f"{name} {one.model_dump_json()}".encode() for name, one in recipe.gradients.items()))
    meshes = {**{name: m for name, h in recipe.meshes.items() if (m := h.inline_mesh(name))}, **meshes}
    for name, mesh in meshes.items():
        key = key_of(key, name.encode(), mesh.points.tobytes(), mesh.triangles.tobytes())
    return Run(recipe, surface, helpers, meshes, memory, progress, key, drawn_guides or Curves.from_list([]))


def _on_edge(recipe: Recipe, edge: Edge, scalp: Scalp, helpers: Mapping[str, Curves]) -> EdgeScalp:
    """The scalp with hair on lines alone; raises UserError for settings that need an area."""
    needs_area = {
        "locks.sections": recipe.locks.sections,
        "locks.hairline": recipe.locks.hairline,
        "hairs.density": recipe.hairs.density,
        "hairs.cover": recipe.hairs.cover,
    }
    for name, setting in needs_area.items():
        if setting is not None:
            raise UserError(f"{name} needs an area, but scalp.edge grows hair on lines; take one of the two away")
    return edge.of(scalp, Context(recipe.seed, scalp, "scalp", curves=helpers).helper, recipe.seed)


def _with_maps_of_hairs(locks: Curves, hairs: HairSettings, scalp: Mesh) -> Curves:
    """Adds the textures and gradients that hair settings name, sampled at the roots, as curve attributes of the locks.

    A groom file holds neither, and hairs are made from that file alone.
    """
    values = [value for table in (hairs, *hairs.sections.values()) for _, value in table if isinstance(value, Varied)]
    used = {value.map for value in values if value.map in scalp.textures.keys() | scalp.gradients.keys()}
    sampled = {name: painted(name, locks, scalp, "hairs").astype(np.float32) for name in sorted(used - {None})}
    return Curves(locks.points, locks.offsets, locks.ids, {**locks.curve, **sampled}, locks.point) if sampled else locks


def _with_mask_of_hairs(locks: Curves, recipe: Recipe, scalp: Mesh) -> Curves:
    """Adds the part of the hairs that grow, where the recipe has a mask of hairs, as a curve attribute of the locks."""
    if recipe.hairs.mask is None:
        return locks
    flat = Curves(locks.roots, offsets_from_counts(np.ones(len(locks))), locks.ids, locks.curve)
    share = recipe.hairs.mask.weights(flat, scalp, Random(recipe.seed, "hairs/mask"), "hairs.mask")[:, 0]
    attributes = {**locks.curve, HAIR_SHARE: share.astype(np.float32)}
    return Curves(locks.points, locks.offsets, locks.ids, attributes, locks.point)


def _scalp(recipe: Recipe, mesh: Mesh, colliders: Sequence[Mesh], memory: Memory) -> tuple[str, Scalp]:
    """The scalp with a key of all that it is made of; at once where that is what it was made of in the last run."""
    settings = str((recipe.seed, recipe.unit, recipe.scalp.region, list(mesh.textures)))
    surface = mesh.points, mesh.triangles, mesh.regions, mesh.maps, mesh.vectors, mesh.uv
    bodies = (part for body in colliders for part in (body.points, body.triangles))
    given = [*surface, *mesh.textures.values(), *bodies]
    if memory.scalp is not None and memory.scalp_given[0] == settings and _same(memory.scalp_given[1], given):
        return memory.scalp
    memory.scalp_given = settings, given
    key = key_of(
        settings,
        mesh.points.tobytes(),
        mesh.triangles.tobytes(),
        *(chunk for kind in (mesh.regions, mesh.maps, mesh.vectors) for chunk in _contents(kind)),
        *(part for name, texture in mesh.textures.items() for part in (name.encode(), texture.digest)),
        b"" if mesh.uv is None else mesh.uv.tobytes(),
        *(part for body in colliders for part in (body.points.tobytes(), body.triangles.tobytes())),
    )
    if memory.scalp is None or memory.scalp[0] != key:
        memory.scalp = (key, Scalp(mesh, recipe.scalp.region, colliders))
    return memory.scalp


def _same(a: Sequence[Any], b: Sequence[Any]) -> bool:
    """Whether two lists have the same objects."""
    return len(a) == len(b) and all(x is y for x, y in zip(a, b, strict=True))


def _contents(named: dict[str, NDArray]) -> Iterator[bytes]:
    for name, values in named.items():
        yield from (name.encode(), values.tobytes())
