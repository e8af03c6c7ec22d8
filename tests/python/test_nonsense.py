"""Nonsense in any setting and any file: exit code 2, one line with a place and a remedy, soon and in little memory."""

from __future__ import annotations

import json
import math
import os
import re
import resource
import struct
import time
import warnings
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any, get_args

import numpy as np
import pytest
from commands import refused, run
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from PIL import Image
from ringlet.data.toml import to_toml
from ringlet.io.hair import HEADER
from ringlet.shot import parse_shot
from ringlet.viewer import protocol
from ringlet.viewer.wire import unpack
from small_example import write_head

import ringlet
from ringlet import io
from ringlet.groom import parse_recipe

SECONDS, KILOBYTES = 10.0, 1_000_000
EXAMPLES = int(os.environ.get("RINGLET_EXAMPLES", "0"))  # to look for more than the fixed examples of the tests
quick = settings(
    max_examples=EXAMPLES or 500, derandomize=not EXAMPLES, deadline=None, suppress_health_check=list(HealthCheck)
)


@contextmanager
def bounded() -> Iterator[None]:
    """Fails on a warning, on work of more than 10 s and on 1 GB of memory more."""
    begin, before = time.monotonic(), resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        yield
    assert time.monotonic() - begin < SECONDS
    assert resource.getrusage(resource.RUSAGE_SELF).ru_maxrss - before < KILOBYTES


def check_line(error: ringlet.UserError, place: str) -> str:
    """Asserts that a refusal is one short line with a place and a remedy in the words of Ringlet."""
    line = str(error)
    assert line.isprintable() and len(line) < 1100
    assert place in line
    assert re.search(r"; \S|: .* must |: is not valid TOML", line), line
    assert not re.search(r"pydantic|validation|constrained|Input should|Traceback|Error\b|numpy|<class", line), line
    return line


# Settings


# What a table needs besides the setting that is tried.
NEEDED = {
    "curl": {"preset": "4A"},
    "edit": {"lock": 1, "offsets": [[0, 0, 0]]},
    "sculpt": {"guide": 1},
    "cloth": {"mesh": "/a"},
    "pair": {"between": ["a", "b"], "friction": 0.1},
}
Place = tuple[str | int, ...]  # with the name of an operator after the row of its table


def places(schema: dict[str, Any]) -> list[Place]:
    """Places of all settings of a model, tables in lists by their first row."""
    found: set[Place] = set()

    def walk(part: dict[str, Any], place: Place, seen: tuple[str, ...]) -> None:
        if reference := part.get("$ref"):
            if reference not in seen:
                walk(schema["$defs"][reference.rpartition("/")[2]], place, (*seen, reference))
            return
        for name, option in part.get("discriminator", {}).get("mapping", {}).items():
            walk({"$ref": option}, (*place, f"op {name}"), seen)
        for option in [*part.get("anyOf", ()), *part.get("oneOf", ())]:
            walk(option, place, seen)
        if isinstance(part.get("items"), dict):
            walk(part["items"], (*place, 0), seen)
        for name, inner in part.get("properties", {}).items():
            found.add((*place, name))
            walk(inner, (*place, name), seen)

    walk(schema, (), ())
    return sorted(found, key=repr)


def table_with(place: Place, value: Any) -> Any:
    """Tables with one value."""
    if not place:
        return value
    first, inner = place[0], table_with(place[1:], value)
    if first == 0:
        return [inner]
    if isinstance(first, str) and first.startswith("op "):
        return {"op": first[3:], **inner}
    one = inner[0] if isinstance(inner, list) and len(place) > 1 and place[1] == 0 else inner
    if isinstance(one, dict) and len(place) > 1:
        one = {**NEEDED.get(str(first), {}), **one}
    return {first: [one] if isinstance(inner, list) and len(place) > 1 and place[1] == 0 else one}


MODELS = {
    "recipe": (parse_recipe, {"ringlet": 2}, places(ringlet.schema()["recipe"])),
    "shot": (
        parse_shot,
        {"ringlet": 2, "groom": "a.usdc", "frames": [1, 2], "contact": {}},
        places(ringlet.schema()["shot"]),
    ),
}
EXTREMES = [0, -1, 1e308, -1e308, 5e-324, math.inf, -math.inf, math.nan, 2**31, 2**63, 10**400, True, False]
WORDS = ["", "x", "5 mm", "1e999 m", "-3 in", "a\nb", "\u202e\x1b[2J", "\ud7ff" * 300, "None", "../../etc/passwd"]
TEXTS = ["\ufeff", "ringlet = 2\n[", "ringlet = 2\r\n\x00", "[" * 5000, "a" * 10**6]
unicode = st.characters(exclude_categories=["Cs"])  # all that UTF-8 has; a search through the codec takes seconds
nonsense = st.recursive(
    st.one_of(
        st.sampled_from(EXTREMES), st.sampled_from(WORDS), st.floats(), st.integers(), st.text(unicode, max_size=9)
    ),
    lambda inner: st.one_of(
        st.lists(inner, max_size=4),
        st.dictionaries(st.sampled_from(["value", "ramp", "vary", "lock", "op", "x"]), inner),
    ),
    max_leaves=6,
)


@pytest.mark.parametrize("model", MODELS)
@quick
@given(data=st.data())
def test_a_nonsensical_setting_is_refused_with_its_place_and_a_remedy(model, data):
    parse, base, where = MODELS[model]
    place, value = data.draw(st.sampled_from(where)), data.draw(nonsense)
    with bounded():
        try:
            parse(to_toml({**base, **table_with(place, value)}), Path("a.toml"))
        except ringlet.UserError as error:
            line = check_line(error, "a.toml: ")
            if bound := re.search(r"^a.toml: \S+ is .*; must be at (?:most|least) (-?[\d.e+-]+)", line):
                follow_remedy(parse, base, place, float(bound[1]), line)


def follow_remedy(parse: Callable[..., Any], base: dict, place: tuple, bound: float, line: str) -> None:
    """Asserts that a value at the bound that a message names is not refused with the same remedy."""
    for value in (f"{bound!r} m", bound, int(bound)):
        try:
            parse(to_toml({**base, **table_with(place, value)}), Path("a.toml"))
        except ringlet.UserError as error:
            if str(error).rpartition("; ")[2] != line.rpartition("; ")[2]:
                return
        else:
            return
    raise AssertionError(f"the remedy is refused too: {line}")


@quick
@given(text=st.one_of(st.text(unicode), st.sampled_from(TEXTS)))
@pytest.mark.parametrize("model", MODELS)
def test_a_nonsensical_text_is_refused_with_its_place(model, text):
    with bounded():
        try:
            MODELS[model][0](text, Path("a.toml"))
        except ringlet.UserError as error:
            check_line(error, "a.toml: ")


@settings(quick, max_examples=8)
@given(data=st.data())
@pytest.mark.parametrize("model", MODELS)
def test_the_command_line_prints_the_line_and_exits_with_2(tmp_path, model, data):
    parse, base, where = MODELS[model]
    text = to_toml({**base, **table_with(data.draw(st.sampled_from(where)), data.draw(st.sampled_from(EXTREMES)))})
    (tmp_path / "a.toml").write_text(text)
    try:
        parse(text, tmp_path / "a.toml")
    except ringlet.UserError:
        with bounded():
            refused(
                run("groom" if model == "recipe" else "sim", tmp_path / "a.toml", "-o", tmp_path / "out.usdc"), "a.toml"
            )


MESSAGES = get_args(get_args(protocol.FromPage)[0])
KINDS = [message.__name__.lower() for message in MESSAGES]
FIELDS = sorted({name for message in MESSAGES for name in message.model_fields})


@quick
@given(
    message=st.one_of(
        nonsense,
        st.builds(
            lambda kind, more: {"kind": kind, **more},
            st.sampled_from([*KINDS, "undo", "none"]),
            st.dictionaries(st.sampled_from(FIELDS), nonsense, max_size=4),
        ),
    )
)
def test_a_nonsensical_message_of_a_page_is_refused_or_within_bounds(message):
    text = json.dumps(message).encode()
    with bounded():
        try:
            unpack(struct.pack("<I", len(text)) + text)
        except ringlet.UserError as error:
            check_line(error, "message: ")


# Files


def obj(path: Path) -> None:
    path.write_text(
        "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nvt 0 0\nvt 1 0\nvt 0 1\ng a\nf 1/1 2/2 3/3\nf 1 3 4\nl 1 2 -1\n"
    )


def hair(path: Path) -> None:
    body = np.uint16([1, 2]).tobytes() + np.arange(15, dtype=np.float32).tobytes() + np.ones(5, np.float32).tobytes()
    path.write_bytes(HEADER.pack(b"HAIR", 2, 5, 7, 0, 0.1, 0.0, 1.0, 1.0, 1.0, b"") + body)


def picture(path: Path) -> None:
    Image.fromarray(np.arange(48, dtype=np.uint8).reshape(6, 8)).save(path)


READERS = {
    "a.obj": (obj, (io.read_mesh, io.read_curves)),
    "a.hair": (hair, (io.read_curves,)),
    "a.usda": (write_head, (io.read_mesh, io.read_curves, io.read_groom, io.read_bodies, io.read_space)),
    "a.png": (picture, (io.read_texture,)),
    "a.tif": (picture, (io.read_texture,)),
    "a.bmp": (picture, (io.read_texture,)),
}
PIECES = [
    b"",
    b"\0",
    b"\xff" * 4,
    b"1e300",
    b"-1e39",
    b"nan",
    b"inf",
    b"9" * 40,
    b"99999999999",
    b"\n",
    b"/",
    b"-0",
    b"[(",
    b"\x7f" * 8,
]


@pytest.mark.parametrize("name", READERS)
@settings(quick, max_examples=EXAMPLES or 100)
@given(data=st.data())
def test_a_damaged_file_is_read_or_refused_with_its_name_and_a_remedy(tmp_path, name, data):
    write, readers = READERS[name]
    path, valid = tmp_path / name, tmp_path / f"valid.{name}"
    if not valid.exists():
        write(valid)
    content = bytearray(valid.read_bytes())
    for _ in range(data.draw(st.integers(1, 3))):
        at, length = data.draw(st.integers(0, len(content))), data.draw(st.integers(0, 12))
        content[at : at + length] = data.draw(st.one_of(st.sampled_from(PIECES), st.binary(max_size=8)))
    if data.draw(st.booleans()):
        del content[data.draw(st.integers(0, len(content))) :]
    path.write_bytes(content)
    for read in readers:
        with bounded():
            try:
                read(path)
            except ringlet.UserError as error:
                check_line(error, name)
