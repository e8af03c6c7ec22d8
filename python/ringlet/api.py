"""The public functions: what the command line does, for programs.

They follow the data: recipe → groom → cache → hairs → pictures. Heavy libraries are imported where they are used, so
that ``import ringlet`` is quick. ``progress``, wherever it is taken, is called as ``progress(stage, done, total)``.
"""

from __future__ import annotations

import importlib.util
import inspect
import sys
from collections.abc import Callable, Collection, Iterable, Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal

import numpy as np
from numpy.typing import NDArray

from ringlet.curves import Curves
from ringlet.errors import UserError
from ringlet.files import within
from ringlet.settings import did_you_mean
from ringlet.share import share

if TYPE_CHECKING:
    from ringlet.groom import Hairs, Memory, Recipe
    from ringlet.groom.groom import Groom
    from ringlet.mesh import Clip, Mesh
    from ringlet.shot import Checkpoints, Garment, Motion, Obstacle, Shot
    from ringlet.shot.cache import Cache, Told
    from ringlet.shot.loft import Loft
    from ringlet.validate import Row

Progress = Callable[[str, int, int], None]
OnFrame = Callable[[float, dict[str, Any]], None]


# Groom


def read_recipe(path: Path | str) -> Recipe:
    """Reads a recipe from a TOML file, with every setting checked."""
    from ringlet import groom

    return groom.read_recipe(Path(path))


def build_groom(
    recipe: Recipe | Path | str, *, progress: Progress | None = None, memory: Memory | None = None
) -> Groom:
    """Makes the groom of a recipe: guides grown on the scalp or read from USD, then locks, shape and curl.

    memory: keeps results between calls, so that an edit recomputes only what follows it
    """
    from ringlet import groom

    if not isinstance(recipe, groom.Recipe):
        recipe = read_recipe(recipe)
    return groom.make_groom(recipe, progress=progress, memory=memory, **groom_inputs(recipe, memory))


def groom_inputs(recipe: Recipe, memory: Memory | None = None) -> dict[str, Any]:
    """What the files hold that a recipe names: what ``make_groom`` takes besides the recipe."""
    from ringlet import io
    from ringlet.groom.operators import Drawn

    if recipe.scalp_file is None:
        raise UserError(f"{recipe.path or 'recipe'}: scalp.file is missing; name the file of the head")
    scalp = _kept(
        memory, recipe.scalp_file, lambda file: io.read_mesh(file, recipe.scalp.mesh, space=recipe.scalp.space)
    )
    scalp.textures = {name: io.read_texture(file) for name, file in recipe.map_files().items()}
    drawn = None
    if isinstance(recipe.guides, Drawn) and recipe.guides_file is not None:
        drawn = io.read_curves(recipe.guides_file, recipe.guides.prim, space=recipe.guides.space)
    helpers = {
        name: io.read_curves(file, recipe.curves[name].prim, space=recipe.curves[name].space)
        for name, file in recipe.helper_files().items()
    }
    return {
        "scalp": scalp,
        "drawn_guides": drawn,
        "helpers": helpers,
        "scalp_file": recipe.scalp_file,
        "scalp_prim": recipe.scalp.mesh,
        "space": io.read_space(recipe.scalp_file, space=recipe.scalp.space),
    }


def _kept(memory: Memory | None, file: Path, read: Callable[[Path], Any]) -> Any:
    """What is in a file, from memory while it has not changed."""
    changed = file.stat().st_mtime_ns if file.exists() else 0
    if memory is None:
        return read(file)
    if memory.files.get(str(file), (None, None))[0] != changed:
        memory.files[str(file)] = (changed, read(file))
    return memory.files[str(file)][1]


def write_groom(groom: Groom, path: Path | str, *, variants: Mapping[str, Groom] | None = None) -> None:
    """Writes a groom as USD, with the head it grows on by reference.

    variants: more grooms of the same head, by name: the file has a variant set ``groom``, with ``groom`` as ``base``
    """
    from ringlet import io

    io.write_groom(groom, Path(path), variants)


def read_groom(path: Path | str, *, variant: str | None = None) -> Groom:
    """Reads a groom that ``write_groom`` wrote, or one of its variants."""
    from ringlet import io

    return io.read_groom(Path(path), variant)


def load_groom(path: Path | str, *, variant: str | None = None, progress: Progress | None = None) -> Groom:
    """The groom of a recipe (``.toml``) or of a USD file, or a variant of the latter."""
    if Path(path).suffix != ".toml":
        return read_groom(path, variant=variant)
    if variant is not None:
        raise UserError(f"variant '{variant}': {path} is a recipe; name the recipe of the variant instead")
    return build_groom(path, progress=progress)


# Edits of single locks


def edit_lock(
    recipe: Path | str,
    lock: int,
    *,
    points: NDArray | None = None,
    stage: Literal["groom", "shape"] = "groom",
    relative: bool | None = None,
    settings: dict[str, Any] | None = None,
) -> None:
    """Takes a lock out of a recipe, whose line ``edits`` names the file that keeps the change.

    points:   where its points go [m], shape (k, 3), in the rest pose; where they are now when absent
    stage:    ``shape``: the points are those of the lock before it is curled
    relative: keep the difference from what the recipe makes, so that the edit goes with all changes of the recipe (so
              it is for given points); else the curve as it is
    settings: in place of points: settings of this lock alone, such as ``{"curl.width": "8 mm"}``
    """
    from ringlet import groom

    before = read_recipe(recipe)
    with groom.taken_back(before):
        if settings is not None:
            groom.add_settings(before, lock, settings)
        else:
            made = build_groom(before)
            now = (made.shapes if stage == "shape" and made.shapes else made.locks)[groom.row_of(made, lock)]
            others = [edit for edit in before.edit if edit.lock != lock or edit.stage != stage]
            plain = build_groom(before.model_copy(update={"edit": others}))
            relative = points is not None if relative is None else relative
            groom.add_points(before, plain, lock, now if points is None else points, stage, relative)
        read_recipe(recipe)


def release_locks(recipe: Path | str, locks: Collection[int] | None = None) -> list[int]:
    """Gives edited locks back to the recipe, all or those named; returns their ids."""
    from ringlet import groom

    return groom.release(read_recipe(recipe), locks)


def list_edits(recipe: Path | str) -> list[dict[str, Any]]:
    """The edited locks of a recipe: ``lock``, ``stage``, ``what`` was changed, and whether the lock is ``there``."""
    read = read_recipe(recipe)
    there = set(build_groom(read).locks.ids.tolist()) if read.edit else set()
    return [
        {
            "lock": edit.lock,
            "stage": edit.stage,
            "what": [*edit.set, *(name for name in ("curve", "offsets", "move") if getattr(edit, name))],
            "there": edit.lock in there,
        }
        for edit in read.edit
    ]


# Check


def check_groom(
    groom: Groom | Path | str,
    *,
    root_depth: float = 5e-4,
    root_length: float = 5e-3,
    thickness: float = 1e-4,
    fixed: Path | str | None = None,
    picture: Path | str | None = None,
    variant: str | None = None,
    progress: Progress | None = None,
) -> dict[str, Any]:
    """What of a groom is in the scalp, in the body and in other locks: places, locks, greatest depth [m], worst places.

    Returns ``found``; with ``fixed`` also ``left``, what could not be repaired, and ``repair``, what was moved.

    root_depth:  how deep a lock may be in the skin up to ``root_length`` from its root [m]
    thickness:   two locks nearer than this are in one another [m]
    fixed:       where to write the repaired groom
    picture:     where to write a picture of the places: of those that are left, if it is repaired
    variant:     of the groom file, in place of the one that is selected in it
    """
    from ringlet import groom as grooms
    from ringlet.groom.groom import Groom

    if not isinstance(groom, Groom):
        groom = load_groom(groom, variant=variant, progress=progress)
    allowed = grooms.Allowed(root_depth, root_length, thickness)
    others = _beside_scalp(groom)
    findings = grooms.check_groom(groom, others, allowed)
    told: dict[str, Any] = {"locks": len(groom.locks), "points": len(groom.locks.points), "found": findings.told()}
    if fixed is not None:
        repair = grooms.fix_groom(groom, others, allowed, progress)
        write_groom(repair.groom, fixed)
        findings = repair.left
        told |= {"left": findings.told(), "repair": repair.told()}
    if picture is not None:
        from ringlet.picture import write_places

        body = np.concatenate([mesh.points for mesh in (groom.scalp, *others)])
        title = "left after the repair" if fixed is not None else "found"
        write_places(body, findings.locks.points, findings.by_kind(), picture, title)
    return told


def _beside_scalp(groom: Groom) -> list[Mesh]:
    """The visible meshes in the file of the scalp, but for the scalp."""
    from ringlet import io

    if groom.scalp_file is None or groom.scalp_file.suffix == ".obj":
        return []
    meshes = [body.mesh for body in io.read_bodies(groom.scalp_file)]
    return [mesh for mesh in meshes if mesh.name != groom.scalp.name]


# Shot


def read_shot(path: Path | str) -> Shot:
    """Reads a shot from a TOML file, with every setting checked."""
    from ringlet import shot

    return shot.read_shot(Path(path))


def simulate(
    shot: Shot | Path | str,
    groom: Groom | Path | str | None = None,
    *,
    frames: tuple[int, int] | None = None,
    allow_stale: bool = False,
    checkpoints: Path | str | None = None,
    resume: bool = False,
    touches: bool = False,
    progress: Progress | None = None,
) -> Cache:
    """Moves the locks of a groom while the scalp plays its clip.

    groom:       in place of the one that the shot names
    frames:      first and last frame, in place of the shot's
    allow_stale: use a lofted shape although it was made from another groom, material or forces
    checkpoints: a folder that keeps what is done while it runs; to be taken away when its result has been written
    resume:      go on with what a run that was broken off left there, to the same bits
    touches:     keep what touches in every frame, for ``write_touches``
    """
    from ringlet import shot as shots
    from ringlet.groom.groom import Groom

    if not isinstance(shot, shots.Shot):
        shot = read_shot(shot)
    if not isinstance(groom, Groom):
        groom = load_groom(groom or shot.groom, progress=progress)
    inputs = _inputs(shot, groom, allow_stale)
    return shots.simulate(
        shot,
        groom,
        frames=frames,
        checkpoints=_checkpoints(checkpoints, shot, groom, inputs, frames) if checkpoints else None,
        resume=resume,
        touches=touches,
        progress=progress,
        **inputs,
    )


def write_simulation(
    shot: Shot,
    groom: Groom,
    under: Path | str,
    path: Path | str,
    *,
    checkpoints: Path | str,
    frames: tuple[int, int] | None = None,
    allow_stale: bool = False,
    resume: bool = False,
    touches: bool = False,
    progress: Progress | None = None,
    on_frame: OnFrame | None = None,
) -> Told:
    """``simulate`` and ``write_cache`` in one, with one frame at a time in memory, however long the shot is.

    under:       the USD file that ``write_groom`` made of the groom, over which the cache is laid
    checkpoints: the folder that keeps the frames; they go to ``path`` when all are there
    touches:     keep what touches in every frame, for ``write_touches``
    on_frame:    called with each frame's number and statistics, as soon as it is there
    """
    from ringlet import io
    from ringlet import shot as shots

    inputs = _inputs(shot, groom, allow_stale)
    kept = _checkpoints(checkpoints, shot, groom, inputs, frames)
    first, last = frames or shot.frames
    motion = shots.Motion(shot, groom, first=first, **inputs)
    told = shots.Told(start=motion.start, cloths={worn.name: len(worn.cloth.positions) for worn in motion.worn})
    for frame in shots.play(motion, last, touches=touches, progress=progress, checkpoints=kept, resume=resume):
        told.frames.append(frame.number)
        told.statistics.append(frame.statistics)
        if frame.touches:
            told.touches.append(frame.touches)
        if on_frame:
            on_frame(frame.number, frame.statistics)
    with io.CacheWriter(path, under, io.read_space(Path(under)), motion.cloths(0), groom.variant) as writer:
        writer.start = motion.start
        for frame in shots.played(motion, kept, shot.preroll + len(told.frames)):
            writer.add(frame.number, frame.points, frame.statistics, frame.cloths)
    return told


def made_from(shot: Shot, groom: Groom, *, frames: tuple[int, int] | None = None) -> str:
    """A digest of all that the frames of a simulation depend on: two runs with the same give the same bits."""
    from ringlet import shot as shots

    return shots.made_of(shot, groom, frames=frames, **_inputs(shot, groom, False))


def start_motion(shot: Shot, groom: Groom, *, allow_stale: bool = False) -> Motion:
    """The locks of a groom at the start of a shot, to be moved frame by frame by who wants to see each."""
    from ringlet import shot as shots

    return shots.Motion(shot, groom, first=shot.frames[0], **_inputs(shot, groom, allow_stale))


def _inputs(shot: Shot, groom: Groom, allow_stale: bool) -> dict[str, Any]:
    """What files hold that a shot and its groom name: what ``shots.simulate`` takes besides the two."""
    clip, garments = scalp_clip(groom), _garments(shot, groom)
    obstacles = _obstacles(shot, groom, garments)
    rest = _rest_shape(shot, groom, obstacles, allow_stale)
    return {"clip": clip, "rest": rest, "obstacles": obstacles, "garments": garments}


def _checkpoints(
    folder: Path | str, shot: Shot, groom: Groom, inputs: dict[str, Any], frames: tuple[int, int] | None
) -> Checkpoints:
    """The folder that keeps what a run has done."""
    from ringlet import shot as shots

    return shots.Checkpoints(Path(folder), shots.made_of(shot, groom, frames=frames, **inputs))


def loft(
    shot: Shot | Path | str,
    groom: Groom | Path | str | None = None,
    *,
    known: Path | str | None = None,
    progress: Progress | None = None,
) -> Loft:
    """Pre-bends the shape that the locks remember, so that the groom is what hangs under the forces of the shot.

    groom: in place of the one that the shot names
    known: a file that ``write_loft`` wrote: locks that have not changed since are taken from it
    """
    from ringlet import io
    from ringlet import shot as shots
    from ringlet.groom.groom import Groom

    if not isinstance(shot, shots.Shot):
        shot = read_shot(shot)
    if not isinstance(groom, Groom):
        groom = load_groom(groom or shot.groom, progress=progress)
    obstacles = _lain_on(shot, groom)
    if known is None or not Path(known).exists():
        return shots.preload(shot, groom, obstacles=obstacles, progress=progress)
    return shots.refresh(shot, groom, *io.read_rest(Path(known)), obstacles=obstacles, progress=progress)


def rest_place(shot: Shot) -> Path:
    """Where the loft of a shot goes when nobody says otherwise: beside the shot or below, whatever it says."""
    assert shot.path is not None and shot.rest_file is not None  # a shot from a file has a place for it
    return within(shot.rest_file, shot.path.parent, f"{shot.path.name}: rest.file")


def write_loft(loft: Loft, shot: Shot, path: Path | str) -> None:
    """Writes the shape that locks remember, with what it was made from, for ``simulate``."""
    from ringlet import io
    from ringlet import shot as shots

    made_from = shots.made_from(shot, _lain_on(shot, loft.groom))
    io.write_rest(shots.keep(loft, shot), made_from, Path(path), loft.groom.space)


def _lain_on(shot: Shot, groom: Groom) -> list[Obstacle]:
    """The bodies that a groom may lie on, as far as its rest shape asks for them."""
    if shot.rest.mode != "equilibrium" or groom.scalp_file is None:
        return []
    return _obstacles(shot, groom, _garments(shot, groom))


def _rest_shape(shot: Shot, groom: Groom, obstacles: Sequence[Obstacle], allow_stale: bool) -> Curves | None:
    """What the locks remember: nothing but the groom, or a lofted shape that fits."""
    from ringlet import io
    from ringlet import shot as shots

    if shot.rest.mode == "none":
        return None
    if shot.rest_file is None:
        raise UserError(
            f"shot: rest.mode is '{shot.rest.mode}', but rest.file is missing; name what ringlet loft wrote"
        )
    if not shot.rest_file.exists():
        raise UserError(f"{shot.rest_file}: there is no lofted shape; make it with: ringlet loft {shot.path}")
    kept, made_from = io.read_rest(shot.rest_file)
    return shots.check(kept, made_from, shot, groom, shot.rest_file, obstacles=obstacles, allow_stale=allow_stale)


def scalp_clip(groom: Groom) -> Clip:
    """How the scalp of a groom moves."""
    from ringlet import io

    if groom.scalp_file is None:
        raise UserError("groom: names no file for its scalp; write the head as USD and name it in the recipe")
    return io.read_clip(groom.scalp_file, groom.scalp_prim)


def _obstacles(shot: Shot, groom: Groom, garments: Sequence[Garment]) -> list[Obstacle]:
    """What locks and cloth of a shot touch besides one another: of several settings for one mesh, the last."""
    from ringlet import io
    from ringlet import shot as shots

    if not shot.touching:
        return []
    found: dict[tuple[Path, str], Obstacle] = {}
    for collider in shot.collider or (shots.Collider(),):
        file = collider.file or groom.scalp_file
        assert file is not None  # as for the scalp's clip
        for body in io.read_bodies(file, collider.mesh):
            found[file.resolve(), body.prim] = shots.Obstacle(body.mesh, body.clip, collider)
    for garment in garments:  # cloth is no obstacle, even where its file is the head's
        assert garment.file is not None
        found.pop((garment.file.resolve(), garment.prim), None)
    return list(found.values())


def _garments(shot: Shot, groom: Groom) -> list[Garment]:
    """The meshes that become cloth in a shot."""
    from ringlet import io
    from ringlet import shot as shots

    garments: list[Garment] = []
    for cloth in shot.cloth:
        file = cloth.file or groom.scalp_file
        assert file is not None  # as for the scalp's clip
        body = io.read_body(file, cloth.mesh)
        garments.append(shots.Garment(body.mesh, body.clip, cloth, file, body.prim))
        if garments[-1].name in [garment.name for garment in garments[:-1]]:
            raise UserError(f"shot: two cloths are called '{garments[-1].name}'; give one of them another `name`")
    return garments


def write_cache(cache: Cache, groom: Path | str, path: Path | str, *, variant: str | None = None) -> None:
    """Writes simulated guides as a USD layer over the file ``groom``, or over one of its variants."""
    from ringlet import io

    io.write_cache(cache, Path(groom), Path(path), io.read_space(Path(groom)), variant)


def write_touches(cache: Cache | Told, cache_path: Path | str, path: Path | str) -> None:
    """Writes what touched in a simulation as coloured points: a USD layer over the file of its cache."""
    from ringlet import io

    io.write_touches(cache, Path(cache_path), Path(path), io.read_space(Path(cache_path)))


def read_cache(path: Path | str) -> Cache:
    """Reads simulated guides that ``write_cache`` wrote."""
    from ringlet import io

    return io.read_cache(Path(path))


# Hairs


def build_hairs(groom: Groom, *, fraction: float = 1.0, wider: bool = False, memory: Memory | None = None) -> Hairs:
    """Makes the hairs of every lock. ``fraction`` of them: the same ones every time, in (0, 1]; with ``wider`` these
    make up by their width for those left out.

    memory: that of ``build_groom``: hairs are only carried along when nothing but the shape of locks has changed, and
            the next call writes over their points
    """
    from ringlet import groom as grooms

    return grooms.make_hairs(groom, fraction=fraction, wider=wider, memory=memory.hairs if memory else None)


def write_hairs(
    groom: Path | str,
    path: Path | str,
    *,
    cache: Path | str | None = None,
    frames: tuple[int, int] | None = None,
    fraction: float = 1.0,
    wider: bool = False,
    variant: str | None = None,
    progress: Progress | None = None,
) -> dict[str, int]:
    """Writes the hairs of the USD file ``groom``, at rest, or carried by the guides of ``cache`` through ``frames``.

    variant: of the groom, in place of the one that is selected in it, or that the cache was made of

    Returns how many ``locks``, ``hairs``, ``points`` and ``frames`` there are.
    """
    from ringlet import io

    if variant is None and cache is not None:
        variant = read_groom(cache).variant
    locks = read_groom(groom, variant=variant)
    hairs = build_hairs(locks, fraction=fraction, wider=wider)
    written = 0
    with io.HairWriter(Path(path), locks, hairs.curves, Path(cache or groom)) as writer:
        if cache is None:
            writer.add(None, hairs.curves.points)
        else:
            moved = _within(read_cache(cache), frames, cache)
            clip = scalp_clip(locks)
            for frame, points in zip(moved.frames, moved.points, strict=True):
                writer.add(frame, hairs.at(points, clip.at(frame)))
                written += 1
                if progress:
                    progress("hairs", written, len(moved.frames))
    return {
        "locks": len(locks.locks),
        "hairs": len(hairs.curves),
        "points": len(hairs.curves.points),
        "frames": written,
    }


def _within(cache: Cache, frames: tuple[int, int] | None, path: Path | str) -> Cache:
    """The frames of a cache from the first to the last of ``frames``."""
    if frames is None:
        return cache
    chosen = (cache.frames >= frames[0]) & (cache.frames <= frames[1])
    if not chosen.any():
        held = f"{cache.frames[0]:g} to {cache.frames[-1]:g}"
        raise UserError(f"{path}: has no frame from {frames[0]:g} to {frames[1]:g}; it holds {held}")
    cloths = [replace(cloth, points=cloth.points[chosen]) for cloth in cache.cloths]
    return replace(cache, frames=cache.frames[chosen], points=cache.points[chosen], cloths=cloths)


# Pictures


def write_still(
    stage: Path | str,
    path: Path | str,
    *,
    frame: float | None = None,
    width: int = 900,
    height: int = 1000,
    samples: int = 40,
    view: str = "three_quarter",
    color: str = "dark_brown",
    seconds: float | None = None,
    progress: Progress | None = None,
) -> None:
    """Path-traces one frame of a USD stage to a PNG: the hairs and the bodies in it, framed on their own.

    frame:   the first of the stage by default
    view:    ``three_quarter``, ``front``, ``side`` or ``back``
    seconds: stop adding samples after that long
    """
    from ringlet import picture

    bodies, hairs = _posed(Path(stage), frame)
    picture.still(
        bodies,
        hairs,
        Path(path),
        width=width,
        height=height,
        samples=samples,
        view=view,
        color=color,
        seconds=seconds,
        progress=progress,
    )


def write_touches_picture(
    stage: Path | str,
    path: Path | str,
    *,
    show: str = "force",
    frame: float | None = None,
    width: int = 900,
    height: int = 1000,
    samples: int = 40,
    view: str = "three_quarter",
    seconds: float | None = None,
    progress: Progress | None = None,
) -> None:
    """Draws what ``write_touches`` wrote, with the locks and the bodies around it, as coloured beads.

    show:  ``force``: where how hard, from blue to red over three decades; ``gap``: red where hardly anything is left;
           ``start``: all places that were in the way when the shot began, red where worst
    frame: the first by default
    """
    from ringlet import io, picture

    _known(show, ("force", "gap", "start"), "picture", "way to show contacts")
    stage = Path(stage)
    touches, colors = io.read_touches(stage, frame)
    cache, locks = read_cache(stage), read_groom(stage).locks
    index = 0 if frame is None else int(np.flatnonzero(cache.frames == frame)[0])
    places, part = touches.places, 0.006  # of the picture's size
    if show == "gap":
        colors = io.heat(1.0 - np.clip(touches.gap, 0.0, 1.0))
    elif show == "start":
        places, depth = io.start_marks(cache.start)
        colors = io.heat(depth)
    bodies, _, _ = io.read_stage(stage, float(cache.frames[index]))
    posed = [picture.PosedBody(body.mesh, body.clip.points[0]) for body in bodies]
    if len(places):
        posed.append(picture.beads(places, colors, part * float(np.ptp(cache.points[index], axis=0).max())))
    picture.still(
        posed,
        Curves(cache.points[index], locks.offsets, locks.ids),
        Path(path),
        width=width,
        height=height,
        samples=samples,
        view=view,
        color="gray",
        seconds=seconds,
        progress=progress,
    )


def write_sheet(
    stage: Path | str,
    path: Path | str,
    *,
    frames: tuple[int, int] | None = None,
    count: int = 12,
    title: str = "",
    color: str = "dark_brown",
    progress: Progress | None = None,
) -> None:
    """Draws ``count`` frames of a USD stage, evenly spread, on one page, under a title if there is one."""
    from ringlet import io, picture

    _, _, held = io.read_stage(Path(stage))
    chosen = [f for f in held if frames is None or frames[0] <= f <= frames[1]]
    if not chosen:
        raise UserError(f"{stage}: has no frames to draw a sheet of; give hairs made with --cache, or other frames")
    spread = [chosen[i] for i in np.unique(np.linspace(0, len(chosen) - 1, count).round().astype(int))]
    picture.sheet(
        ((frame, *_posed(Path(stage), frame)) for frame in spread),
        Path(path),
        title=title,
        fps=io.read_space(Path(stage)).fps,
        color=color,
        progress=progress,
    )


def write_loft_picture(
    loft: Loft,
    path: Path | str,
    *,
    title: str = "",
    view: str = "three_quarter",
    progress: Progress | None = None,
) -> None:
    """Draws the hair as groomed, as it hangs without the loft and with it, on one page."""
    from ringlet import groom as grooms
    from ringlet import picture

    groom = loft.groom
    hairs = build_hairs(groom, fraction=min(1.0, 6000 / grooms.hair_count(groom)))
    shapes = {"groomed": groom.locks.points, "hanging, not lofted": loft.sagged, "hanging, lofted": loft.lofted}
    picture.compare(
        {name: hairs.curves.with_points(hairs.at(points, groom.scalp.points)) for name, points in shapes.items()},
        [picture.PosedBody(groom.scalp, groom.scalp.points)],
        Path(path),
        title=title,
        view=view,
        progress=progress,
    )


def _posed(stage: Path, frame: float | None) -> tuple[list[Any], Any]:
    """Bodies and hairs of a stage at a frame, as the pictures take them."""
    from ringlet import io, picture

    bodies, hairs, frames = io.read_stage(stage, frame)
    if hairs is None:
        raise UserError(f"{stage}: has no hairs; make them with: ringlet hair {stage} -o hair.usdc")
    at = frame if frame is not None else frames[0] if len(frames) else 0.0
    return [picture.PosedBody(body.mesh, body.clip.at(at)) for body in bodies], hairs


# What checks Ringlet


def run_validation(cases: Sequence[str] | None = None, *, progress: Progress | None = None) -> list[Row]:
    """Compares the simulator with known answers: all cases, or the named ones."""
    from ringlet import validate

    chosen = list(validate.CASES) if cases is None else list(cases)
    for name in chosen:
        _known(name, validate.CASES, "validate", "case")
    rows = []
    for index, name in enumerate(chosen):
        rows += validate.run_case(name)
        if progress:
            progress("known answers", index + 1, len(chosen))
    return rows


def run_bench(name: str, **params: Any) -> dict[str, Any]:
    """Runs the benchmark of that name with its parameters; returns what it measured."""
    folder = share("bench")
    files = {file.stem: file for file in sorted(folder.glob("*.py"))}
    _known(name, files, "bench", "benchmark")
    spec = importlib.util.spec_from_file_location(f"ringlet_bench_{name}", files[name])
    assert spec is not None and spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    sys.path.insert(0, str(folder))  # as for a script: benchmarks may share what is in this folder
    try:
        spec.loader.exec_module(module)
    finally:
        sys.path.remove(str(folder))
    taken = inspect.signature(module.run).parameters
    for key in params:
        _known(key, taken, f"bench {name}", "parameter")
    return module.run(**params)


def schema() -> dict[str, Any]:
    """JSON schemas of what people write: ``recipe`` and ``shot``."""
    from ringlet import groom, shot

    return {"recipe": groom.schema(), "shot": shot.schema()}


def use_threads(count: int) -> None:
    """Limits the core to so many threads."""
    from ringlet import _core

    _core.set_thread_count(count)


def _known(name: str, names: Iterable[str], where: str, what: str) -> None:
    """Refuses a name that is not among ``names``, with the nearest one that is."""
    if name not in names:
        raise UserError(f"{where}: {name} is not a {what}{did_you_mean(name, names)}")
