"""A value times its ramp, its map and chance stays within the bounds of the value."""

import numpy as np
import pytest
from shapes import sheet

from ringlet import UserError
from ringlet.groom import make_groom, make_hairs, parse_recipe

GROOM = "ringlet = 2\n[guides]\ncount = 12\nlength = 6\n[locks]\ncount = 12\npoints = 40\n"


def groom(text, scalp=None):
    return make_groom(parse_recipe(GROOM + text), scalp or sheet())


def painted(value, name="map"):
    scalp = sheet()
    scalp.maps[name] = np.full((len(scalp.triangles), 3), value)
    return scalp


@pytest.mark.parametrize(
    ("text", "words"),
    [
        (
            "[curl]\ncurls = 3\nwidth = { value = 1, ramp = [[0, 1], [1, 1e30]] }",
            ["curl.width.ramp", "1e+30", "at most"],
        ),
        (
            "[curl]\ncurls = 3\nwidth = { value = 1, ramp = [[0, 1], [1, 21]] }",
            ["curl.width", "0.01 m times 21", "0.2 m"],
        ),
        (
            "[curl]\ncurls = 3\nwave = { value = 1, ramp = [[0, 1], [1, 21]] }",
            ["curl.wave", "0.01 m times 21", "0.2 m"],
        ),
        ("[curl]\npitch = { value = 1, ramp = [[0, 1], [1, 101]] }", ["curl.pitch", "0.01 m times 101", "1 m"]),
        ("[curl]\ncurls = 3\nopening = [[0, 0], [1, 11]]", ["curl.opening", "11", "at most 10"]),
        ("[hairs]\nwidth = { value = '0.07 mm', ramp = [[0, 1], [1, 1e38]] }", ["hairs.width.ramp", "1e+38"]),
        ("[hairs]\nwidth = { value = '0.07 mm', ramp = [[0, 1], [1, 1e3]] }", ["hairs.width", "7e-05 m times 1000"]),
        (
            "[hairs]\nlock_radius = { value = 1, region = { a = 9 }, ramp = [[0, 2]] }",
            ["hairs.lock_radius", "0.09 m times 2"],
        ),
        (
            "[[shape]]\nop = 'noise'\nmagnitude = { value = 1, ramp = [[0, 0], [1, 101]] }",
            ["shape[0].magnitude", "0.01 m times"],
        ),
    ],
)
def test_a_ramp_that_takes_a_value_beyond_its_bounds_is_refused(text, words):
    with pytest.raises(UserError) as caught:
        parse_recipe(GROOM + text)
    for word in words:
        assert word in str(caught.value)


def test_ramps_that_only_distribute_a_value_may_exceed_its_bounds():
    groom(
        "[curl]\ncurls = { value = 3, ramp = [[0, 1], [1, 400]] }\n"
        "[[shape]]\nop = 'bend'\nangle = { value = 20, ramp = [[0, 99]] }"
    )


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("[curl]\ncurls = 3\nwidth = { value = 1, map = 'map' }", ["curl.width is 1e+28 m on lock", "'map'", "0.2 m"]),
        ("[[shape]]\nop = 'length'\nfactor = { value = 1, map = 'map' }", ["length.factor is 1e+30 on lock", "100"]),
    ],
)
def test_a_map_that_takes_a_value_beyond_its_bounds_is_refused(text, words):
    with pytest.raises(UserError) as caught:
        groom(text, painted(1e30))
    for word in words:
        assert word in str(caught.value)


def test_hairs_are_no_wider_than_their_bound():
    with pytest.raises(UserError, match=r"hairs.width is 9e\+25 m on lock"):
        make_hairs(groom("[hairs]\nwidth = { map = 'map' }", painted(1e30)))
    thick = make_hairs(
        groom("[hairs]\nper_lock = 500\nwidth = { value = '9 mm', vary = 1 }"), fraction=0.002, wider=True
    )
    assert thick.curves.point["width"].max() <= 0.01 + 1e-9


def test_a_part_of_a_whole_saturates():
    lift = "[guides]\ncount = 12\nlength = 6\ngravity_bend = 0\nlift = {{ value = {}, map = 'map' }}\n"
    high, full = (
        make_groom(parse_recipe("ringlet = 2\n" + lift.format(value)), painted(by)).guides.points
        for value, by in ((0.5, 1e30), (1.0, 1.0))
    )
    np.testing.assert_allclose(high, full, atol=1e-12)


def test_a_map_of_zero_gives_the_least_value():
    guides = make_groom(
        parse_recipe("ringlet = 2\n[guides]\ncount = 12\nlength = { value = 6, map = 'map' }\n"), painted(0.0)
    ).guides
    np.testing.assert_allclose(guides.lengths(), 1e-4, rtol=1e-6)
    with pytest.raises(UserError, match="too few for"):
        groom("[curl]\npitch = { value = 1, map = 'map' }", painted(0.0))


def test_chance_stays_within_the_bounds_of_a_value():
    text = "ringlet = 2\n[guides]\ncount = 40\nlength = { value = '9 m', vary = 1 }\n"
    lengths = make_groom(parse_recipe(text), sheet()).guides.lengths()
    assert lengths.min() < 5.0 and lengths.max() == pytest.approx(10.0)


def test_zones_keep_guides_within_the_bounds_of_their_length():
    text = "ringlet = 2\n[guides]\ncount = 12\nlength = '5 m'\n[[guides.zone]]\nlength = {}\nmask = 1\n"
    for factor, length in ((10, 10.0), (0, 1e-4)):
        guides = make_groom(parse_recipe(text.format(factor)), sheet()).guides
        np.testing.assert_allclose(guides.lengths(), length, rtol=1e-6)
