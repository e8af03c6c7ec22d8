"""One task of a wedge: its shot is simulated, a frame of it is drawn, and what it gave is told in its folder.

shot.toml    the shot with the settings of this task
cache.usdc   the simulation; cache.usdc.part while it runs, from which a task that was broken off goes on
still.png    a frame
places.npy   where the locks are at that frame [m], shape (n, 3)
result.json  the outcome in numbers
log.txt      what happened when, on which machine
"""

from __future__ import annotations

import json
import os
import shutil
import socket
import time
import traceback
from collections.abc import Callable, Sequence
from contextlib import ExitStack
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Literal

import numpy as np

from ringlet import api
from ringlet.data.errors import UserError
from ringlet.data.files import replacing
from ringlet.data.groom import Groom
from ringlet.farm.grid import Task
from ringlet.groom import hair_count
from ringlet.shot import Shot

FORMAT = 1
RESULT, CACHE = "result.json", "cache.usdc"
PART = f"{CACHE}.part"
HAIRS = 6000  # of a picture
SERIES = ("wall_ms", "max_stretch")  # of all frames that are kept for the comparison

Tell = Callable[[int, int], None]


@dataclass(frozen=True)
class Wanted:
    """What all tasks of a wedge are asked for.

    frames:  first and last, in place of the shot's
    frame:   that is drawn and compared; the last by default
    picture: whether it is drawn
    threads: of each task; as many as there are by default
    """

    frames: tuple[int, int] | None = None
    frame: int | None = None
    picture: bool = True
    threads: int | None = None


@dataclass(frozen=True)
class Result:
    """What a task gave.

    state:    ``done``; ``refused``: its settings or files do not fit; ``failed``: it broke off
    message:  why, where it is not done
    made_from: a digest of what it was made from
    seconds:  that this took
    numbers:  the outcome, by name
    series:   numbers of every frame, by name
    order:    see ``Task``
    """

    settings: dict[str, Any]
    state: Literal["done", "refused", "failed"]
    message: str = ""
    made_from: str = ""
    seconds: float = 0.0
    numbers: dict[str, float] | None = None
    series: dict[str, list[float]] | None = None
    order: Sequence[int] = ()


def run_task(task: Task, wanted: Wanted, tell: Tell | None = None) -> Result:
    """Does a task, as far as it is not done yet. ``tell`` is called with the frames that are done and their number.

    What a user can cause makes a result that says so; anything else is raised, so that the task can be tried again.
    A task that another run is at is refused, and its folder left as it is.
    """
    if wanted.threads:
        api.use_threads(wanted.threads)
    task.folder.mkdir(parents=True, exist_ok=True)
    with ExitStack() as held:
        try:
            held.enter_context(api.hold_checkpoints(task.folder / PART))
        except UserError as error:
            return Result(task.settings, "refused", str(error), order=task.order)
        return _run(task, wanted, tell)


def _run(task: Task, wanted: Wanted, tell: Tell | None) -> Result:
    """``run_task`` in a folder that no other program is at."""
    log = Log(task.folder / "log.txt")
    log(f"begins: {task.name}")
    begin = time.perf_counter()
    try:
        result = _done(task, wanted, log, tell or (lambda done, total: None))
    except UserError as error:
        log(f"refused: {error}")
        result = Result(task.settings, "refused", str(error), order=task.order)
    except Exception:
        log(f"failed:\n{traceback.format_exc()}")
        raise
    write_result(task.folder, result)
    log(f"ends after {time.perf_counter() - begin:.1f} s: {result.state}")
    return result


class Log:
    """Adds lines with time, machine and process to a file."""

    def __init__(self, path: Path) -> None:
        self._path, self._who = path, f"{socket.gethostname()} {os.getpid()}"

    def __call__(self, line: str) -> None:
        """Adds a line."""
        with self._path.open("a", encoding="utf-8") as file:
            file.write(f"{time.strftime('%Y-%m-%d %H:%M:%S')} {self._who} {line}\n")


def write_result(folder: Path, result: Result) -> None:
    """Writes the outcome of a task."""
    with replacing(folder / RESULT) as aside:
        aside.write_text(json.dumps({"ringlet": FORMAT, **vars(result)}, indent=1), encoding="utf-8")


def read_result(folder: Path) -> Result | None:
    """The outcome of a task, None where there is none, or one that this version cannot read."""
    try:
        told = json.loads((folder / RESULT).read_text(encoding="utf-8"))
        return Result(**told) if told.pop("ringlet") == FORMAT else None
    except (OSError, ValueError, KeyError, TypeError):
        return None


def _done(task: Task, wanted: Wanted, log: Log, tell: Tell) -> Result:
    shot_file, cache, part = (task.folder / name for name in ("shot.toml", CACHE, PART))
    with replacing(shot_file) as aside:
        aside.write_text(task.shot, encoding="utf-8")
    shot = api.read_shot(shot_file)
    groom, under = _groom(shot, task.folder, log)
    made_from = f"{api.made_from(shot, groom, frames=wanted.frames)} {wanted.frames} {wanted.frame} {wanted.picture}"
    known = read_result(task.folder)
    if known and known.state == "done" and known.made_from == made_from and cache.exists():
        log("is done already")
        return known

    first, last = wanted.frames or shot.frames
    key = part / "made_from"
    goes_on = key.exists() and made_from.startswith(key.read_text())
    log(f"{'goes on with' if goes_on else 'simulates'} frames {first}:{last}, {len(groom.locks)} locks")
    begin, ended = time.perf_counter(), 0

    def frame_done(frame: float, statistics: dict[str, Any]) -> None:
        nonlocal ended
        ended += 1
        log(f"frame {frame:g}: {_in_a_line(statistics)}")
        tell(ended, last - first + 1)

    told = api.write_simulation(
        shot, groom, under, cache, checkpoints=part, frames=wanted.frames, resume=goes_on, on_frame=frame_done
    )
    seconds = time.perf_counter() - begin
    frame = last if wanted.frame is None else wanted.frame
    numbers = {**_of_statistics(told.statistics), **_of_places(task.folder, groom, cache, frame)}
    if wanted.picture:
        log(f"draws frame {frame}")
        _draw(task.folder, groom, under, cache, frame)
    shutil.rmtree(part, ignore_errors=True)
    series = {name: [float(frame[name]) for frame in told.statistics] for name in SERIES}
    return Result(task.settings, "done", "", made_from, round(seconds, 3), numbers, series, task.order)


def _groom(shot: Shot, folder: Path, log: Log) -> tuple[Groom, Path]:
    """The groom of a shot and its USD file, lofted where the shot is to remember that."""
    groom, under = api.load_groom(shot.groom), shot.groom
    if shot.groom.suffix == ".toml":
        under = folder / "groom.usdc"
        api.write_groom(groom, under)
    if shot.rest.mode != "none":
        assert shot.rest_file is not None
        log(f"lofts, for the rest shape '{shot.rest.mode}'")
        api.write_loft(api.loft(shot, groom, known=shot.rest_file), shot, shot.rest_file)
    return groom, under


def _in_a_line(statistics: dict[str, Any]) -> str:
    contact = statistics.get("contact")
    touching = f", {contact['contacts']} contacts" if contact else ""
    return (
        f"{statistics['wall_ms']:.0f} ms, {statistics['newton']:.1f} Newton iterations, "
        f"stretch {100 * statistics['max_stretch']:.2g} %{touching}"
    )


def _of_statistics(statistics: list[dict[str, Any]]) -> dict[str, float]:
    contacts = [frame["contact"] for frame in statistics if "contact" in frame]
    return {
        "seconds a frame": float(np.mean([1e-3 * frame["wall_ms"] for frame in statistics])),
        "slowest frame, s": max(1e-3 * frame["wall_ms"] for frame in statistics),
        "most stretch, %": max(100 * frame["max_stretch"] for frame in statistics),
        "not converged": float(sum(frame["unconverged"] for frame in statistics)),
        "flips": float(sum(frame["flips"] for frame in statistics)),
        **({"contacts, mean": float(np.mean([one["contacts"] for one in contacts]))} if contacts else {}),
    }


def _of_places(folder: Path, groom: Groom, cache: Path, frame: int) -> dict[str, float]:
    """How the locks hang at a frame, and how far they bounce; keeps where they are there."""
    offsets = groom.locks.offsets
    reach: list[np.ndarray] = []  # from root to tip, frame by frame
    with api.open_cache(cache) as moved:
        if frame not in moved.frames:
            held = f"{moved.frames[0]:g} to {moved.frames[-1]:g}"
            raise UserError(f"wedge: frame {frame} is not among those simulated, {held}; choose another with --frame")
        for at in moved.frames:
            points = moved.points(at)
            reach.append(np.linalg.norm(points[offsets[1:] - 1] - points[offsets[:-1]], axis=1))
            if at == frame:
                with replacing(folder / "places.npy") as aside, aside.open("wb") as file:
                    np.save(file, points)
    return {
        "bounce, mm": float(1e3 * np.ptp(reach, axis=0).mean()),
        "root to tip, mm": float(1e3 * reach[-1].mean()),
    }


def _draw(folder: Path, groom: Groom, under: Path, cache: Path, frame: int) -> None:
    hairs = folder / "hair.usdc"
    fraction = min(1.0, HAIRS / hair_count(groom))
    api.write_hairs(under, hairs, cache=cache, frames=(frame, frame), fraction=fraction, wider=True)
    api.write_still(hairs, folder / "still.png", frame=frame, width=420, height=470, samples=16)
    hairs.unlink()
