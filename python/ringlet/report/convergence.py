"""The page of ``ringlet converge``: what each setting keeps, what it costs, and the paths of the tips."""

from __future__ import annotations

from html import escape
from pathlib import Path

from ringlet.data.convergence import Convergence, Trial
from ringlet.data.files import replacing
from ringlet.report.charts import line_chart
from ringlet.report.model import Table
from ringlet.report.page import document, table

COLUMNS = ["Iterations to tolerance", "motion kept, %", "off, mm", "strain, %", "CPU a frame, ms"]


def rows(result: Convergence) -> list[list[str]]:
    """A row of each trial, and of the converged run."""
    return [
        [
            f"{trial.name}{marks(result, trial)}",
            f"{100 * trial.kept:.0f}",
            f"{1e3 * trial.off:.2f}",
            f"{100 * trial.stretch:.2g}",
            f"{trial.cpu_ms:.0f}",
        ]
        for trial in (*result.trials, result.converged)
    ]


def marks(result: Convergence, trial: Trial) -> str:
    """What a trial is besides its numbers."""
    roles = {"the shot's": result.shipped, "advised": result.advised, "converged": result.converged}
    names = [name for name, one in roles.items() if one is trial]
    return f" ({', '.join(names)})" if names else ""


def advice(result: Convergence) -> str:
    """What to do, in a sentence or two."""
    first, last = result.frames
    shipped, advised = result.shipped, result.advised
    said = f"From frame {first} to {last} the shot's setting keeps {100 * shipped.kept:.0f} % of the converged motion."
    if advised is None:
        best = max(result.trials, key=lambda trial: trial.kept)
        return f"{said} No setting keeps {100 * result.enough:.0f} %; {best.name} keeps most, {100 * best.kept:.0f} %."
    if advised is shipped:
        return f"{said} That is enough, and nothing quicker is."
    newton, tolerance = advised.name.split(" to ")
    return (
        f"{said} Set solver.newton = {newton} and solver.linear_tolerance = {tolerance}, which keep "
        f"{100 * advised.kept:.0f} % in {advised.cpu_ms / max(shipped.cpu_ms, 1e-9):.2f} times the time."
    )


def write_page(result: Convergence, path: Path, title: str) -> None:
    """Writes the page."""
    first, last = result.frames
    trials = [*result.trials, result.converged]
    tips = {f"{trial.name}{marks(result, trial)}": trial.tips for trial in trials}
    charts = line_chart("Tips, from where they began", "m", range(first, last + 1), tips)
    head = f"<header>\n<p class='brand'>Ringlet</p>\n<h1>{escape(title)}</h1>\n<p>{escape(advice(result))}</p></header>"
    numbers = table(Table(title="In numbers", columns=COLUMNS, rows=rows(result)))
    page = document(title, f"{head}\n{numbers}\n<section><div class='charts'>{charts}</div></section>")
    with replacing(path) as aside:
        aside.write_text(page, encoding="utf-8")
