"""The page that compares the tasks of a wedge: pictures, numbers, and charts over the frames."""

from __future__ import annotations

import json
from collections.abc import Sequence
from html import escape
from itertools import zip_longest
from pathlib import Path

import numpy as np

from ringlet.data.errors import UserError
from ringlet.data.files import replacing
from ringlet.data.regular import open_regular
from ringlet.farm.task import PLACES, RESULT, Result, read_result
from ringlet.report import Picture, Table, document, figure, line_chart, table

PAGE = "wedge.html"
MAX_LINES = 6  # largest number of lines in a chart
MAX_COLUMNS = 6


def read_results(folder: Path) -> dict[Path, Result]:
    """Results of all tasks in a folder, by task folder, in the order of their settings."""
    found = {file.parent: result for file in folder.glob(f"*/{RESULT}") if (result := read_result(file.parent))}
    return dict(sorted(found.items(), key=lambda item: _order(item[1])))


def write_page(folder: Path, title: str) -> dict[Path, Result]:
    """Writes ``wedge.html`` and ``wedge.json`` from the results in a folder; returns the results."""
    results = read_results(folder)
    away = distances(results)
    with replacing(folder / PAGE) as aside:
        aside.write_text(page(results, away, title), encoding="utf-8")
    tasks = [{"folder": at.name, **vars(result), "away": away.get(at)} for at, result in results.items()]
    with replacing(folder / "wedge.json") as aside:
        aside.write_text(json.dumps({"ringlet": 1, "tasks": tasks}, indent=1), encoding="utf-8")
    return results


def page(results: dict[Path, Result], away: dict[Path, float], title: str) -> str:
    """HTML of the page. away: result of ``distances``."""
    done = sum(result.state == "done" for result in results.values())
    lead = f"<p>{done} of {len(results)} tasks are done.</p>"
    troubles = "".join(
        f'<p class="warning">{escape(_name(result))}: {escape(result.message)}</p>'
        for result in results.values()
        if result.state != "done"
    )
    head = f"<header>\n<p class='brand'>Ringlet</p>\n<h1>{escape(title)}</h1>\n{lead}{troubles}</header>"
    return document(title, "\n".join((head, _pictures(results), _numbers(results, away), _charts(results))))


def distances(results: dict[Path, Result]) -> dict[Path, float]:
    """Root-mean-square distance of each task's vertices from those of the first task at the compared frame [m].

    Tasks with other locks have no entry.
    """
    places = {at: _places(at / PLACES) for at, result in results.items() if result.state == "done"}
    first = next(iter(places.values()), None)
    return {
        at: float(np.sqrt(((points - first) ** 2).sum(axis=1).mean()))
        for at, points in places.items()
        if first is not None and points.shape == first.shape
    }


def _places(path: Path) -> np.ndarray:
    """Positions of the locks of a task [m], shape (n, 3)."""
    with open_regular(path, "run the wedge again") as file:
        try:
            return np.load(file, allow_pickle=False)
        except (ValueError, EOFError):
            raise UserError(f"{path}: is damaged; remove it and run the wedge again") from None


def _pictures(results: dict[Path, Result]) -> str:
    drawn = {at: result for at, result in results.items() if (at / "still.png").exists()}
    if not drawn:
        return ""
    figures = "".join(
        figure(Picture(path=str(at / "still.png"), caption=_name(result))) for at, result in drawn.items()
    )
    return (
        f'<section><div class="wedge" style="--columns: {_columns(list(results.values()))}">{figures}</div></section>'
    )


def _numbers(results: dict[Path, Result], away: dict[Path, float]) -> str:
    done = {at: result for at, result in results.items() if result.numbers}
    names = list(dict.fromkeys(name for result in done.values() for name in result.numbers or {}))
    rows = [
        [
            _name(result),
            f"{1e3 * away[at]:.3g}" if at in away else "",
            *(f"{(result.numbers or {}).get(name, float('nan')):.4g}" for name in names),
        ]
        for at, result in done.items()
    ]
    return table(Table(title="In numbers", columns=["", "from the first, mm", *names], rows=rows)) if rows else ""


def _charts(results: dict[Path, Result]) -> str:
    charted = [result for result in results.values() if result.series][:MAX_LINES]

    def chart(title: str, unit: str, name: str, factor: float) -> str:
        lines = {_name(result): [factor * value for value in (result.series or {})[name]] for result in charted}
        longest = max(map(len, lines.values()), default=0)
        padded = {name: values + [float("nan")] * (longest - len(values)) for name, values in lines.items()}
        return line_chart(title, unit, range(1, longest + 1), padded)

    if not charted:
        return ""
    charts = chart("Time for a frame", "s", "wall_ms", 1e-3) + chart("Longest edge", "%", "max_stretch", 100.0)
    note = f" (the first {len(charted)} tasks)" if len(charted) < len(results) else ""
    return f"<section><h2>Frame by frame{note}</h2><div class='charts'>{charts}</div></section>"


def _name(result: Result) -> str:
    return ", ".join(f"{name} = {value}" for name, value in result.settings.items()) or "as it is"


def _columns(results: Sequence[Result]) -> int:
    """Number of pictures in a row: the number of values of the last setting, if the grid is complete."""
    names = list(results[0].settings)
    if names and all(list(result.settings) == names for result in results):
        values = {str(result.settings[names[-1]]) for result in results}
        if len(results) % len(values) == 0 and 1 < len(values) <= MAX_COLUMNS:
            return len(values)
    return min(len(results), 4)


def _order(result: Result) -> list[tuple[int, float, str]]:
    """Sort key of a result: numbers by size, other values in the order in which they were given."""
    return [
        (0, float(value), "") if isinstance(value, int | float) else (1, float(k), str(value))
        for k, value in zip_longest(result.order, result.settings.values(), fillvalue=0)
    ]
