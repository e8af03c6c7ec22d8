"""Reports: complete, self-contained and written atomically."""

from __future__ import annotations

import json
import re
import xml.dom.minidom
from pathlib import Path

import numpy as np
import pytest
from PIL import Image
from ringlet.data.errors import UserError
from ringlet.report import Machine, MadeFile, Picture, RunReport, Stage, write_report
from ringlet.report.charts import line_chart, nice_ticks
from ringlet.report.findings import explain_slowest, explain_worst, summary
from ringlet.report.model import plain


def frames(count: int = 6) -> list[dict]:
    """Statistics as of a simulation, with numpy scalars."""
    return [
        {
            "frame": float(k + 1),
            "wall_ms": np.float32(20.0 + k),
            "newton": 2.5,
            "newton_max": np.int64(4),
            "unconverged": 0,
            "line_search_cuts": 1,
            "residual": float("nan"),
            "energy": {"stretch": 1e-6, "bend": 2e-4, "twist": np.float64(3e-5), "gravity": 0.1, "kinetic": 1e-4 * k},
            "max_stretch": 0.002 * (k == 3) + 0.001,
            "flips": 0,
            "winding_changes": 0,
            "too_straight": 0,
            "nan": 0,
        }
        for k in range(count)
    ]


def report(folder: Path) -> RunReport:
    Image.new("RGB", (40, 30), (120, 80, 60)).save(folder / "still.png")
    return RunReport(
        name="demo <small>",
        version="1.2.3",
        command="ringlet demo -o 'a & b'",
        machine=Machine(threads=2, simd="avx2"),
        counts={"locks": 12, "hairs": 3400},
        stages=[Stage(name="groom", wall_ms=12.0, cpu_ms=20.0), Stage(name="simulate", wall_ms=90_000.0)],
        statistics=frames(),
        files=[MadeFile.of(folder / "still.png", "the picture")],
        pictures=[Picture(path=str(folder / "still.png"), caption="Curls at frame 24")],
        warnings=["3 locks were left out."],
        limits=["Strands may pass through the head."],
    )


def test_the_page_contains_every_stage_picture_warning_and_limit(tmp_path: Path) -> None:
    _, html_path = write_report(report(tmp_path), tmp_path)
    html = html_path.read_text(encoding="utf-8")
    for text in ("groom", "simulate", "avx2", "1.2.3", "Curls at frame 24", "3 locks were left out.", "still.png"):
        assert text in html
    assert "Strands may pass through the head." in html
    assert html.count("<svg") == 6  # strands, motion, stretch, Newton, time, step lengths; no changes of curls


def test_the_page_is_well_formed_and_self_contained(tmp_path: Path) -> None:
    _, html_path = write_report(report(tmp_path), tmp_path)
    html = html_path.read_text(encoding="utf-8")
    xml.dom.minidom.parseString(html.removeprefix("<!doctype html>\n"))
    assert "<small>" not in html  # user input is escaped
    assert "<script" not in html
    assert re.findall(r'(?:src|href)\s*=\s*["\'](?!data:)', html) == []
    assert re.findall(r"url\(|@import|https?://", html) == []
    assert 'alt="Curls at frame 24"' in html


def test_the_json_of_a_report_round_trips(tmp_path: Path) -> None:
    made = report(tmp_path)
    json_path, _ = write_report(made, tmp_path)
    stored = json.loads(json_path.read_text())
    assert stored["format"] == 1
    assert stored["statistics"][2]["residual"] is None
    assert stored["stages"][0] == {"name": "groom", "wall_ms": 12.0, "cpu_ms": 20.0}
    again = RunReport.model_validate(stored)
    assert again.counts == made.counts
    assert again.date == made.date


def test_charts_without_numbers_are_omitted(tmp_path: Path) -> None:
    made = report(tmp_path)
    made.statistics = [{"frame": k, "newton": 3.0} for k in range(4)]
    _, html_path = write_report(made, tmp_path)
    assert html_path.read_text(encoding="utf-8").count("<svg") == 1


def test_an_empty_report_is_a_page_without_charts(tmp_path: Path) -> None:
    _, html_path = write_report(RunReport(name="groom", version="1"), tmp_path)
    html = html_path.read_text(encoding="utf-8")
    xml.dom.minidom.parseString(html.removeprefix("<!doctype html>\n"))
    assert "groom" in html and "<svg" not in html


def test_a_report_is_written_atomically(tmp_path: Path) -> None:
    made = report(tmp_path)
    out = tmp_path / "out"
    (out / "report.html").mkdir(parents=True)  # prevents the page
    with pytest.raises(UserError, match=r"report\.html"):
        write_report(made, out)
    assert [entry.name for entry in out.iterdir()] == ["report.html"]
    made.pictures = [Picture(path=str(tmp_path / "lost.png"), caption="")]
    with pytest.raises(UserError, match=r"lost\.png"):
        write_report(made, tmp_path / "other")
    assert not (tmp_path / "other").exists()


def test_failed_frames_rank_worse_than_stretched_ones() -> None:
    statistics = frames()
    assert (explain_worst(statistics) or "").startswith("Frame 4 ")
    statistics[1]["unconverged"] = 2
    assert (explain_worst(statistics) or "").startswith("Frame 2 ")
    statistics[5]["nan"] = 1
    assert (explain_worst(statistics) or "").startswith("Frame 6 ")


def test_properties_of_all_frames_do_not_select_the_worst_one() -> None:
    statistics = frames()
    for frame in statistics:
        frame["unconverged"] = 1  # usual with contact
    assert (explain_worst(statistics) or "").startswith("Frame 4 ")  # the largest stretch
    assert (explain_worst(statistics[:1]) or "").startswith("Frame 1 ")


def test_the_summary_says_what_was_solved_and_which_curls_changed() -> None:
    assert any("Every strand was solved" in sentence for sentence in summary(frames()))
    statistics = frames()
    statistics[2]["flips"] = 2
    assert any("flipped: 2" in sentence for sentence in summary(statistics))


def test_the_page_says_first_whether_the_result_is_usable(tmp_path: Path) -> None:
    made = report(tmp_path)
    first = write_report(made, tmp_path)[1].read_text()
    assert first.index("Usable: no frame of 6 needs a look.") < first.index("What was made")
    statistics = frames()
    statistics[4]["nan"] = 3
    broken = write_report(made.model_copy(update={"statistics": statistics}), tmp_path)[1].read_text()
    assert broken.index("Do not use this result.") < broken.index("What would help") < broken.index("What was made")


@pytest.mark.parametrize(("low", "high"), [(0.0, 1.0), (-3.2, 7.9), (1e-9, 4e-9), (0.0, 0.0), (5.0, 5.0), (0.0, 48.0)])
def test_ticks_are_round_and_cover_the_range(low: float, high: float) -> None:
    ticks = nice_ticks(low, high)
    assert ticks[0] <= low + 1e-15
    assert ticks[-1] >= high - 1e-15
    assert 2 <= len(ticks) <= 8
    leading = (ticks[1] - ticks[0]) / 10 ** np.floor(np.log10(ticks[1] - ticks[0]) + 1e-9)
    assert round(float(leading), 6) in (1.0, 2.0, 5.0)


def test_a_chart_line_has_gaps_at_missing_values_and_a_scaled_unit() -> None:
    svg = line_chart("Energy", "J", [1, 2, 3, 4, 5], {"bend": [1e-6, 2e-6, float("nan"), 3e-6, 1e-6]})
    assert svg.count("<polyline") == 2
    assert "µJ" in svg


def test_the_slowest_frame_is_explained_by_its_excess_iterations() -> None:
    many = plain(frames())
    many[2] |= {"wall_ms": 900.0, "newton": 7.5}
    sentence = explain_slowest(many)
    assert sentence is not None
    assert sentence.startswith("Frame 3 took longest, 0.90 s; half of the frames took 0.02 s or less")
    assert "Newton iterations 7.5 instead of 2.5" in sentence and "cut short" not in sentence
    assert explain_slowest(many[:2]) is None and explain_slowest([{"frame": 1.0}] * 5) is None


def test_the_summary_claims_no_more_than_holds_where_a_body_lags() -> None:
    statistics = frames()
    for frame in statistics:
        frame["contact"] = {"violations": 5, "lag": 0.0}
    assert any(sentence.startswith("Nothing passed through anything") for sentence in summary(statistics))
    statistics[2]["contact"]["lagging"] = [{"what": "hand", "distance": 2e-3, "locks": [7]}]
    assert not any("Nothing passed through anything" in sentence for sentence in summary(statistics))


def test_the_hardest_frame_is_found_beside_a_first_frame_without_a_step() -> None:
    statistics = [{"frame": 1.0}, *frames()]
    for frame in statistics[1:]:
        frame["unconverged"] = 1  # in all: that singles none out
    with_step, without = explain_worst(statistics[1:]), explain_worst(statistics)
    assert with_step is not None and without == with_step
    assert (explain_worst(statistics[:2]) or "").startswith(f"Frame {statistics[1]['frame']:g} ")
