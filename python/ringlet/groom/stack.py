"""The operator stack: guides → locks → shape → curl → collide, each stage a pure function of the one before."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from hashlib import blake2b
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ringlet.data.bounds import check_curves
from ringlet.data.curves import Curves, offsets_from_counts
from ringlet.data.errors import UserError
from ringlet.data.groom import ADOPTED, HAIR_SHARE, OFFSETS, Groom, HairOffsets
from ringlet.data.mesh import Mesh
from ringlet.data.painted import painted
from ringlet.data.quantities import Varied
from ringlet.data.random import Random
from ringlet.data.stage import StageSpace
from ringlet.groom.adopted import Residual
from ringlet.groom.color import colored
from ringlet.groom.edge import Edge, EdgeScalp
from ringlet.groom.edits import Edit, Edits
from ringlet.groom.folds import fold_warnings
from ringlet.groom.hair_measures import raise_density
from ringlet.groom.hair_settings import HairSettings
from ringlet.groom.hairs import HairMemory
from ringlet.groom.load import stage_names
from ringlet.groom.operators import Context, Drawn, Operator, Resample
from ringlet.groom.operators.operator import arc_lengths, grid, unit
from ringlet.groom.operators.shape import Displacement, Shape
from ringlet.groom.operators.tied import TO_TIE
from ringlet.groom.pins import pinned
from ringlet.groom.plausibility import odd_sizes
from ringlet.groom.recipe import Recipe
from ringlet.groom.scalp import Scalp
from ringlet.groom.sculpt import Sculpted
from ringlet.groom.worn import Worn, accessories, loaded

Progress = Callable[[str, int, int], None]

MUCH_LONGER = 2.0  # factor on the length of a lock that a displacement is not expected to exceed
STEEPLY_INWARD = -0.5  # cosine between a root's normal and the start of its lock
MANY = 0.1  # share of locks; single ones that hang steeply, or over an edge, are laid along the scalp and need no word
START = 0.02  # of a lock [m]: further along, hair that lies on a head is under the tangent plane of its root


@dataclass
class Memory:
    """Cache of the last run: an edit recomputes the stages from the edited one on.

    results: key and curves of each stage
    worn:    key of each operator, and what locks wear from there on
    files:   contents of files that have not changed, by name
    hairs:   cache of the render hairs
    grooms:  caches of each groom, by name, where the recipe has several
    """

    results: dict[str, tuple[str, Curves, list[str]]] = field(default_factory=dict)
    worn: dict[str, tuple[str, Sequence[Worn]]] = field(default_factory=dict)
    scalp: tuple[str, Scalp] | None = None
    files: dict[str, tuple[tuple[int, str], Any]] = field(default_factory=dict)
    hairs: HairMemory = field(default_factory=HairMemory)
    grooms: dict[str, Memory] = field(default_factory=dict)


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
    where = recipe.path.name if recipe.path else "recipe"
    try:
        key, surface = _scalp(recipe, scalp, colliders, memory)
        if isinstance(recipe.guides, Drawn) and drawn_guides is None:
            raise UserError(
                f"guides.file is '{recipe.guides.file}', but no curves were read from it; pass drawn_guides"
            )
        if drawn_guides is not None:
            key = _key(key, drawn_guides.points.tobytes(), drawn_guides.offsets.tobytes(), drawn_guides.ids.tobytes())
            fitted = {name: values for name, values in drawn_guides.curve.items() if name.startswith(ADOPTED)}
            key = _key(key, *_contents(fitted))
        helpers = {**{name: c for name, h in recipe.curves.items() if (c := h.inline_curve())}, **(helpers or {})}
        helpers = {name: helper.check(f"curves.{name}").distinct() for name, helper in helpers.items()}
        for name, helper in helpers.items():
            key = _key(key, name.encode(), helper.points.tobytes(), helper.offsets.tobytes())
        if recipe.scalp.edge is not None:
            surface = _on_edge(recipe, recipe.scalp.edge, surface, helpers)
            key = _key(key, recipe.scalp.edge.model_dump_json().encode())
        meshes = {**{name: m for name, h in recipe.meshes.items() if (m := h.inline_mesh(name))}, **(meshes or {})}
        for name, mesh in meshes.items():
            key = _key(key, name.encode(), mesh.points.tobytes(), mesh.triangles.tobytes())
        curves = drawn_guides or Curves.from_list([])
        stages = _stages(recipe, OFFSETS in curves.curve)
        guides, unsculpted, shapes, before_contact = curves, curves, None, curves
        lengthened: list[str] = []
        worn: list[Worn] = []
        for name, operator in stages:
            if progress:
                progress(name, 0, 1)
            if name == "curl":
                shapes = curves
            if name == "collide":
                before_contact = curves
            context = Context(
                recipe.seed,
                surface,
                name,
                recipe.locks.points,
                helpers,
                meshes,
                shapes,
                recipe.locks.sections,
                recipe.locks.density,
            )
            before = curves
            curves, key, notes = _run(operator, curves, key, context, memory)
            lengthened += notes
            if isinstance(operator, Shape):
                worn += _worn(operator, before, curves, key, context, memory)
            if name == "guides":
                guides = unsculpted = curves
            if name == "sculpt":
                guides = curves
            if progress:
                progress(name, 1, 1)
        locks = _with_textures_of_hairs(pinned(curves, recipe.pin, scalp, recipe.seed), recipe.hairs, scalp)
        locks = colored(locks, recipe.color, recipe.fiber, scalp)
        locks = loaded(worn, _with_mask_of_hairs(locks, recipe, scalp))
    except UserError as error:
        raise UserError(f"{where}: {error}", error.fixes) from error
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
        shapes=shapes,
        unsculpted=unsculpted,
        hidden=list(hidden),
        accessories=accessories(worn, locks),
        offsets=offsets,
        conflicts=[
            *_conflicts(recipe, unsculpted, curves),
            *odd_sizes(recipe, surface, unsculpted, curves),
            *lengthened,
            *_inward(before_contact, surface),
            *_not_strands(curves),
            *fold_warnings(curves),
        ],
    )
    if recipe.hairs.cover is not None:
        raise_density(groom, recipe.hairs)
    return groom


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


def _with_textures_of_hairs(locks: Curves, hairs: HairSettings, scalp: Mesh) -> Curves:
    """Adds the textures that hair settings name, sampled at the roots, as curve attributes of the locks.

    A groom file holds no textures, and hairs are made from that file alone.
    """
    values = [value for table in (hairs, *hairs.sections.values()) for _, value in table if isinstance(value, Varied)]
    used = {value.map for value in values if value.map in scalp.textures}
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


def _stages(recipe: Recipe, adopted: bool = False) -> list[tuple[str, Operator]]:
    """Stages with their unique names: ``scraggle``, a second one ``scraggle 2``. Later stages change no name."""
    stages: list[tuple[str, Operator]] = [("guides", recipe.guides)]
    if recipe.sculpt:
        stages.append(("sculpt", Sculpted(sculpts=recipe.sculpt)))
    stages.append(("locks", recipe.locks))
    stages += zip(stage_names(list(recipe.shape)), recipe.shape, strict=True)
    by_stage = {kind: [e for e in recipe.edit if e.stage == kind and _moves(e)] for kind in ("shape", "groom")}
    if by_stage["shape"]:
        stages.append(("edits of shapes", Edits(edits=by_stage["shape"])))
    stages.append(("curl", recipe.curl or Resample(points=recipe.locks.points)))
    if adopted and isinstance(recipe.guides, Drawn):
        stages.append(("residual", Residual(amount=recipe.guides.residual)))
    if by_stage["groom"]:
        stages.append(("edits", Edits(edits=by_stage["groom"])))
    stages.append(("collide", recipe.collide))
    return stages


def _moves(edit: Edit) -> bool:
    """Whether an edit moves points; settings alone are in the operators already."""
    return bool(edit.curve or edit.offsets or edit.move)


def _conflicts(recipe: Recipe, guides: Curves, locks: Curves) -> list[str]:
    """One message for each edit of a guide or a lock that does not exist."""
    sculpted = sorted({sculpt.guide for sculpt in recipe.sculpt} - set(guides.ids.tolist()))
    edited = sorted({edit.lock for edit in recipe.edit} - set(locks.ids.tolist()))
    return [
        *(f"guide {guide} was sculpted but is no longer there; its shape is kept until it is" for guide in sculpted),
        *(
            f"lock {lock} was edited but is no longer there; its edit is kept: bring the lock back, or release the edit"
            for lock in edited
        ),
    ]


def _lengthened(name: str, before: Curves, after: Curves) -> Iterator[str]:
    """A message for an operator that displaces locks so far that they become much longer."""
    was, now = before.lengths(), after.lengths()
    if (much := now > MUCH_LONGER * was).any():
        lock = int(np.argmax(now / was))
        yield (
            f"{name} makes {much.sum()} of {len(was)} locks more than {MUCH_LONGER:g} times as long, lock "
            f"{after.ids[lock]} {now[lock]:.3g} instead of {was[lock]:.3g} m; lower its magnitude, raise its "
            "wavelength, or give it keep = 'length'"
        )


def _inward(locks: Curves, scalp: Scalp) -> Iterator[str]:
    """A message where many locks start into the scalp: its faces may be turned inside out."""
    inward = np.einsum("ki,ki->k", unit(_starts(locks)), scalp.frames(locks)[:, :, 2]) < STEEPLY_INWARD
    inward &= locks.curve.get(TO_TIE, np.zeros(len(locks))) == 0.0  # hair that is led to a tie follows the curved skin
    if inward.mean() > MANY:
        yield (
            f"{inward.sum()} of {len(locks)} locks, such as {locks.ids[inward.argmax()]}, start into the scalp and are "
            f"laid along it; if they are outside of it, reverse the orientation of {scalp.mesh.name}"
        )


def _starts(locks: Curves) -> NDArray[np.float64]:
    """From the root of each lock to the mean of its points over ``START``, at least one, shape (count, 3) [m]."""
    points, most = grid(locks), 8
    while (along := arc_lengths(points[:, :most]))[:, -1].min() < START and most < points.shape[1]:
        most *= 2
    near = along[:, 1:] < np.maximum(START, along[:, 1:2] * (1 + 1e-6))
    sums = np.where(near[:, :, None], points[:, 1:most], 0.0).sum(axis=1)
    return sums / near.sum(axis=1, keepdims=True) - locks.roots


def _not_strands(locks: Curves) -> Iterator[str]:
    """A message for locks that cannot be simulated."""
    try:
        locks.check_strands("locks")
    except UserError as error:
        yield f"{error}; as it is, the groom cannot be simulated"


def _run(
    operator: Operator, curves: Curves, key: str, context: Context, memory: Memory
) -> tuple[Curves, str, list[str]]:
    """The operator's result, its key and messages about it; from the cache when the key is unchanged."""
    name = context.purpose
    key = _key(key, name.encode(), operator.model_dump_json().encode())
    cached = memory.results.get(name)
    if cached is None or cached[0] != key:
        made = operator.apply(curves, context)
        check_curves(made, made.points, context.scalp.points, name, "lower its settings, or leave it out")
        notes = list(_lengthened(name, curves, made)) if isinstance(operator, Displacement) else []
        cached = memory.results[name] = (key, made, notes)
    return cached[1], key, cached[2]


def _worn(operator: Shape, before: Curves, after: Curves, key: str, context: Context, memory: Memory) -> Sequence[Worn]:
    """What locks wear from an operator on; from the cache when its key is unchanged."""
    cached = memory.worn.get(context.purpose)
    if cached is None or cached[0] != key:
        cached = (key, operator.worn(before, after, context))
        memory.worn[context.purpose] = cached
    return cached[1]


def _scalp(recipe: Recipe, mesh: Mesh, colliders: Sequence[Mesh], memory: Memory) -> tuple[str, Scalp]:
    key = _key(
        str((recipe.seed, recipe.unit, recipe.scalp.region)),
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


def _contents(named: dict[str, NDArray]) -> Iterator[bytes]:
    for name, values in named.items():
        yield from (name.encode(), values.tobytes())


def _key(before: str, *content: bytes) -> str:
    digest = blake2b(before.encode(), digest_size=16)
    for chunk in content:
        digest.update(chunk)
    return digest.hexdigest()
