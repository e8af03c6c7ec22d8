"""Writes a report: ``report.json`` for machines, ``report.html`` for people."""

from __future__ import annotations

from pathlib import Path

from ringlet.data.files import replacing
from ringlet.report.model import RunReport
from ringlet.report.page import page


def write_report(report: RunReport, folder: Path | str) -> tuple[Path, Path]:
    """Writes both files to a folder and returns their paths; the page embeds its pictures."""
    folder = Path(folder)
    report = RunReport.model_validate(
        report.model_dump()
    )  # validates fields that were assigned later, and converts numpy values
    json_path, html_path = folder / "report.json", folder / "report.html"
    html = page(report)
    with replacing(json_path) as aside_json, replacing(html_path) as aside_html:
        aside_json.write_text(report.model_dump_json(indent=2) + "\n", encoding="utf-8")
        aside_html.write_text(html, encoding="utf-8")
    return json_path, html_path
