"""Grooms in sections on a ball, for the tests of styles."""

import numpy as np
from ringlet.data.groom import SECTION
from ringlet.groom.scalp import Scalp
from ringlet.groom.sections import STRAND
from shapes import ball

from ringlet.groom import make_groom, parse_recipe, weave

PATTERNS = ["grid", "brick", "rows", "triangles", "radial"]


def no_helper(name, setting):
    raise AssertionError(f"{setting} asks for {name}")


def groom(sections="strands = 3", shape="", locks="points = 120", curl="", top="", scalp=None, length=16):
    """A groom of straight hair that stands on the scalp."""
    return make_groom(
        parse_recipe(text(sections, shape, locks, curl, top, "" if scalp else "region = 'scalp'", length)),
        scalp or ball(),
    )


def text(sections="strands = 3", shape="", locks="points = 120", curl="", top="", region="", length=16):
    return f"""
ringlet = 2
{top}
[scalp]
{region}
[guides]
count = 30
length = {length}
lift = 1
gravity_bend = 0
[locks]
{locks}
[locks.sections]
{"" if "size" in sections else "size = 3"}
{sections}
{shape}
{curl}
[collide]
margin = 0
"""


def strands_of(locks):
    """Points of the strands of each section, shape (strands, points, 3)."""
    assert (locks.curve[STRAND] >= 0).all()
    grid = locks.points.reshape(len(locks), -1, 3)
    return [grid[locks.curve[SECTION] == section] for section in np.unique(locks.curve[SECTION])]


def words(locks):
    middle = Scalp(ball(), "scalp").middle
    return [weave.braid_word(weave.cross_sections(strands, middle)) for strands in strands_of(locks)]


BRAID = "[[shape]]\nop = 'braid'\nwidth = 1.2\npitch = 3\n"
