"""The verdict on a simulation: usable or not, where to look, and what would help."""

from __future__ import annotations

from typing import Any

import pytest
from ringlet.report.verdict import judge, ranges


def frames(count: int = 12, **contact: Any) -> list[dict[str, Any]]:
    """Statistics of a sound simulation."""
    sound = {"nan": 0, "max_stretch": 0.003, "worst_lock": 4, "flips": 0, "winding_changes": 0, "too_straight": 0}
    return [{"frame": float(k + 1), **sound, **({"contact": dict(contact)} if contact else {})} for k in range(count)]


def test_a_sound_simulation_is_usable_and_has_no_findings() -> None:
    contact = {"motion_kept": 0.5, "motion_missing": 2e-4, "motion_tolerated": 5e-4}  # of a frame that hardly moves
    for statistics in (frames(), frames(**contact), [{"frame": 1.0}, *frames()]):
        verdict = judge(statistics)
        assert verdict.usable and verdict.lines() == [f"Usable: no frame of {len(statistics)} needs a look."]


def test_broken_numbers_make_a_result_unusable_and_come_first() -> None:
    statistics = frames()
    statistics[4]["nan"], statistics[2]["max_stretch"] = 3, 0.2
    verdict = judge(statistics)
    assert not verdict.usable and verdict.headline == "Do not use this result."
    assert [finding.frames for finding in verdict.findings] == [[5], [3]]


def test_frames_and_locks_to_look_at_are_named_with_a_remedy() -> None:
    statistics = frames()
    for k, stretch in ((3, 0.08), (4, 0.12), (8, 0.06)):
        statistics[k] |= {"max_stretch": stretch, "worst_lock": 100 + k}
    verdict = judge(statistics)
    assert verdict.usable and verdict.lines() == [
        "Look at frames 4–5, 9 before you use this result.",
        "Hair is stretched by up to 12 % (frames 4–5, 9; locks 103, 104, 108); raise solver.newton, or solver.substeps "
        "where the head moves fast.",
    ]


def test_a_body_that_could_not_arrive_is_named_with_how_far_it_lags_and_by_which_locks() -> None:
    statistics = frames(violations=5)
    statistics[2]["contact"]["lagging"] = [{"what": "hand", "distance": 2e-3, "locks": [7]}]
    statistics[3]["contact"]["lagging"] = [{"what": "hand", "distance": 12.5e-3, "locks": [7, 8, 9, 12]}]
    (finding,) = judge(statistics).findings
    assert finding.sentence() == (
        "hand could not arrive, by 12.5 mm in frame 4, and hair may be inside where the animation shows it "
        "(frames 3–4; locks 7, 8, 9, …); leave it more room, or raise solver.substeps."
    )


def test_hair_that_misses_more_motion_than_is_tolerated_is_found_with_contact_alone() -> None:
    statistics = frames(motion_kept=0.9, motion_missing=4e-4, motion_tolerated=5e-4)
    statistics[6]["contact"] |= {"motion_kept": 0.55, "motion_missing": 6e-4}
    statistics[7]["unconverged"] = 1  # usual with contact
    (finding,) = judge(statistics).findings
    assert finding.frames == [7] and "0.6 mm" in finding.what and "55 %" in finding.what
    assert "solver.newton" in finding.remedy
    free = frames()
    free[7] |= {"unconverged": 2, "unconverged_locks": [3, 9]}
    (finding,) = judge(free).findings
    assert finding.frames == [8] and finding.locks == [3, 9]


def test_locks_for_which_the_solver_found_no_step_are_named() -> None:
    statistics = frames(motion_kept=1.0)
    statistics[4] |= {"stalled": 1, "stalled_locks": [7]}
    (finding,) = judge(statistics).findings
    assert finding.frames == [5] and finding.locks == [7] and "no step" in finding.what


def test_curls_that_changed_are_counted() -> None:
    statistics = frames()
    statistics[1]["flips"], statistics[5]["too_straight"] = 2, 1
    (finding,) = judge(statistics).findings
    assert finding.what == "Curls did not hold their shape: flipped over 2, pulled straight 1" and finding.frames == [
        2,
        6,
    ]


@pytest.mark.parametrize(
    ("numbers", "text"),
    [([3], "3"), ([3, 4], "3–4"), ([1, 3, 4, 9], "1, 3–4, 9"), ([1, 3, 5, 7, 9], "1, 3, 5 and 2 ranges more")],
)
def test_ranges_of_frames_are_short(numbers: list[int], text: str) -> None:
    assert ranges(numbers) == text


def test_folded_braids_and_strands_in_bodies_are_named() -> None:
    statistics = frames()
    statistics[3] |= {"folds": 4, "folded_locks": [7, 8]}
    statistics[5]["inside"] = [{"what": "skin", "depth": 2.34e-3, "points": 3, "locks": [9]}]
    assert judge(statistics).lines() == [
        "Look at frames 4, 6 before you use this result.",
        "Strands of braids that move as their core are in skin, by up to 2.3 mm (frame 6; lock 9); raise "
        'contact.own_radius, or let these braids move as strands (simulate = "strands").',
        "Braids fold, at 4 points in frame 4 (frame 4; locks 7, 8); raise solver.substeps, or let those that move as "
        'their core move as strands (simulate = "strands").',
    ]


def test_stretch_beyond_all_measure_is_written_without_an_exponent() -> None:
    statistics = frames()
    statistics[3]["max_stretch"] = 4.03
    assert "stretched by up to 403 %" in judge(statistics).lines()[1]
