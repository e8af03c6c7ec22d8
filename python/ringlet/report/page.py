"""The report as one self-contained HTML page, without scripts."""

from __future__ import annotations

import base64
import io
from collections.abc import Iterable, Sequence
from html import escape
from pathlib import Path

from PIL import Image

from ringlet.data.errors import UserError
from ringlet.report.charts import line_chart
from ringlet.report.findings import PHASES, explain_slowest, explain_worst, series, summary, total, value
from ringlet.report.model import MadeFile, Picture, RunReport, Stage, Table
from ringlet.report.verdict import Finding, judge, ranges

STYLE = Path(__file__).with_name("style.css")

# Column titles of a frame's statistics, in the order of the table.
_COLUMNS = {
    "frame": "Frame",
    "wall_ms": "Time, ms",
    "cpu_ms": "CPU, ms",
    "newton": "Newton, mean",
    "newton_max": "Newton, most",
    "unconverged": "Unsolved",
    "line_search_cuts": "Steps cut",
    "residual": "Residual",
    "max_stretch": "Stretch",
    "clamped": "Clamped",
    "flips": "Flips",
    "winding_changes": "Winding",
    "too_straight": "Too straight",
    "nan": "Not finite",
    "contact.candidates": "Pairs",
    "contact.contacts": "Contacts",
    "contact.closest": "Closest, m",
    "contact.violations": "Kept apart",
    "contact.zone_vertices": "Held back",
    "contact.linear_iterations": "CG",
}


def page(report: RunReport) -> str:
    """HTML of the report."""
    body = "\n".join(
        section
        for section in (
            _header(report),
            _verdict(report),
            _outcome(report),
            *(figure(picture) for picture in report.pictures[1:]),
            *(table(each) for each in report.tables),
            _timings(report.stages),
            _simulation(report),
            _files(report),
            _limits(report),
        )
        if section
    )
    return document(report.name, body)


def document(title: str, body: str) -> str:
    """HTML document in the style of the reports."""
    return (
        '<!doctype html>\n<html lang="en">\n<head>\n<meta charset="utf-8"/>\n'
        '<meta name="viewport" content="width=device-width, initial-scale=1"/>\n'
        '<meta name="color-scheme" content="light dark"/>\n'
        f"<title>Ringlet · {escape(title)}</title>\n"
        f"<style>\n{STYLE.read_text(encoding='utf-8')}</style>\n</head>\n<body>\n<main>\n{body}\n</main>\n</body>\n</html>\n"
    )


def _header(report: RunReport) -> str:
    machine = report.machine
    facts = {
        "Made": f"{report.date:%d %B %Y, %H:%M} {report.date.tzname() or ''}".strip(),
        "Ringlet": report.version,
        "Machine": ", ".join(
            part
            for part in (
                machine.system,
                f"{machine.threads} thread{'s' * (machine.threads > 1)}" if machine.threads else "",
                machine.simd or "",
                f"Python {machine.python}",
            )
            if part
        ),
    }
    command = f"<pre><code>{escape(report.command)}</code></pre>" if report.command else ""
    return (
        f"<header>\n<p class='brand'>Ringlet</p>\n<h1>{escape(report.name)}</h1>\n{_facts(facts)}\n{command}\n</header>"
    )


def _verdict(report: RunReport) -> str:
    """Section on whether the simulation can be used, and what to look at."""
    if not report.statistics:
        return ""
    verdict = judge(report.statistics)

    def row(finding: Finding) -> list[str]:
        return [finding.what, ranges(finding.frames), ", ".join(map(str, finding.locks)) or "–", finding.remedy]

    rows = [row(finding) for finding in verdict.findings]
    columns = ["What is wrong", "Frames", "Locks", "What would help"]
    looks = table(Table(title="What to look at", columns=columns, rows=rows)) if rows else ""
    kind = "warning" if rows else "usable"
    return f'<section><h2 class="{kind}">{escape(verdict.headline)}</h2></section>{looks}'


def _outcome(report: RunReport) -> str:
    """Section with the first picture, counts, warnings and a summary."""
    numbers = "".join(
        f"<div><dd>{count:,}</dd><dt>{escape(what.replace('_', ' '))}</dt></div>".replace(",", "\u202f")
        for what, count in report.counts.items()
    )
    sentences = "".join(f"<p>{escape(sentence)}</p>" for sentence in summary(report.statistics))
    warnings = "".join(f'<p class="warning">{escape(warning)}</p>' for warning in report.warnings)
    text = (f'<dl class="counts">{numbers}</dl>' if numbers else "") + warnings + sentences
    hero = figure(report.pictures[0]) if report.pictures else ""
    beside = f"<div><h2>What was made</h2>{text}</div>" if text else ""
    return f'<section class="outcome">{hero}{beside}</section>' if hero or beside else ""


def figure(picture: Picture) -> str:
    """HTML of a picture with its caption, embedded as JPEG; raises UserError for an unreadable file."""
    path = Path(picture.path)
    try:
        with Image.open(path) as image:
            jpeg = io.BytesIO()
            image.convert("RGB").save(jpeg, "JPEG", quality=88, optimize=True, progressive=True)
            size = image.size
    except OSError as error:
        raise UserError(f"{path}: cannot be read as a picture ({error}); make it again or leave it out") from error
    data = base64.b64encode(jpeg.getvalue()).decode("ascii")
    caption = escape(picture.caption)
    return (
        f'<figure class="picture"><img src="data:image/jpeg;base64,{data}" width="{size[0]}" height="{size[1]}"'
        f' alt="{caption}"/><figcaption>{caption}</figcaption></figure>'
    )


def table(content: Table) -> str:
    """HTML of a table under its title."""
    head = "".join(f"<th scope='col'>{escape(name)}</th>" for name in content.columns)
    rows = "".join(
        f"<tr><th scope='row'>{escape(row[0])}</th>{''.join(f'<td>{escape(cell)}</td>' for cell in row[1:])}</tr>"
        for row in content.rows
    )
    return (
        f"<section><h2>{escape(content.title)}</h2><table><thead><tr>{head}</tr></thead><tbody>{rows}</tbody></table>"
        "</section>"
    )


def _timings(stages: Sequence[Stage]) -> str:
    if not stages:
        return ""
    longest = max(max(stage.wall_ms for stage in stages), 1e-9)
    whole = Stage(
        name="Together",
        wall_ms=sum(stage.wall_ms for stage in stages),
        cpu_ms=sum(stage.cpu_ms or 0.0 for stage in stages),
    )
    rows = "".join(
        f'<tr><th scope="row">{escape(stage.name)}</th><td class="bar" aria-hidden="true">'
        f'<i style="width:{100 * stage.wall_ms / longest:.1f}%"></i></td>'
        f"<td>{_duration(stage.wall_ms)}</td><td>{_duration(stage.cpu_ms)}</td></tr>"
        for stage in stages
    )
    return (
        "<section><h2>Where the time went</h2><table class='times'><thead><tr><th scope='col'>Stage</th>"
        "<th scope='col' aria-hidden='true'></th><th scope='col'>Time</th><th scope='col'>CPU, all threads</th></tr>"
        f"</thead><tbody>{rows}</tbody><tfoot><tr><th scope='row'>{whole.name}</th><td></td>"
        f"<td>{_duration(whole.wall_ms)}</td><td>{_duration(whole.cpu_ms)}</td></tr></tfoot></table></section>"
    )


def _simulation(report: RunReport) -> str:
    statistics = report.statistics
    if not statistics:
        return ""
    frames = series(statistics, "frame") or [float(k + 1) for k in range(len(statistics))]

    def chart(title: str, unit: str, keys: dict[str, str], change: Iterable[str] = (), factor: float = 1.0) -> str:
        """Chart with one line per available key; values of keys in ``change`` are relative to the first frame."""
        lines = {}
        for key, name in keys.items():
            values = series(statistics, key)
            if values is not None:
                start = values[0] if key in change else 0.0
                lines[name] = [factor * (value - start) for value in values]
        return line_chart(title, unit, frames, lines)

    terms = list(dict.fromkeys(term for frame in statistics for term in frame.get("energy") or {}))
    elastic = {f"energy.{term}": term for term in terms if term not in ("gravity", "kinetic")}
    moving = {"energy.kinetic": "kinetic", "energy.gravity": "gravity, since the first frame"}
    curl = {"flips": "flips", "winding_changes": "winding changes", "too_straight": "too straight"}
    difficulties = {"line_search_cuts": "steps cut short", "unconverged": "strands unsolved"}
    charts = "".join(
        (
            chart("Energy in the strands", "J", elastic),
            chart("Energy of motion and height", "J", moving, change=["energy.gravity"]),
            chart("Longest edge, over its rest length", "%", {"max_stretch": "stretch"}, factor=100.0),
            chart("Newton iterations for a strand", "", {"newton": "mean", "newton_max": "most"}),
            chart("Time for a frame", "s", {"wall_ms": "time", "cpu_ms": "CPU, all threads"}, factor=1e-3),
            chart("Steps that needed care", "", difficulties)
            if any(total(statistics, key) for key in difficulties)
            else "",
            chart("Curls that changed", "", curl) if any(total(statistics, key) for key in curl) else "",
        )
    )
    cloths = list(dict.fromkeys(name for frame in statistics for name in frame.get("cloth") or {}))
    charts += "".join(
        (
            chart("Cloth, stretched at most", "%", {f"cloth.{n}.max_stretch": n for n in cloths}, factor=100.0),
            chart("Energy of motion of cloth", "J", {f"cloth.{n}.energy.kinetic": n for n in cloths}),
            chart("Contacts", "", {"contact.candidates": "pairs looked at", "contact.contacts": "of them touch"}),
            chart("Closest two that touch", "m", {"contact.closest": "distance"}),
            chart(
                "Pairs that were kept from meeting",
                "",
                {"contact.violations": "pairs", "contact.zone_vertices": "vertices held back"},
            ),
            chart(
                "Motion that a frame misses, estimated",
                "m",
                {"contact.motion_missing": "mean over the hair", "contact.motion_tolerated": "may be missing"},
            ),
            chart("Largest step that was left", "m", {"residual": "of a vertex"}),
            chart("Conjugate gradients", "", {"contact.linear_iterations": "iterations"}),
            chart("Where a frame's time goes", "s", {f"contact.{p}_ms": p for p in PHASES}, factor=1e-3),
        )
    )
    sentences = [sentence for explain in (explain_worst, explain_slowest) if (sentence := explain(statistics))]
    lead = "".join(f"<p>{escape(sentence)}</p>" for sentence in sentences)
    settings = _facts({key.replace("_", " "): f"{value}" for key, value in report.settings.items()})
    return (
        f"<section><h2>The simulation</h2>{lead}{settings}<div class='charts'>{charts}</div>"
        f"{_frame_table(report)}</section>"
    )


def _frame_table(report: RunReport) -> str:
    statistics = report.statistics
    columns = {key: name for key, name in _COLUMNS.items() if series(statistics, key) is not None}
    head = "".join(f"<th scope='col'>{name}</th>" for name in columns.values())
    rows = "".join(
        f"<tr>{''.join(f'<td>{_cell(value(frame, key))}</td>' for key in columns)}</tr>" for frame in statistics
    )
    return (
        f"<details><summary>All {len(statistics)} frames as numbers</summary><div class='wide'><table>"
        f"<thead><tr>{head}</tr></thead><tbody>{rows}</tbody></table></div></details>"
    )


def _files(report: RunReport) -> str:
    if not report.files:
        return ""
    described = any(file.what for file in report.files)

    def row(file: MadeFile) -> str:
        contents = f"<td class='text'>{escape(file.what)}</td>" if described else ""
        return f"<tr><th scope='row'><code>{escape(file.path)}</code></th>{contents}<td>{_size(file.bytes)}</td></tr>"

    rows = "".join(row(file) for file in report.files)
    contents = "<th scope='col' class='text'>Holds</th>" if described else ""
    return (
        f"<section><h2>Files</h2><table><thead><tr><th scope='col'>File</th>{contents}<th scope='col'>Size</th></tr>"
        f"</thead><tbody>{rows}</tbody></table></section>"
    )


def _limits(report: RunReport) -> str:
    if not report.limits:
        return ""
    items = "".join(f"<li>{escape(limit)}</li>" for limit in report.limits)
    return f"<section><h2>Good to know</h2><ul>{items}</ul></section>"


def _facts(facts: dict[str, str]) -> str:
    entries = "".join(f"<div><dt>{escape(name)}</dt><dd>{escape(value)}</dd></div>" for name, value in facts.items())
    return f'<dl class="facts">{entries}</dl>' if entries else ""


def _duration(milliseconds: float | None) -> str:
    if milliseconds is None:
        return "–"
    if milliseconds < 1000.0:
        return f"{milliseconds:.3g} ms" if milliseconds < 100 else f"{milliseconds:.0f} ms"
    seconds = milliseconds / 1000.0
    return f"{seconds:.1f} s" if seconds < 60.0 else f"{seconds // 60:.0f} min {seconds % 60:.0f} s"


def _size(count: int) -> str:
    for factor, unit in ((1e9, "GB"), (1e6, "MB"), (1e3, "kB")):
        if count >= factor:
            return f"{count / factor:.1f} {unit}"
    return f"{count} B"


def _cell(value: object) -> str:
    return f"{value:.4g}" if isinstance(value, int | float) else "–"
