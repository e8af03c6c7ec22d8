"""The nod of the demo, played over and over; tests/physics/test_judged_shots.py has its first frames."""

from judged_shots import judged, start


def test_a_thousand_frames_have_no_crossings():
    played = 0
    for played, frame in enumerate(judged(start("nod"), 1000), 1):
        assert frame.crossings == 0 and frame.statistics["nan"] == 0, played
    assert played == 1000
