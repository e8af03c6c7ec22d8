"""Shots, lofts and simulations."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from contextlib import AbstractContextManager, suppress
from dataclasses import replace
from pathlib import Path
from typing import Any

from ringlet import io, rest, sim
from ringlet import shot as shots
from ringlet.api.caches import is_still, scalp_clip
from ringlet.api.grooms import load_groom, read_recipe
from ringlet.api.progress import OnFrame, Progress
from ringlet.data.cache import Cache, SimulationRecord
from ringlet.data.curves import Curves
from ringlet.data.digest import digest
from ringlet.data.errors import UserError
from ringlet.data.files import check_place, same_place, within
from ringlet.data.groom import Groom
from ringlet.data.reads import record, recorded, unrecorded
from ringlet.data.settings import read_toml
from ringlet.data.toml import merged, tables_of, to_toml
from ringlet.deform.orientation import outward
from ringlet.rest.loft import Loft
from ringlet.shot import Shot
from ringlet.sim import Checkpoints, Garment, Motion, Obstacle


def read_shot(path: Path | str, settings: Mapping[str, Any] | None = None) -> Shot:
    """Reads a shot from a TOML file, with every setting checked.

    settings: values in place of those of the file, by name, such as ``{"strands.damping": 0.2}``
    """
    path = Path(path)
    if not settings:
        return shots.read_shot(path)
    _, tables = read_toml(path, "shot")
    return shots.parse_shot(to_toml(merged(tables, tables_of(settings))), path)


def input_files(shot: Path | str, groom: Path | str | None = None) -> list[Path]:
    """All files that a shot is made of, its own first: grooms, heads, meshes and pictures, layers of USD included.

    groom: a recipe or a groom in place of the shot's
    """
    with recorded() as read:
        settings = read_shot(shot)
        files = settings.named_files()
        files.pop("rest.file", None)  # it is made on the way
        files["groom"] = Path(groom or files["groom"])
        if files["groom"].suffix == ".toml":
            files |= read_recipe(files["groom"]).named_files()
        for file in files.values():
            if file.suffix in io.USD_SUFFIXES:
                io.read_space(file)  # which records the layers
            else:
                record(file)
    return read.files()


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
    checkpoints: a folder for checkpoints; to be removed when the result has been written
    resume:      continue an interrupted run from its checkpoints, to the same bits
    touches:     keep the contacts of every frame, for ``write_touches``
    """
    if not isinstance(shot, shots.Shot):
        shot = read_shot(shot)
    groom = as_simulated(groom or shot.groom, progress)
    with recorded() as read:
        contents = contents_of(shot, groom, allow_stale, frames)
    inputs = sim.run_inputs(shot, groom, read, frames) if checkpoints else {}
    cache = sim.simulate(
        shot,
        groom,
        frames=frames,
        checkpoints=_checkpoints(checkpoints, groom, inputs) if checkpoints else None,
        resume=resume,
        touches=touches,
        progress=progress,
        **contents,
    )
    cache.notes = _untouched(shot, groom)
    return cache


def write_simulation(
    shot: Shot,
    groom: Groom,
    under: Path | str,
    path: Path | str,
    *,
    checkpoints: Path | str,
    write_under: bool = False,
    frames: tuple[int, int] | None = None,
    allow_stale: bool = False,
    resume: bool = False,
    touches: bool = False,
    progress: Progress | None = None,
    on_frame: OnFrame | None = None,
    on_warning: Callable[[str], None] | None = None,
) -> SimulationRecord:
    """``simulate`` and ``write_cache`` in one, with one frame at a time in memory, however long the shot is.

    under:       the USD file that ``write_groom`` made of the groom, the layer below the cache
    checkpoints: the folder of the frames, which are written to ``path`` when all are done
    write_under: writes ``under`` when all are done, so that an earlier cache at ``path`` keeps its groom until then
    resume:      continue an interrupted run, to the same bits; a cache of it that is whole stays as it is
    touches:     keep the contacts of every frame there too, for ``write_touches``
    on_frame:    called with each frame's number and statistics, as soon as it is done
    on_warning:  called before the first frame with each sentence about settings or motion that make frames take long
    """
    io.check_target(path, under)
    groom = as_simulated(groom)
    with recorded() as read:
        contents = contents_of(shot, groom, allow_stale, frames)
        check_place(path)
    inputs = sim.run_inputs(shot, groom, read, frames)
    kept, made_from = _checkpoints(checkpoints, groom, inputs), digest(inputs, frames or shot.frames)
    first, last = frames or shot.frames
    _warn_of_work(shot, groom, contents, (first, last), on_warning)
    motion = sim.Motion(shot, groom, first=first, **contents)
    record = SimulationRecord(
        start=motion.start,
        cloths={garment.name: len(garment.cloth.positions) for garment in motion.garments},
        notes=_untouched(shot, groom),
    )
    if resume and not touches and (whole := _whole(path, made_from)):
        if write_under:
            io.write_groom(groom, Path(under))
        record.frames, record.statistics = whole
        return record
    for frame in sim.play(motion, last, touches=touches, progress=progress, checkpoints=kept, resume=resume):
        if on_frame:
            on_frame(frame.number, frame.statistics)
    steps = shot.preroll + last - first + 1
    if touches:
        record.touches = sim.StoredTouches(motion, kept, steps)
    if write_under:
        io.write_groom(groom, Path(under))
    with io.CacheWriter(path, under, io.read_space(Path(under)), motion.cloths(0), groom.variant) as writer:
        writer.start, writer.made_from = motion.start, made_from
        for frame in sim.replay(motion, kept, steps):
            record.frames.append(frame.number)
            record.statistics.append(frame.statistics)
            around = contents["clip"].at(frame.number)
            writer.add(frame.number, frame.points, frame.statistics, frame.cloths, around=around)
    return record


def _whole(path: Path | str, made_from: str) -> tuple[list[float], list[dict[str, Any]]] | None:
    """Frames and statistics of a cache that is made from the same; None for another one, and without one."""
    if not Path(path).exists():
        return None
    try:
        with unrecorded(), io.open_cache(path) as cache:
            return (cache.frames.tolist(), cache.statistics) if cache.made_from == made_from else None
    except UserError:
        return None


def hold_checkpoints(folder: Path | str) -> AbstractContextManager[int]:
    """Locks a folder of checkpoints for this program while the block runs, also before there are any.

    For programs that write other files of a run, such as its head, before ``write_simulation``. An empty folder is
    removed after the block. Gives the number of steps (frames, and those of the preroll) after which an interrupted run
    can ``resume``, 0 for none. Raises UserError where another run has locked it.

    Example::

        with ringlet.hold_checkpoints("cache.usdc.part"):
            ringlet.write_simulation(
                shot, groom, "groom.usdc", "cache.usdc", checkpoints="cache.usdc.part", write_under=True
            )
            ringlet.discard_checkpoints("cache.usdc.part")
    """
    return sim.locked_folder(Path(folder))


def discard_checkpoints(folder: Path | str) -> None:
    """Removes the checkpoints of a run whose result has been written; a kill meanwhile leaves what can be resumed."""
    with suppress(OSError):  # the result is there
        sim.discard(Path(folder))


def run_inputs(shot: Shot, groom: Groom, *, frames: tuple[int, int] | None = None) -> dict[str, Any]:
    """All that a simulation depends on, as plain values: two runs with the same inputs give the same bits.

    These are the settings, the groom, and the files that are read, by their contents.
    """
    groom = as_simulated(groom)
    with recorded() as read:
        contents_of(shot, groom, False, frames)
    return sim.run_inputs(shot, groom, read, frames)


def can_resume(folder: Path | str, inputs: dict[str, Any]) -> bool:
    """Whether a folder has checkpoints of a run with the same inputs."""
    before = sim.left_inputs(Path(folder))
    return before is not None and sim.changed_input(before, inputs) is None


def start_motion(
    shot: Shot,
    groom: Groom | Path | str,
    *,
    allow_stale: bool = False,
    on_warning: Callable[[str], None] | None = None,
) -> Motion:
    """The locks of a groom at the start of a shot, for callers that advance it frame by frame.

    on_warning: as for ``write_simulation``
    """
    groom = as_simulated(groom)
    contents = contents_of(shot, groom, allow_stale)
    _warn_of_work(shot, groom, contents, shot.frames, on_warning)
    return sim.Motion(shot, groom, first=shot.frames[0], **contents)


def _warn_of_work(
    shot: Shot,
    groom: Groom,
    contents: dict[str, Any],
    frames: tuple[int, int],
    on_warning: Callable[[str], None] | None,
) -> None:
    if on_warning is not None:
        for sentence in sim.heavy_work(shot, groom, contents["clip"], contents["obstacles"], frames):
            on_warning(sentence)


def as_simulated(groom: Groom | Path | str, progress: Progress | None = None) -> Groom:
    """The groom of a shot, rounded as in its file, also where it comes from a recipe.

    Steps end before they converge to the last digit, and differences there grow.
    """
    return io.as_written(groom if isinstance(groom, Groom) else load_groom(groom, progress=progress))


def contents_of(shot: Shot, groom: Groom, allow_stale: bool, frames: tuple[int, int] | None = None) -> dict[str, Any]:
    """The contents of the files that a shot and its groom name: the further arguments of ``sim.simulate``.

    frames: in place of the shot's
    """
    frames = frames or shot.frames
    sim.check_frames(*frames)
    clip, garments = scalp_clip(groom, frames), _garments(shot, groom, frames)
    obstacles = _obstacles(shot, groom, garments, frames)
    rest = _rest_shape(shot, groom, obstacles, allow_stale)
    return {"clip": clip, "rest": rest, "obstacles": obstacles, "garments": garments}


def _checkpoints(folder: Path | str, groom: Groom, inputs: dict[str, Any]) -> Checkpoints:
    """The checkpoints of a run."""
    return sim.Checkpoints(Path(folder), inputs, every=sim.frames_between(len(groom.locks.points)))


def loft(
    shot: Shot | Path | str,
    groom: Groom | Path | str | None = None,
    *,
    known: Path | str | None = None,
    sag: bool = False,
    progress: Progress | None = None,
) -> Loft:
    """Finds the rest shape of the locks with which they hang as groomed under the forces of the shot.

    groom: in place of the one that the shot names
    known: a file that ``write_loft`` wrote: locks that have not changed since are taken from it
    sag:   find how the locks hang without the loft too, which equilibrium does not need
    """
    if not isinstance(shot, shots.Shot):
        shot = read_shot(shot)
    groom = as_simulated(groom or shot.groom, progress)
    obstacles = _supporting_bodies(shot, groom)
    if known is None or not Path(known).exists():
        made = rest.solve_rest_shape(shot, groom, obstacles=obstacles, progress=progress)
    else:
        with unrecorded():  # it may be written anew
            stored = io.read_rest(Path(known))
        made = rest.update_rest_shape(shot, groom, *stored, obstacles=obstacles, progress=progress)
    return rest.with_sag(made, shot) if sag else made


def rest_place(shot: Shot) -> Path:
    """The default file of a shot's loft, which must be beside the shot or below."""
    assert shot.path is not None and shot.rest_file is not None  # a shot from a file has a place for it
    return within(shot.rest_file, shot.path.parent, f"{shot.path.name}: rest.file")


@recorded()
def write_loft(loft: Loft, shot: Shot, path: Path | str) -> None:
    """Writes a rest shape, with all that it depends on, for ``simulate``."""
    made_from = rest.dependencies(shot, _supporting_bodies(shot, loft.groom))
    io.write_rest(rest.to_curves(loft, shot), made_from, Path(path), loft.groom.space, around=loft.groom.scalp.points)


def _supporting_bodies(shot: Shot, groom: Groom) -> list[Obstacle]:
    """The bodies that may support a groom, where its rest shape depends on them."""
    if shot.rest.mode != "equilibrium" or groom.scalp_file is None:
        return []
    return _obstacles(shot, groom, _garments(shot, groom, shot.frames), shot.frames)


def _rest_shape(shot: Shot, groom: Groom, obstacles: Sequence[Obstacle], allow_stale: bool) -> Curves | None:
    """The rest shape of the locks: None for the groom, or a stored one that fits."""
    if shot.rest.mode == "none":
        return None
    if shot.rest_file is None:
        raise UserError(
            f"shot: rest.mode is '{shot.rest.mode}', but rest.file is missing; name what ringlet loft wrote"
        )
    if not shot.rest_file.exists():
        raise UserError(f"{shot.rest_file}: there is no such rest shape; make it with: ringlet loft {shot.path}")
    kept, made_from = io.read_rest(shot.rest_file)
    return rest.check_current(
        kept, made_from, shot, groom, shot.rest_file, obstacles=obstacles, allow_stale=allow_stale
    )


def _obstacles(shot: Shot, groom: Groom, garments: Sequence[Garment], frames: tuple[int, int]) -> list[Obstacle]:
    """The obstacles of a shot at its frames; of several settings for one mesh the last counts."""
    if not shot.touching:
        return []
    found: dict[tuple[Path, str], Obstacle] = {}
    for collider in shot.collider or (shots.Collider(),):
        file = collider.file or groom.scalp_file
        assert file is not None  # as for the scalp's clip
        if collider.file is None and is_still(groom):
            bodies = [io.Body(groom.scalp, scalp_clip(groom, frames), groom.scalp.name)]
        else:
            of_head = groom.scalp_file is not None and file.resolve() == groom.scalp_file.resolve()
            bodies = io.read_bodies(file, collider.mesh, frames, groom.space.fps, groom.cage and of_head)
            if of_head and collider.mesh is None:
                bodies = [body for body in bodies if groom.shows(body.prim)]
        for body in bodies:
            triangles = outward(body.mesh.points, body.mesh.triangles, groom.scalp.points)
            found[file.resolve(), body.prim] = sim.Obstacle(
                replace(body.mesh, triangles=triangles), body.clip, collider
            )
    for garment in garments:  # cloth is no obstacle, even where its file is the head's
        assert garment.file is not None
        found.pop((garment.file.resolve(), garment.prim), None)
    return list(found.values())


def _untouched(shot: Shot, groom: Groom) -> list[str]:
    """A sentence for each visible surface in the files of a shot's colliders that hair does not touch."""
    if not shot.touching:
        return []
    named = [one.mesh for one in (*shot.collider, *shot.cloth) if one.mesh is not None]
    notes = list[str]()
    for collider in shot.collider or (shots.Collider(),):
        file = collider.file or groom.scalp_file
        if file is not None and not (collider.file is None and is_still(groom)):
            notes += io.unread_surfaces(file, collider.mesh, [name for name in named if name != collider.mesh])
    return list(dict.fromkeys(notes))


def cloths_and_colliders(shot: Shot, groom: Groom) -> tuple[list[Garment], list[Obstacle]]:
    """The visible meshes of a shot besides those of the head's file: its cloths, and colliders of other files."""
    garments = _garments(shot, groom, shot.frames)
    apart = tuple(collider for collider in shot.collider if collider.file not in (None, groom.scalp_file))
    of_files = shot.model_copy(update={"collider": apart})
    obstacles = _obstacles(of_files, groom, garments, shot.frames) if apart else []
    return garments, [obstacle.starting_at(shot.frames[0]) for obstacle in obstacles]


def _garments(shot: Shot, groom: Groom, frames: tuple[int, int]) -> list[Garment]:
    """The meshes that become cloth in a shot, at its frames."""
    garments: list[Garment] = []
    for cloth in shot.cloth:
        file = cloth.file or groom.scalp_file
        assert file is not None  # as for the scalp's clip
        body = io.read_body(file, cloth.mesh, frames, groom.space.fps, cage=True)
        garment = sim.Garment(body.mesh, body.clip, cloth, file, body.prim)
        what = f"shot: cloth[{len(garments)}].mesh is {body.prim}"
        surface = body if groom.cage else io.read_body(file, cloth.mesh, frames, groom.space.fps)
        if sim.Obstacle(surface.mesh, surface.clip).is_surface_of(groom.scalp):
            raise UserError(f"{what}, the scalp that hair grows on; name another mesh")
        if any(other.prim == body.prim and same_place(other.file or file, file) for other in garments):
            raise UserError(f"{what}, which is a cloth already; take one of them away")
        if garment.name in [other.name for other in garments]:
            raise UserError(f"shot: two cloths are called '{garment.name}'; give one of them another `name`")
        garments.append(garment)
    return garments
