"""A wedge: one shot with several values of some settings, simulated, drawn and compared."""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

from ringlet.api.progress import Progress
from ringlet.api.shots import read_shot
from ringlet.data import limits
from ringlet.data.errors import UserError
from ringlet.data.extras import need
from ringlet.data.files import check_place
from ringlet.data.reads import record, recorded, refuse_inputs
from ringlet.farm.cluster import run_on_workers
from ringlet.farm.grid import Choice, Task, choose, make_tasks
from ringlet.farm.openjd import write_template
from ringlet.farm.page import PAGE, read_results, write_page
from ringlet.farm.task import WRITTEN, Result, TaskOptions, run_task


@recorded()
def wedge(
    shot: Path | str,
    settings: Mapping[str, Sequence[Any] | str],
    folder: Path | str,
    *,
    frames: tuple[int, int] | None = None,
    frame: int | None = None,
    picture: bool = True,
    scheduler: str | None = None,
    here: bool = False,
    workers: int | None = None,
    threads: int | None = None,
    retries: int = 2,
    progress: Progress | None = None,
) -> list[dict[str, Any]]:
    """Simulates a shot with every combination of settings, and writes a page that compares them to ``folder``.

    Finished tasks are kept, and interrupted ones resume. Returns ``folder``, ``settings``, ``state`` (``done``,
    ``refused`` or ``failed``), ``message``, ``seconds`` and ``numbers`` of each task.

    settings:  values by the name of the setting: ``{"strands.bend_scale": [1, 2, 4], "contact.friction": "0.1,0.3"}``
    frames:    first and last frame, instead of the shot's
    frame:     frame to draw and compare; by default the last
    picture:   whether to draw a still of each task
    scheduler: address of a dask.distributed scheduler with workers that see the same folders; by default local workers
    here:      runs the tasks one after the other in this process, without dask
    workers:   number of local worker processes
    threads:   threads of each task; by default the processors divided by the workers
    retries:   number of times that a task may fail or lose its worker
    progress:  called with (name of a task, frames done, their number)
    """
    for what, count, most in (("workers", workers, limits.WORKERS), ("threads", threads, limits.THREADS)):
        if count is not None:
            limits.check_count(f"wedge: {what}", count, most)
    if picture and scheduler is None:
        need("mitsuba")
    folder = Path(folder).absolute()
    tasks = make_tasks(Path(shot).absolute(), _choices(settings), folder)
    record(*read_shot(shot).named_files().values())
    for task in tasks:
        for name in WRITTEN:
            refuse_inputs(task.folder / name)
    check_place(folder / PAGE)
    options = TaskOptions(frames, frame, picture, threads)
    if here:
        results = [run_task(task, options, _task_progress(task, progress)) for task in tasks]
    else:
        if scheduler is None:
            processors = os.cpu_count() or 1
            workers = workers or min(len(tasks), processors)
            options = replace(options, threads=threads or max(1, processors // workers))
        results = run_on_workers(
            tasks, options, scheduler=scheduler, workers=workers, retries=retries, progress=progress or _no_progress
        )
    if read_results(folder):  # empty when other processes run all tasks
        write_page(folder, f"Wedge of {Path(shot).name}")
    return [_summary(task.folder, result) for task, result in zip(tasks, results, strict=True)]


def compare_wedge(shot: Path | str, folder: Path | str) -> list[dict[str, Any]]:
    """Writes the page again from the results in the folder of a wedge; returns them like ``wedge``.

    Raises UserError for a folder without results.
    """
    folder = Path(folder)
    if not read_results(folder):
        raise UserError(f"{folder}: holds no results of a wedge; make them with: ringlet wedge SHOT --set …")
    return [_summary(at, result) for at, result in write_page(folder, f"Wedge of {Path(shot).name}").items()]


def write_wedge_template(
    path: Path | str,
    shot: Path | str,
    settings: Mapping[str, Sequence[Any] | str],
    *,
    frames: tuple[int, int] | None = None,
    frame: int | None = None,
    picture: bool = True,
    threads: int | None = None,
) -> int:
    """Writes a wedge as a template of Open Job Description, for a render farm; returns the number of its tasks."""
    choices = _choices(settings)
    tasks = make_tasks(Path(shot).absolute(), choices, Path(path).absolute().parent)  # validated before submission
    write_template(Path(path), Path(shot), choices, TaskOptions(frames, frame, picture, threads))
    return len(tasks)


def _choices(settings: Mapping[str, Sequence[Any] | str]) -> list[Choice]:
    return [choose(name, values) for name, values in settings.items()]


def _no_progress(name: str, done: int, total: int) -> None:
    """Ignores progress."""


def _task_progress(task: Task, progress: Progress | None) -> Any:
    return (lambda done, total: progress(task.name, done, total)) if progress else None


def _summary(folder: Path, result: Result) -> dict[str, Any]:
    return {
        "folder": str(folder),
        "settings": result.settings,
        "state": result.state,
        "message": result.message,
        "seconds": result.seconds,
        "numbers": result.numbers,
    }
