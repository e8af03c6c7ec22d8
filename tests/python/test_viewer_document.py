"""Editing a recipe setting by setting keeps the rest of its text, comments included."""

from __future__ import annotations

import time
import tomllib
from pathlib import Path

import pytest
from ringlet.data.errors import UserError
from ringlet.viewer.files.document import Document, _diff

from ringlet.groom import parse_recipe

TEXT = """# The head of the file.
ringlet = 2
unit = "cm" # of lengths

# Where it starts.
[guides]
count = 12
length = 8 # about a hand
zone = [
    { toward = [0, 0, 1], angle = 50 }, # a fringe
]

[[shape]]
op = "clump" # neighbours
size = 2

# None knows where to go.
[[shape]]
op = "scraggle"
magnitude = 0.5

# The look.
[curl]
preset = "3C"
width = { value = "9 mm", vary = 0.2 } # a pencil
"""


@pytest.fixture
def document(tmp_path: Path) -> Document:
    path = tmp_path / "a.recipe.toml"
    path.write_text(TEXT)
    return Document(path, lambda text, edits: parse_recipe(text, path, edits or None))


def comments(text: str) -> list[str]:
    return [line.split("#")[1] for line in text.splitlines() if "#" in line]


def test_a_value_is_replaced_in_place(document: Document):
    document.set([(["curl", "width", "value"], "8 mm"), (["guides", "count"], 20)])
    assert document.text == TEXT.replace("9 mm", "8 mm").replace("count = 12", "count = 20")


def test_a_value_becomes_a_table_when_it_gains_fields(document: Document):
    document.set([(["guides", "length", "vary"], 0.1)])
    assert document.contents()["guides"]["length"] == {"value": 8, "vary": 0.1}
    assert comments(document.text) == comments(TEXT)


def test_a_setting_is_added_to_a_table_with_a_header_of_its_own(document: Document):
    document.apply(document.text + "\n[curl.pitch]\nvalue = 2 # wide\n")
    document.set([(["curl", "pitch", "lock", "3"], 4.0), (["curl", "width", "lock", "3"], 1.0)])
    assert document.contents()["curl"]["pitch"] == {"value": 2, "lock": {"3": 4.0}}
    assert document.contents()["curl"]["width"]["lock"] == {"3": 1.0} and "# wide" in document.text


def test_a_new_setting_is_inserted_before_the_comment_of_the_next_table(document: Document):
    document.set([(["curl", "start"], "12 mm"), (["guides", "whorl_turn"], 10.0), (["seed"], 4)])
    lines = document.text.splitlines()
    assert lines.index("whorl_turn = 10.0") < lines.index("[[shape]]")
    assert lines.index("seed = 4") < lines.index("# Where it starts.")
    assert document.contents()["curl"]["start"] == "12 mm"


def test_a_missing_table_is_created(document: Document):
    document.set([(["collide", "margin"], "3 mm"), (["hairs", "lock_radius", "value"], "2 mm")])
    settings = tomllib.loads(document.text)
    assert settings["collide"] == {"margin": "3 mm"} and settings["hairs"]["lock_radius"]["value"] == "2 mm"


def test_settings_in_lists_and_operators_are_set_and_removed(document: Document):
    document.set(
        [(["guides", "zone", 0, "angle"], 30), (["shape", 1, "wavelength"], 2.5), (["shape", 0, "size"], None)]
    )
    settings = document.contents()
    assert settings["guides"]["zone"][0]["angle"] == 30
    assert settings["shape"] == [{"op": "clump"}, {"op": "scraggle", "magnitude": 0.5, "wavelength": 2.5}]


def test_operators_move_with_their_comments(document: Document):
    document.move_table("shape", 1, 0)
    assert [operator["op"] for operator in document.contents()["shape"]] == ["scraggle", "clump"]
    text = document.text
    assert text.index("# None knows") < text.index('op = "scraggle"') < text.index("# neighbours")
    assert text.index("# The look.") < text.index("[curl]")


def test_an_operator_is_added_before_the_curl_and_removed_again(document: Document):
    for _ in range(2):
        document.remove_tables("shape", [0])
    assert "shape" not in document.contents() and "# The look." in document.text
    document.add_tables("shape", 0, [{"op": "volume"}])
    assert document.contents()["shape"] == [{"op": "volume"}]
    assert document.text.index("[[shape]]") < document.text.index("[curl]")


def test_an_invalid_change_is_refused_and_changes_nothing(document: Document):
    with pytest.raises(UserError, match="at least 0"):
        document.set([(["curl", "width", "value"], -1)])
    with pytest.raises(UserError, match="none at 7"):
        document.remove_tables("shape", [7])
    with pytest.raises(UserError, match="cannot be set"):
        document.set([(["guides", "zone", 9, "angle"], 30)])
    assert document.text == TEXT and not document.can_undo


def test_a_gesture_is_one_step_of_undo_and_redo(document: Document):
    for width in ("7 mm", "6 mm", "5 mm"):
        document.set([(["curl", "width", "value"], width)], gesture=1)
    document.set([(["guides", "count"], 20)], gesture=2)
    document.history.undo()
    assert document.contents()["curl"]["width"]["value"] == "5 mm" and document.contents()["guides"]["count"] == 12
    document.history.undo()
    assert document.text == TEXT and not document.dirty
    document.history.redo()
    assert document.contents()["curl"]["width"]["value"] == "5 mm" and document.dirty


def test_changes_are_listed_against_the_saved_file_until_saved(document: Document):
    document.set([(["guides", "count"], 20)])
    changed = {(change.sign, change.line) for change in document.diff() if change.sign != " "}
    assert changed == {("-", "count = 12"), ("+", "count = 20")}
    document.save()
    assert document.path.read_text() == document.text and not document.dirty and not document.diff()


def test_the_diff_of_long_texts_is_bounded():
    lines = [f"a{k} = {k % 7}" for k in range(40_000)]
    changed = [*lines[:9], "b = 1", *lines[9:-3], *lines[-2:]]
    begin = time.monotonic()
    assert _diff("\n".join(lines), "\n".join(lines)) == []
    assert _diff("\n".join(lines), "\n".join([*lines, "b = 1"]))[-1] == "+b = 1"
    assert _diff("\n".join(lines), "\n".join(changed))[0].endswith("lines")
    assert time.monotonic() - begin < 2.0


def test_changes_that_take_too_long_are_refused_together(document: Document, monkeypatch):
    monkeypatch.setattr("ringlet.viewer.files.document.MOST_SECONDS", 0.0)
    with pytest.raises(UserError, match="300 changes take over 0 s; make fewer at a time"):
        document.set([(["curl", "width", "value"], 1.0)] * 300)
    assert document.text == TEXT
