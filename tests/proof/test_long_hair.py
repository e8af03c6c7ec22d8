"""300 long locks between a turning head and a shirt; `make test` has 150, which lag half as far behind."""

from judged_shots import judged, start


def test_dense_long_hair_between_a_turning_head_and_a_shirt_stops_neither():
    frames = list(judged(start("nod", "down", locks=300), 26, every=5))
    assert sum(frame.crossings or 0 for frame in frames) == 0
    assert all(frame.statistics["contact"]["lag"] < 4e-3 for frame in frames)
