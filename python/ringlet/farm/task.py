"""One task of a wedge: simulates its shot, draws a frame and writes the results to its folder.

- shot.toml: the shot with the settings of the task
- cache.usdc: the simulation; while it runs, cache.usdc.part has the checkpoints to resume from
- still.png: a still of one frame
- places.npy: positions of the locks at that frame [m], shape (n, 3)
- result.json: results in numbers
- log.txt: log with times and machines
"""

from __future__ import annotations

import json
import os
import socket
import time
import traceback
from collections.abc import Callable, Sequence
from contextlib import ExitStack
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Literal

import numpy as np

from ringlet.api.caches import open_cache
from ringlet.api.grooms import load_groom, write_groom
from ringlet.api.hairs import write_hairs
from ringlet.api.pictures import write_still
from ringlet.api.shots import (
    can_resume,
    discard_checkpoints,
    hold_checkpoints,
    loft,
    read_shot,
    run_inputs,
    write_loft,
    write_simulation,
)
from ringlet.api.threads import use_threads
from ringlet.data.digest import digest
from ringlet.data.errors import UserError
from ringlet.data.files import replacing
from ringlet.data.groom import Groom
from ringlet.data.regular import read_text
from ringlet.farm.grid import Task
from ringlet.groom import hair_count
from ringlet.report import percent
from ringlet.shot import Shot

FORMAT = 1
RESULT, CACHE, PLACES = "result.json", "cache.usdc", "places.npy"
PART = f"{CACHE}.part"
WRITTEN = ("shot.toml", "groom.usdc", "rest.usdc", CACHE, "hair.usdc", "still.png", PLACES, RESULT, "log.txt")
HAIRS = 6000  # number of hairs in a picture
PICTURE: dict[str, Any] = {"width": 420, "height": 470, "samples": 16}
SERIES = ("wall_ms", "max_stretch")  # statistics of each frame in the result

Progress = Callable[[int, int], None]


@dataclass(frozen=True)
class TaskOptions:
    """Options of all tasks of a wedge.

    frames:  first and last frame, instead of the shot's
    frame:   frame to draw and compare; by default the last
    picture: whether to draw a still
    threads: threads of each task; by default all
    """

    frames: tuple[int, int] | None = None
    frame: int | None = None
    picture: bool = True
    threads: int | None = None


@dataclass(frozen=True)
class Result:
    """Result of a task.

    state:     ``done``; ``refused`` for settings or files that are not valid; ``failed`` for other errors
    message:   error message of a task that is not done
    made_from: digest of all inputs
    seconds:   duration of the simulation [s]
    numbers:   results by name
    series:    numbers of every frame by name
    order:     as in ``Task``
    """

    settings: dict[str, Any]
    state: Literal["done", "refused", "failed"]
    message: str = ""
    made_from: str = ""
    seconds: float = 0.0
    numbers: dict[str, float] | None = None
    series: dict[str, list[float]] | None = None
    order: Sequence[int] = ()


def run_task(task: Task, options: TaskOptions, progress: Progress | None = None) -> Result:
    """Runs a task, or resumes it from its checkpoints.

    progress: called with (frames done, their number)

    A UserError gives a result in the state ``refused``. Other exceptions propagate, so that the task can be retried.
    A task that is in progress in another process is refused, and its folder stays unchanged.
    """
    if options.threads:
        use_threads(options.threads)
    task.folder.mkdir(parents=True, exist_ok=True)
    with ExitStack() as lock:
        try:
            lock.enter_context(hold_checkpoints(task.folder / PART))
        except UserError as error:
            return Result(task.settings, "refused", str(error), order=task.order)
        return _run(task, options, progress)


def _run(task: Task, options: TaskOptions, progress: Progress | None) -> Result:
    """Runs a task in a locked folder."""
    log = Log(task.folder / "log.txt")
    log(f"begins: {task.name}")
    begin = time.perf_counter()
    try:
        result = _simulate(task, options, log, progress or (lambda done, total: None))
    except UserError as error:
        log(f"refused: {error}")
        result = Result(task.settings, "refused", str(error), order=task.order)
    except Exception:
        log(f"failed:\n{traceback.format_exc()}")
        raise
    write_result(task.folder, result)
    if result.state == "done":
        discard_checkpoints(task.folder / PART)
    log(f"ends after {time.perf_counter() - begin:.1f} s: {result.state}")
    return result


class Log:
    """A log file; each line has the time, the machine and the process."""

    def __init__(self, path: Path) -> None:
        self._path, self._source = path, f"{socket.gethostname()} {os.getpid()}"

    def __call__(self, line: str) -> None:
        """Appends a line."""
        with self._path.open("a", encoding="utf-8") as file:
            file.write(f"{time.strftime('%Y-%m-%d %H:%M:%S')} {self._source} {line}\n")


def write_result(folder: Path, result: Result) -> None:
    """Writes the result of a task."""
    with replacing(folder / RESULT) as aside:
        aside.write_text(json.dumps({"ringlet": FORMAT, **vars(result)}, indent=1), encoding="utf-8")


def read_result(folder: Path) -> Result | None:
    """Reads the result of a task; None when there is none, or one of another format."""
    try:
        values = json.loads(read_text(folder / RESULT))
        return Result(**values) if values.pop("ringlet") == FORMAT else None
    except (UserError, ValueError, KeyError, TypeError):
        return None


def _simulate(task: Task, options: TaskOptions, log: Log, progress: Progress) -> Result:
    shot_file, cache, part = (task.folder / name for name in ("shot.toml", CACHE, PART))
    with replacing(shot_file) as aside:
        aside.write_text(task.shot, encoding="utf-8")
    shot = read_shot(shot_file)
    groom, groom_file = _groom(shot, task.folder, log)
    inputs = run_inputs(shot, groom, frames=options.frames)
    made_from = digest(inputs, options.frames, options.frame, options.picture)
    previous = read_result(task.folder)
    if previous and previous.state == "done" and previous.made_from == made_from and _complete(task.folder, options):
        log("is done already")
        return previous

    first, last = options.frames or shot.frames
    resume = can_resume(part, inputs)
    log(f"{'goes on with' if resume else 'simulates'} frames {first}:{last}, {len(groom.locks)} locks")
    begin, done = time.perf_counter(), 0

    def frame_done(frame: float, statistics: dict[str, Any]) -> None:
        nonlocal done
        done += 1
        log(f"frame {frame:g}: {_one_line(statistics)}")
        progress(done, last - first + 1)

    simulated = write_simulation(
        shot,
        groom,
        groom_file,
        cache,
        checkpoints=part,
        frames=options.frames,
        resume=resume,
        on_frame=frame_done,
        on_warning=lambda sentence: log(f"warning: {sentence}"),
    )
    seconds = time.perf_counter() - begin
    frame = last if options.frame is None else options.frame
    numbers = {**_numbers_of_statistics(simulated.statistics), **_numbers_of_motion(task.folder, groom, cache, frame)}
    if options.picture:
        log(f"draws frame {frame}")
        _draw(task.folder, groom, groom_file, cache, frame)
    series = {name: [float(frame.get(name, 0.0)) for frame in simulated.statistics] for name in SERIES}
    return Result(task.settings, "done", "", made_from, round(seconds, 3), numbers, series, task.order)


def _complete(folder: Path, options: TaskOptions) -> bool:
    """Whether the files of a task that is done are still there."""
    return all((folder / name).exists() for name in (CACHE, PLACES, *(["still.png"] if options.picture else [])))


def _groom(shot: Shot, folder: Path, log: Log) -> tuple[Groom, Path]:
    """The groom of a shot and its USD file; writes the rest shape when the shot has one."""
    groom, groom_file = load_groom(shot.groom), shot.groom
    if shot.groom.suffix == ".toml":
        groom_file = folder / "groom.usdc"
        write_groom(groom, groom_file)
    if shot.rest.mode != "none":
        assert shot.rest_file is not None
        log(f"lofts, for the rest shape '{shot.rest.mode}'")
        write_loft(loft(shot, groom, known=shot.rest_file), shot, shot.rest_file)
    return groom, groom_file


def _one_line(statistics: dict[str, Any]) -> str:
    if "newton" not in statistics:
        return "the start"
    contact = statistics.get("contact")
    contacts = f", {contact['contacts']} contacts" if contact else ""
    return (
        f"{statistics['wall_ms']:.0f} ms, {statistics['newton']:.1f} Newton iterations, "
        f"stretch {percent(statistics['max_stretch'])}{contacts}"
    )


def _numbers_of_statistics(statistics: list[dict[str, Any]]) -> dict[str, float]:
    statistics = [frame for frame in statistics if "newton" in frame]  # there is no step at the first
    contacts = [frame["contact"] for frame in statistics if "contact" in frame]
    if not statistics:
        return {}
    return {
        "seconds a frame": float(np.mean([1e-3 * frame["wall_ms"] for frame in statistics])),
        "slowest frame, s": max(1e-3 * frame["wall_ms"] for frame in statistics),
        "most stretch, %": max(100 * frame["max_stretch"] for frame in statistics),
        "not converged": float(sum(frame["unconverged"] for frame in statistics)),
        "flips": float(sum(frame["flips"] for frame in statistics)),
        **({"contacts, mean": float(np.mean([one["contacts"] for one in contacts]))} if contacts else {}),
    }


def _numbers_of_motion(folder: Path, groom: Groom, cache: Path, frame: int) -> dict[str, float]:
    """Distance from root to tip, and its range over the frames; writes the positions at a frame.

    Raises UserError for a frame that was not simulated.
    """
    offsets = groom.locks.offsets
    extents: list[np.ndarray] = []  # distance from root to tip of each lock, by frame
    with open_cache(cache) as simulated:
        if frame not in simulated.frames:
            span = f"{simulated.frames[0]:g} to {simulated.frames[-1]:g}"
            raise UserError(f"wedge: frame {frame} is not among those simulated, {span}; choose another with --frame")
        for at in simulated.frames:
            points = simulated.points(at)
            extents.append(np.linalg.norm(points[offsets[1:] - 1] - points[offsets[:-1]], axis=1))
            if at == frame:
                with replacing(folder / PLACES) as aside, aside.open("wb") as file:
                    np.save(file, points)
    return {
        "change of root to tip, mm": float(1e3 * np.ptp(extents, axis=0).mean()),
        "root to tip, mm": float(1e3 * extents[-1].mean()),
    }


def _draw(folder: Path, groom: Groom, groom_file: Path, cache: Path, frame: int) -> None:
    hairs = folder / "hair.usdc"
    fraction = min(1.0, HAIRS / hair_count(groom))
    write_hairs(groom_file, hairs, cache=cache, frames=(frame, frame), fraction=fraction, wider=True)
    write_still(hairs, folder / "still.png", frame=frame, **PICTURE)
    hairs.unlink()
