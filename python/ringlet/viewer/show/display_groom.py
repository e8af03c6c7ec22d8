"""Evaluates recipes for display, incrementally."""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ringlet.api.grooms import groom_inputs
from ringlet.data.curves import Curves
from ringlet.data.errors import UserError
from ringlet.data.mesh import Mesh
from ringlet.groom import AnyHairs, Groom, HairMemory, Memory, Recipe, join_grooms, lay_hairs, make_groom, recipes_of
from ringlet.groom.operators import Collide, Context, Drawn
from ringlet.groom.thinning import spread
from ringlet.viewer import protocol
from ringlet.viewer.project import Project
from ringlet.viewer.show.maps import texture_of
from ringlet.viewer.wire import pack

GLIMPSE = 4000  # hairs of the first picture, which stand for all

RAMPS = ("escaping", "relaxing", "tight", "opening")  # of the curl of hairs, along them

# Arrays of the curl of hairs, where these only follow their lock.
NO_CURL: dict[str, NDArray] = {
    name: np.empty(0) for name in ("slip", "escape", "relax", "family", "coil", "phase", *RAMPS)
}


class NoCollide(Collide):
    """Does nothing. Its margin is invalid in a recipe, so that the cache distinguishes its results."""

    def apply(self, curves: Curves, context: Context) -> Curves:
        """Returns the curves unchanged."""
        return curves


@dataclass
class DisplayGroom:
    """A groom for display.

    hairs:    render hairs; None for curves that are hairs themselves
    draft:    whether the collide stage was skipped
    isolated: ids of locks with manual edits
    curves:   names of helper curves
    times:    times of the stages that were computed [ms]
    took:     total time [ms]
    """

    groom: Groom
    hairs: AnyHairs | None
    draft: bool
    isolated: frozenset[int] = frozenset()
    curves: frozenset[str] = frozenset()
    times: dict[str, float] = field(default_factory=dict)
    took: float = 0.0

    def locks(self, side: str) -> bytes:
        """Message with the locks."""
        locks = self.groom.locks
        axis = np.tile([1.0, 0.0, 0.0], (len(locks), 1))
        if self.hairs is not None:
            axis = self.hairs.axes(self.groom.scalp.points)
        return pack(
            protocol.Locks.model_validate({"side": side, "draft": self.draft}),
            points=locks.points - self.groom.origin,
            offsets=locks.offsets,
            ids=locks.ids,
            axis=axis,
            marked=np.isin(locks.ids, list(self.isolated)),
            window=np.empty(0) if self.hairs is None else self.hairs.windows,
        )

    def layout(self, side: str) -> bytes:
        """Message with the hairs relative to the locks."""
        return (
            hairs_message(side, self.hairs, self.groom.scalp) if self.hairs else curves_message(side, self.groom.locks)
        )

    def glimpse(self, side: str) -> bytes:
        """Message with few hairs that stand for all; empty where all are few."""
        if self.hairs is None or self.count < 2 * GLIMPSE:
            return b""
        return hairs_message(side, self.hairs, self.groom.scalp, GLIMPSE)

    @property
    def count(self) -> int:
        """Number of drawn hairs."""
        return len(self.hairs.curves) if self.hairs else len(self.groom.locks)


class StageClock:
    """Times the stages of a groom and reports their progress.

    stages: expected number of stages
    times:  times of the computed stages [ms]
    """

    def __init__(self, stages: int, check_abort: Callable[[], None], progress: Callable[[str, float], None]) -> None:
        self.stages, self.times = stages, dict[str, float]()
        self._check_abort, self._progress = check_abort, progress
        self._begun = 0
        self._start = self._stage_start = time.perf_counter()

    def __call__(self, stage: str, done: int, total: int) -> None:
        """A stage begins, or ends where ``done`` is not 0."""
        if done:
            self.end(stage)
            return
        self._check_abort()
        self.begin(stage, min(self._begun / self.stages, 1.0))
        self._begun += 1

    def begin(self, stage: str, before: float) -> None:
        """A stage begins. before: fraction of the stages before it."""
        self._progress(stage, before)
        self._stage_start = time.perf_counter()

    def end(self, stage: str) -> None:
        """The current stage ends; one of less than 0.5 ms was not computed again."""
        if (took := 1e3 * (time.perf_counter() - self._stage_start)) > 0.5:
            self.times[stage] = round(took, 1)

    @property
    def total(self) -> float:
        """Time since the start [ms]."""
        return 1e3 * (time.perf_counter() - self._start)


class GroomEvaluator:
    """Evaluates recipes of one project; caches the results of unchanged stages."""

    def __init__(self, project: Project) -> None:
        self._project = project
        self._memories: dict[str, Memory] = {}
        self._inputs: dict[str, tuple[str, dict[str, Any]]] = {}
        self._hairs = HairMemory()

    def groom(
        self,
        recipe: Recipe,
        muted: frozenset[str] = frozenset(),
        *,
        chosen: str = "",
        draft: bool,
        check_abort: Callable[[], None],
        progress: Callable[[str, float], None] = lambda stage, done: None,
        painted: Mapping[str, bytes] | None = None,
        found: Callable[[Recipe, dict[str, Any]], None] = lambda recipe, inputs: None,
    ) -> DisplayGroom:
        """Evaluates a recipe.

        muted:       stages without effect
        chosen:      the one of several grooms that ``muted`` is about
        draft:       skips the collide stage
        check_abort: called between stages; may raise an exception to abort
        progress:    called with each stage and the fraction of the stages before it
        painted:     pictures of maps in place of those on disk, by name of the file
        found:       called with the first recipe and what its files hold, before its groom is made
        """
        recipes = recipe.grooms or {"": recipe}
        clock = StageClock(sum(len(one.shape) + 4 for one in recipes.values()) + 1, check_abort, progress)
        always = frozenset({"collide"}) if draft else frozenset()
        made = {}
        for name, one in recipes.items():
            one = without_muted(one, always | (muted if name == chosen else frozenset()))
            memory = self._memories.setdefault(name, Memory())
            inputs = self._read(name, one, painted or {})
            if not made:
                found(one, inputs)
            made[name] = make_groom(one, progress=clock, memory=memory, **inputs)
            made[name].hairs = one.hairs.model_dump(mode="json")
            check_abort()
        groom = join_grooms(made) if recipe.grooms else made[""]
        clock.begin("hairs", 1.0 - 1.0 / clock.stages)
        hairs = lay_hairs(groom, memory=self._hairs)
        clock.end("hairs")
        return DisplayGroom(
            groom,
            hairs,
            draft,
            frozenset(edit.lock + offset for one, offset in recipes_of(recipe) for edit in one.edit),
            frozenset(recipe.curves),
            clock.times,
            clock.total,
        )

    def _read(self, name: str, recipe: Recipe, painted: Mapping[str, bytes]) -> dict[str, Any]:
        """Inputs from the files of a groom's recipe, read again only after one of them changes."""
        textures = {one: texture_of(painted[file]) for one, file in recipe.maps.items() if file in painted}
        if textures:
            others = {one: file for one, file in recipe.maps.items() if one not in textures}
            inputs = self._read(name, recipe.model_copy(update={"maps": others}), {})
            scalp = inputs["scalp"]
            return {**inputs, "scalp": replace(scalp, textures={**scalp.textures, **textures})}
        files = recipe.named_files()
        for what, file in files.items():
            self._project.inside(file, f"{recipe.path.name if recipe.path else 'recipe'}: {what}")
        stamps = [(what, str(file), _stamp(file)) for what, file in sorted(files.items()) if what != "edits"]
        drawn = recipe.guides if isinstance(recipe.guides, Drawn) else None
        key = repr((stamps, recipe.scalp, drawn, recipe.curves, recipe.meshes))
        if name not in self._inputs or self._inputs[name][0] != key:
            self._inputs[name] = key, groom_inputs(recipe)
        return self._inputs[name][1]


def without_muted(recipe: Recipe, muted: frozenset[str]) -> Recipe:
    """Disables muted stages. They keep their position, so that the random numbers of other stages stay."""
    changed: dict[str, Any] = {
        "shape": [
            operator.model_copy(update={"blend": 0.0}) if f"shape/{k}" in muted else operator
            for k, operator in enumerate(recipe.shape)
        ]
    }
    if "curl" in muted:
        changed["curl"] = None
    if "collide" in muted:
        changed["collide"] = NoCollide.model_construct(margin=-1.0)
    return recipe.model_copy(update=changed)


def hairs_message(side: str, hairs: AnyHairs, scalp: Mesh, most: int | None = None) -> bytes:
    """Message with hairs, ordered so that any prefix covers all locks evenly.

    most: number of the hairs that stand for all, as wide together as these
    """
    layout = hairs.deformation(scalp.points)
    group = layout.get("group", np.zeros(len(hairs.curves), np.uint8))
    count, points = len(hairs.curves), int(hairs.curves.counts[0])
    order = spread(np.diff(layout["first"]))[:most]
    widths = hairs.curves.point["width"].reshape(count, points)
    widest = widths.max(axis=1)
    unblended = {"other": np.zeros(count), "share": np.zeros(count)}
    blends = {name: layout[name] if len(layout[name]) else zeros for name, zeros in unblended.items()}
    return pack(
        protocol.Hairs.model_validate(
            {"side": side, "count": len(order), "points": points, "knots": layout["frizz"].shape[1] // 2}
        ),
        lock=hairs.curves.curve["lock"][order],
        group=group[order],
        **{name: layout[name][order] for name in ("offset", "tip", "join", "flat", "taper", "frizz", "root")},
        **{name: values[order] for name, values in blends.items()},
        **{name: layout[name] for name in ("profile", "hold", "pace", "blend")},
        width=widest[order] * (count / len(order)),
        thinning=np.concatenate(
            [_thinning(widths[of], widest[of]) for of in (group == k for k in range(int(group[-1]) + 1))]
        ),
        **NO_CURL | {name: values if name in RAMPS else values[order] for name, values in layout["curl"].items()},
    )


def _thinning(widths: NDArray[np.floating], widest: NDArray[np.floating]) -> NDArray[np.floating]:
    """Mean width along hairs, relative to the widest point of each, shape (points,)."""
    thinning = (1.0 / np.maximum(widest, 1e-12)) @ widths
    return thinning / thinning.max()


def curves_message(side: str, curves: Curves) -> bytes:
    """Message with curves that are hairs themselves: one hair at the centre of each lock."""
    count, points = len(curves), int(curves.counts.max())
    order = shuffled_order(count)
    widths = curves.point.get("width")
    width = np.full(count, 7e-5) if widths is None else np.maximum.reduceat(widths, curves.offsets[:-1])
    return pack(
        protocol.Hairs.model_validate({"side": side, "count": count, "points": points, "knots": 2}),
        lock=order,
        group=np.zeros(count),
        offset=np.zeros(2 * count),
        tip=np.ones(count),
        join=np.zeros(count),
        flat=np.zeros(count),
        taper=np.zeros(count),
        other=np.zeros(count),
        share=np.zeros(count),
        frizz=np.zeros(4 * count),
        root=np.zeros(3 * count),
        profile=np.zeros(points),
        hold=np.zeros(points),
        pace=np.zeros(points),
        blend=np.zeros(points),
        width=width[order],
        thinning=np.linspace(1.0, 0.4, points),
        **NO_CURL,
    )


def shuffled_order(count: int) -> NDArray[np.intp]:
    """Order of curves that are hairs themselves, shape (count,)."""
    return np.random.default_rng(0).permutation(count)


def _stamp(file: Path) -> tuple[int, int]:
    try:
        status = file.stat()
    except OSError as error:
        raise UserError(f"{file}: cannot be read ({error.strerror}); name a file that is there") from error
    return status.st_mtime_ns, status.st_size
