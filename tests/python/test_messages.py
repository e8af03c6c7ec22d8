"""Messages for wrong settings: the value as the file has it, its place there, and a remedy within the bounds."""

from __future__ import annotations

from typing import get_args

import pytest
from commands import COMMAND, edit, refused, run
from pydantic import BaseModel, ValidationError
from ringlet.data.explain import explain
from ringlet.shot import parse_shot

import ringlet
from ringlet import io
from ringlet.groom import parse_recipe

SHOT = 'ringlet = 2\ngroom = "a.usdc"\nframes = [1, 2]\n'


@pytest.mark.parametrize(
    ("line", "message"),
    [
        ("preroll = true", "preroll is true; must be a whole number"),
        ("preroll = 2.5", "preroll is 2.5; must be a whole number"),
        ("frames = [true, 2]", "frames is true; must be a whole number"),
        ("frames = [1, 2, 3]", "frames has 3 entries; must have at most 2"),
        ("frames = [1]", "frames[1] is missing; it must be given"),
        ("frames = 5", "frames is 5; must be a list"),
        ("frames = [1, 10000001]", "frames[1] is 10000001; must be at most 10000000"),
        ("name = 5", "name is 5; must be a text"),
        ("groom = 5", "groom is 5; must be the name of a file"),
        ("strands = { radius = true }", "strands.radius is true; must be a number"),
        ("strands = { radius = '1e-3' }", "strands.radius is '1e-3'; must be a number"),
        (
            "strands = { radius = '0.4 mm' }",
            "radius is '0.4 mm'; must be a number, 0.0004 in metres",
        ),
        ("strands = { radius = 1e308 }", "strands.radius is 1e+308; must be at most 0.1"),
        (f"strands = {{ radius = {10**400} }}", "strands.radius is 10^400 or more; must be a number of fewer"),
        ("strands = { limit_twist = 'x' }", "strands.limit_twist is 'x'; must be true or false"),
        ("forces = { gravity = [0, -1e308, 0] }", "forces.gravity[1] is -1e+308; must be at least -1000"),
        ("forces = { wind = [1e308, 0, 0] }", "forces.wind[0] is 1e+308; must be at most 1000"),
        ("forces = { wind = [false, 0, 0] }", "forces.wind is false; must be a number"),
        ("rest = { gain = 1e308 }", "rest.gain is 1e+308; must be at most 1"),
        ("rest = { gain = 'x' }", "rest.gain is 'x'; must be a number"),
        ("rest = { tolerance = '1 km' }", "rest.tolerance is '1 km'; must be a number or a length such as \"5 mm\""),
        ("contact = {}\ncloth = [{ mesh = '/a', shrink = 7e5 }]", "cloth[0].shrink is 700000; must be at most 100"),
        ("contact = {}\ncloth = [{ mesh = '/a', shrink = 'x' }]", "cloth[0].shrink is 'x'; must be a number"),
        ("contact = {}\ncloth = [{ mesh = '/a', shrink = [[1, 0]] }]", "cloth[0].shrink is [[1, 0]]; must be a number"),
        ("contact = {}\ncloth = [{ mesh = '/a', name = '5' }]", "cloth[0].name is '5'; must be a text of the form ^"),
        ("contact = 5", "contact is 5; must be a table of settings"),
        ("solver = { safeguards = ['x'] }", "solver.safeguards[0] is 'x'; must be 'flip_history', "),
    ],
)
def test_a_wrong_setting_of_a_shot_is_named_as_in_the_file(line, message):
    kept = [kept for kept in SHOT.splitlines() if not kept.startswith(line.split(" =")[0] + " ")]
    with pytest.raises(ringlet.UserError) as error:
        parse_shot("\n".join([*kept, line]))
    assert str(error.value).startswith("shot: ") and message in str(error.value)
    for word in ("constrained", "validation", "should", "Input", "tuple"):
        assert word not in str(error.value)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("locks = { count = true }", "locks.count is true; must be a whole number"),
        ("curl = { preset = '4A', width = true }", "curl.width is true; must be a number"),
        ("curl = { preset = '4A', width = 1e308 }", "curl.width is 1e+306 m; must be at most 0.2 m"),
        ("curl = { preset = '4A', width = '1e999 m' }", "curl.width is '1e999 m'; must be at most 0.2 m"),
        ("curl = { preset = '4A', width = { value = 1, vary = true } }", "curl.width.vary is true; must be a number"),
        (
            "curl = { preset = '4A', width = { value = 1, ramp = [[0, 1e30]] } }",
            "of 1e+30; must be at most 1e+06",
        ),
        ("curl = { preset = '4A', width = { value = 1, ramp = [[0, true]] } }", "width.ramp is true; must be a number"),
        ("curl = { preset = '4A', width = { value = 1, lock = { a = 1 } } }", "lock.a is 'a'; must be a whole number"),
        ("guides = { whorl = [true, 0, 0] }", "guides.whorl is true; must be a number"),
        ("guides = { whorl = true }", "guides.whorl is true; must be a list"),
        ("guides = { whorl = [1e308, 0, 0] }", "guides.whorl[0] is 1e+308; must be at most 1000"),
        (
            "edit = [{ lock = 1, curve = [[1e308, 0, 0], [0, 0, 1]] }]",
            "curve[0] is 1e+306 m; must be at most 1000 m",
        ),
        ("shape = [{ op = 5 }]", "shape[0].op is"),
        ("shape = [{ }]", "shape[0].op is missing; it must be given"),
        ("shape = [5]", "shape[0]"),
        ('edits = ""', "edits is ''; must be the name of a file"),
        (f'extends = "{"x" * 300}"', "x…; must be the name of a file"),
        (f"[hairs{'.a' * 100_000}]", "is not valid TOML: a key of over 50 parts; shorten it"),
        ("hairs" + ' . "a"' * 100_000 + " = 1", "is not valid TOML: a key of over 50 parts; shorten it"),
        (f"x = {'[' * 200}{']' * 200}", "x is not a setting"),
        (f"locks.count = {'{a = ' * 40}1{'}' * 40}", "locks.count is {"),
        ("edits = 5", "edits is 5; must be the name of a file"),
        ('name = "\\u0000"', "has a text with a character of code 0; take it out"),
    ],
)
def test_a_wrong_setting_of_a_recipe_is_named_as_in_the_file(text, message):
    with pytest.raises(ringlet.UserError) as error:
        parse_recipe(f"ringlet = 2\n{text}")
    assert message in str(error.value)
    for word in ("constrained", "validation", "should", "Input", "tuple"):
        assert word not in str(error.value)


def test_no_field_of_an_operator_has_the_name_of_an_operator():
    """A place in a union begins with the operator's name, which is left out as it is no key of the table."""
    schema = ringlet.schema()["recipe"]
    operators = schema["properties"]["shape"]["items"]["discriminator"]["mapping"]
    for name, reference in operators.items():
        assert name not in schema["$defs"][reference.rpartition("/")[2]]["properties"]


def test_every_mistake_that_settings_can_have_is_in_our_words():
    """A kind of mistake that is not in the table is reported without the words of the library."""

    class Odd(BaseModel):
        when: complex

    with pytest.raises(ValidationError) as error:
        Odd.model_validate({"when": "soon"})
    assert str(explain(error.value, "a.toml")) == "a.toml: when is 'soon'; must be of another kind"


@pytest.mark.parametrize("key", ["a\\nb", "a\\u001bb", "x" * 5000])
def test_a_message_is_one_short_line_whatever_a_file_says(copy, key):
    recipe = edit(copy / "small.recipe.toml", "[curl]", f'[curl]\n"{key}" = 1')
    message = refused(run("groom", recipe, "-o", copy / "out.usdc"), "is not a setting")
    assert len(message) < 1100 and message.isprintable()


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 0 1 2", "line 4 uses point 0; must be from 1, or from -1 backwards"),
        ("v 0 0 0\nl 1 0", "line 2 uses point 0; must be from 1, or from -1 backwards"),
        ("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 -7", "line 4 uses point -7; there are 3 before it"),
        ("v 0 0 0\nf 1 2 99999999999999", "line 2 uses point 99999999999999; must be at most 2147483647"),
        ("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 4", "a face uses point 4; must be from 1 to 3"),
        ("v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nf 1/1 2/1 3/0", "line 5 uses point 0"),
    ],
)
def test_points_of_an_obj_are_counted_as_in_the_file(tmp_path, text, message):
    (tmp_path / "a.obj").write_text(text)
    with pytest.raises(ringlet.UserError, match=message):
        io.read_curves(tmp_path / "a.obj") if "\nl" in text else io.read_mesh(tmp_path / "a.obj")


CHOICES = [
    (name, option.opts[0], choices)
    for name, command in COMMAND.commands.items()
    for option in command.params
    if option.opts[0].startswith("--")
    and (choices := get_args(option.type_descriptor.annotation))
    and all(isinstance(one, str) for one in choices)
]


@pytest.mark.parametrize(("command", "option", "choices"), CHOICES, ids=[" ".join(one[:2]) for one in CHOICES])
def test_a_word_that_is_no_choice_gives_those_there_are(command, option, choices):
    message = refused(run(command, option, "nonsense"), option, "'nonsense'")
    assert all(choice in message for choice in choices)
