"""The stages of a groom: guides → locks → shape → curl → collide, each a pure function of the one before."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from hashlib import blake2b
from typing import Any

from ringlet.data.bounds import check_curves
from ringlet.data.curves import Curves
from ringlet.data.mesh import Mesh
from ringlet.groom.adopted import Residual
from ringlet.groom.conflicts import lengthened
from ringlet.groom.edits import Edit, Edits
from ringlet.groom.hairs import HairMemory
from ringlet.groom.load import stage_names
from ringlet.groom.operators import Context, Drawn, Operator
from ringlet.groom.operators.operator import Uncurled
from ringlet.groom.operators.shape import Displacement, Shape
from ringlet.groom.recipe import Recipe
from ringlet.groom.scalp import Scalp
from ringlet.groom.sculpt import Sculpted
from ringlet.groom.worn import Worn

Progress = Callable[[str, int, int], None]
Stages = Sequence[tuple[str, Operator]]  # with their unique names: ``scraggle``, a second one ``scraggle 2``


@dataclass
class Memory:
    """Cache of the last run: an edit recomputes the stages from the edited one on.

    results: key and curves of each stage
    worn:    key of each operator, and what locks wear from there on
    scalp:   key of all that it is made of, and the scalp
    scalp_given: what it is made of, which nobody changes in place
    files:   contents of files that have not changed, by name
    hairs:   cache of the render hairs
    grooms:  caches of each groom, by name, where the recipe has several
    """

    results: dict[str, tuple[str, Curves, list[str]]] = field(default_factory=dict)
    worn: dict[str, tuple[str, Sequence[Worn]]] = field(default_factory=dict)
    scalp: tuple[str, Scalp] | None = None
    scalp_given: tuple[str, list[Any]] = ("", [])
    files: dict[str, tuple[tuple[int, str], Any]] = field(default_factory=dict)
    hairs: HairMemory = field(default_factory=HairMemory)
    grooms: dict[str, Memory] = field(default_factory=dict)


@dataclass
class Run:
    """Stages one after another, each from the cache while nothing that it depends on has changed.

    key:      of all that the curves depend on
    curves:   of the last stage
    shapes:   the curves that are curled, from there on
    worn:     what locks wear
    messages: about what stages have done
    """

    recipe: Recipe
    scalp: Scalp
    helpers: Mapping[str, Curves]
    meshes: Mapping[str, Mesh]
    memory: Memory
    progress: Progress | None
    key: str
    curves: Curves
    shapes: Curves | None = None
    worn: list[Worn] = field(default_factory=list)
    messages: list[str] = field(default_factory=list)

    def through(self, stages: Stages) -> Curves:
        """Runs stages; returns the curves of the last."""
        for name, operator in stages:
            if self.progress:
                self.progress(name, 0, 1)
            self._apply(operator, self._context(name))
            if self.progress:
                self.progress(name, 1, 1)
        return self.curves

    def _context(self, name: str) -> Context:
        locks = self.recipe.locks
        return Context(
            self.recipe.seed,
            self.scalp,
            name,
            locks.points,
            self.helpers,
            self.meshes,
            self.shapes,
            locks.sections,
            locks.density,
            None if isinstance(self.recipe.guides, Drawn) else self.recipe.guides.part_line,
        )

    def _apply(self, operator: Operator, context: Context) -> None:
        name, before = context.purpose, self.curves
        self.key = key = key_of(self.key, name.encode(), operator.model_dump_json().encode())
        cached = self.memory.results.get(name)
        if cached is None or cached[0] != key:
            made = operator.apply(before, context)
            check_curves(made, made.points, self.scalp.points, name, "lower its settings, or leave it out")
            notes = list(lengthened(name, before, made)) if isinstance(operator, Displacement) else []
            cached = self.memory.results[name] = (key, made, notes)
        self.curves = cached[1]
        self.messages += cached[2]
        if isinstance(operator, Shape):
            worn = self.memory.worn.get(name)
            if worn is None or worn[0] != key:
                worn = self.memory.worn[name] = (key, operator.worn(before, self.curves, context))
            self.worn += worn[1]


def sculpting(recipe: Recipe) -> Stages:
    """Manual edits of guides."""
    return [("sculpt", Sculpted(sculpts=recipe.sculpt))] if recipe.sculpt else []


def shaping(recipe: Recipe) -> Stages:
    """From guides to locks that are not curled yet. Later stages change no name."""
    return [
        ("locks", recipe.locks),
        *zip(stage_names(list(recipe.shape)), recipe.shape, strict=True),
        *_edits(recipe, "shape", "edits of shapes"),
    ]


def curling(recipe: Recipe, adopted: bool) -> Stages:
    """The curl and edits of it; adopted: drawn guides have what a curl leaves of them."""
    residual = [("residual", Residual(amount=recipe.guides.residual))] if isinstance(recipe.guides, Drawn) else []
    return [
        ("curl", recipe.curl or Uncurled()),
        *(residual if adopted else []),
        *_edits(recipe, "groom", "edits"),
    ]


def _edits(recipe: Recipe, stage: str, name: str) -> Stages:
    edits = [edit for edit in recipe.edit if edit.stage == stage and _moves(edit)]
    return [(name, Edits(edits=edits))] if edits else []


def _moves(edit: Edit) -> bool:
    """Whether an edit moves points; settings alone are in the operators already."""
    return bool(edit.length or edit.curve or edit.offsets or edit.move)


def key_of(before: str, *content: bytes) -> str:
    """A key that also depends on this content."""
    digest = blake2b(before.encode(), digest_size=16)
    for chunk in content:
        digest.update(chunk)
    return digest.hexdigest()
