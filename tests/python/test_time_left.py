"""The time left that is said is true: after a resume, behind a pre-roll, and on machines of any speed."""

from __future__ import annotations

import pytest
from ringlet.api.demo import PATHS, SECONDS, STILL_SECONDS, Overall
from ringlet.cli import progress
from ringlet.cli.progress import Lines, Pace


def test_the_time_left_after_a_resume_counts_the_steps_of_this_run_alone():
    pace = Pace(100.0)
    pace.report(100.0, 900)  # done by the run that was killed
    assert pace.left(100.0, 1000) == ""
    for step in range(1, 4):
        pace.report(100.0 + 20.0 * step, 900 + step)
    assert pace.left(160.0, 1000) == "about 32 min left"  # 97 steps of 20 s
    assert pace.each == 20.0


def test_steps_of_another_kind_at_the_begin_count_for_nothing():
    pace, now = Pace(0.0), 0.0
    for step in range(60):
        pace.report(now, step)
        now += 0.1 if step < 24 else 2.0
    assert pace.each == pytest.approx(2.0)


def test_lines_count_down_while_a_step_lasts():
    pace = Pace(0.0)
    for done in range(4):
        pace.report(10.0 * done, done)
    assert pace.left(30.0, 6) == "about 30 s left"
    assert pace.left(37.0, 6) == "about 23 s left"
    assert pace.left(99.0, 6) == "about 0 s left"


def test_lines_of_a_resumed_run_say_the_time_of_its_own_steps(monkeypatch, capsys):
    now = [0.0]
    monkeypatch.setattr(progress.time, "monotonic", lambda: now[0])
    lines = Lines()
    for done in range(50, 53):
        lines.report("sim", done, 60)
        now[0] += 10.0
    assert capsys.readouterr().err.splitlines() == [
        "sim: 51/60, 10.0 s, about 90 s left",
        "sim: 52/60, 20.0 s, about 80 s left",
    ]


@pytest.mark.parametrize("slowness", [0.5, 1.0, 4.0])
def test_the_demo_says_its_time_on_machines_of_any_speed(slowness):
    now, said = [0.0], []
    overall = Overall(lambda name, done, total: name == "demo" and said.append((now[0], done)), lambda: now[0])
    for stage, seconds in SECONDS.items():
        report = overall.of(stage)
        takes = slowness * seconds
        if stage == "still":
            takes += min(slowness * PATHS, STILL_SECONDS) - slowness * PATHS
        for step in range(10):
            now[0] += takes / 10
            report(stage, step + 1, 10)
    assert said[-1][1] == 100
    for at, percent in said:
        if percent >= 10:
            assert at / (percent / 100.0) == pytest.approx(now[0], rel=0.2)


def test_every_part_of_making_hairs_is_reported(tmp_path):
    from small_example import write_example

    import ringlet

    write_example(tmp_path)
    ringlet.write_groom(ringlet.build_groom(tmp_path / "small.recipe.toml"), tmp_path / "g.usdc")
    heard = []
    measures: dict[str, float] = {}
    ringlet.write_hairs(
        tmp_path / "g.usdc", tmp_path / "h.usdc", measures=measures, progress=lambda *report: heard.append(report)
    )
    for stage in ("lay hairs", "measure cover", "keep out of surfaces"):
        assert heard.index((stage, 0, 1)) < heard.index((stage, 1, 1))
