"""Snapshots of the review: their files, loading, comparing, and what becomes of them when files change."""

from __future__ import annotations

import base64
import io
import tomllib
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from pages import Page, page, serving
from PIL import Image

LOOK = {"camera": [0.0, 0.0, 1.0, 0.0, 0.0, 0.0], "light": "studio", "color": "", "overlay": "", "file": "recipe"}
LOOK = {**LOOK, "place": ["curl"], "locks": [], "frame": None}


def picture(color: tuple[int, int, int] = (90, 60, 40), kind: str = "PNG", size: tuple[int, int] = (8, 5)) -> str:
    """A picture of one color in base64."""
    file = io.BytesIO()
    Image.new("RGB", size, color).save(file, kind)
    return base64.b64encode(file.getvalue()).decode()


def take(one: Page, **more: Any) -> dict[str, Any]:
    """Takes a snapshot; returns its entry."""
    one.send(kind="take_snapshot", look=LOOK, picture=picture(), **more)
    return one.receive("snapshots")["snapshots"][-1]


def set_curl(one: Page, **values: Any) -> dict[str, Any]:
    one.send(kind="set", changes=[[["curl", name], value] for name, value in values.items()], gesture=1)
    return one.receive("document")


def test_a_snapshot_is_readable_files_that_survive_and_that_all_pages_see(folder: Path):
    with serving(folder) as client, page(client, "one") as one, page(client, "two") as two:
        one.receive("snapshots", snapshots=[])
        two.receive("snapshots", snapshots=[])
        set_curl(one, width=2.0)
        taken = take(one, author="Ann", note="wider\nas agreed")
        assert two.receive("snapshots")["snapshots"] == [taken]
        data = two.receive("picture", name=f"snapshots/{taken['id']}")["data"].tobytes()
        assert Image.open(io.BytesIO(data)).size == (8, 5)
        two.send(kind="edit_snapshot", id=taken["id"], note="wider")  # a page that follows may, too
        assert one.receive("snapshots")["snapshots"][0]["note"] == "wider"
    files = folder / "small.review/snapshots"
    stored = tomllib.loads((files / f"{taken['id']}.toml").read_text())
    assert (stored["author"], stored["note"], stored["look"]["light"]) == ("Ann", "wider", "studio")
    assert "width = 2.0" in (files / f"{taken['id']}.recipe.toml").read_text()
    assert (files / f"{taken['id']}.png").read_bytes() == data
    assert "2.0" not in (folder / "small.recipe.toml").read_text()
    with serving(folder) as client, page(client) as one:
        assert [entry["id"] for entry in one.receive("snapshots")["snapshots"]] == [taken["id"]]
        one.receive("picture", name=f"snapshots/{taken['id']}")
        one.send(kind="delete_snapshot", id=taken["id"])
        one.receive("snapshots", snapshots=[])
    assert not list(files.iterdir())


def test_only_the_page_that_leads_loads_a_snapshot(folder: Path):
    with serving(folder) as client, page(client, "one") as one, page(client, "two") as two:
        one.receive("role", leads=True)
        two.receive("snapshots", snapshots=[])
        taken = take(two)
        two.send(kind="load_snapshot", id=taken["id"])
        assert "another page leads" in two.receive_trouble()


def test_loading_a_snapshot_is_one_undo_step_and_keeps_comments_of_the_recipe(folder: Path):
    recipe = folder / "small.recipe.toml"
    with serving(folder) as client, page(client) as one:
        one.receive("document")
        set_curl(one, width=2.0, pitch=2.5)
        taken = take(one)
        one.send(kind="undo")
        one.receive("document", dirty=False)
        recipe.write_text(recipe.read_text().replace("pitch = 1.5", "pitch = 1.6 # by hand"))
        before = one.receive("document")
        one.send(kind="load_snapshot", id=taken["id"])
        loaded = one.receive("document")
        assert (loaded["said"]["curl"]["width"], loaded["said"]["curl"]["pitch"]) == (2.0, 2.5)
        assert "pitch = 2.5 # by hand" in loaded["text"]
        one.send(kind="undo")
        assert one.receive("document")["text"] == before["text"]


def test_a_snapshot_of_a_variant_looks_the_same_after_its_base_has_changed(folder: Path):
    base, variant = folder / "small.recipe.toml", folder / "more.recipe.toml"
    variant.write_text('ringlet = 2\nextends = "small.recipe.toml"\n\n[curl]\nwidth = 1.4\n')
    with serving(folder, variant.name) as client, page(client) as one:
        points = one.receive("locks", side="a", draft=False)["points"]
        taken = take(one)
        one.send(kind="load_snapshot", id=taken["id"])
        assert one.receive("document")["text"] == variant.read_text()
        base.write_text(base.read_text().replace("pitch = 1.5", "pitch = 2.5"))
        assert one.receive("document")["values"]["curl"]["pitch"]["value"] == pytest.approx(0.025)
        one.send(kind="compare", to="snapshot", name=taken["id"], side="c")
        assert np.allclose(one.receive("locks", side="c")["points"], points)
        one.send(kind="load_snapshot", id=taken["id"])
        loaded = one.latest("document", dirty=True)
        assert loaded["values"]["curl"]["pitch"]["value"] == pytest.approx(0.015)
        assert any("extends no other" in message.get("message", "") for message in one.received)
        one.send(kind="undo")
        assert one.receive("document")["text"] == variant.read_text()


def test_edits_of_locks_and_muted_stages_come_back_with_a_snapshot(folder: Path):
    with serving(folder) as client, page(client) as one:
        ids = one.receive("locks", draft=False)["ids"]
        one.send(kind="isolate", locks=[int(ids[0])])
        with_edits = one.receive("document", dirty=True)
        one.send(kind="mute", stages=["curl"])
        assert muted(one.receive("document")) == {"curl"}
        taken = take(one)
        one.send(kind="undo")
        one.send(kind="undo")
        assert not muted(one.receive("document", dirty=False))
        one.send(kind="load_snapshot", id=taken["id"])
        back = one.receive("document", dirty=True)
        assert muted(back) == {"curl"} and back["edits"] == with_edits["edits"]


def muted(document: dict[str, Any]) -> set[str]:
    return {stage["name"] for stage in document["stages"] if stage["muted"]}


def test_looks_are_compared_with_all_their_settings(folder: Path):
    with serving(folder) as client, page(client) as one:
        one.receive("numbers", draft=False)
        taken = take(one, author="Ann", note="first")
        set_curl(one, width={"value": 2.0, "ramp": [[k / 40, 1 + k / 1000] for k in range(40)]})
        one.send(kind="compare", to="snapshot", name=taken["id"], side="b")
        one.send(kind="compare", to="saved", side="d")
        b, d = one.latest("compared", side="b"), one.latest("compared", side="d")  # their threads end in any order
        a = one.latest("compared", side="a")
        assert b["name"] == "first" and b["detail"].startswith("Ann, 2") and d["name"] == "as saved"
        assert b["settings"] == d["settings"] and b["settings"]["curl.width"] == "1.0"
        changed = {name for name, value in a["settings"].items() if b["settings"].get(name) != value}
        assert changed == {"curl.width.value", "curl.width.ramp"}
        assert a["settings"]["curl.width.ramp"].endswith("]]")  # whole
        one.send(kind="compare", to="none", side="b")
        assert one.receive("compared", side="b")["name"] == ""
        one.send(kind="set", changes=[[["curl", "width"], 3.0]], gesture=2)
        assert one.receive("compared", side="a")["settings"]["curl.width"] in ("3.0", "3")


REFUSED = {
    "no picture": ({"kind": "take_snapshot", "look": LOOK, "picture": "aGVsbG8="}, "must be a PNG or JPEG"),
    "no base64": ({"kind": "take_snapshot", "look": LOOK, "picture": "?"}, "must be a PNG or JPEG"),
    "large": (
        {"kind": "take_snapshot", "look": LOOK, "picture": picture(size=(9000, 1))},
        "has 9000 × 1 pixels; must be at most 8192",
    ),
    "unknown": ({"kind": "delete_snapshot", "id": "20200101-000000"}, "there is no 20200101-000000"),
    "outside": ({"kind": "delete_snapshot", "id": "../small"}, "id"),
    "to load": ({"kind": "load_snapshot", "id": "x"}, "there is no x"),
    "to compare": ({"kind": "compare", "to": "snapshot", "name": "x"}, "there is no x"),
}


@pytest.mark.parametrize("what", REFUSED)
def test_wrong_requests_are_refused_in_one_line_and_write_nothing(folder: Path, what: str):
    message, expected = REFUSED[what]
    with serving(folder) as client, page(client) as one:
        one.receive("snapshots")
        one.send(**message)
        assert expected in one.receive_trouble()
    assert not list(folder.glob("small.review/**/*"))


def test_what_another_program_changes_in_the_folder_is_seen(folder: Path, monkeypatch):
    monkeypatch.setattr("ringlet.viewer.disk_changes.FILES_INTERVAL", 0.1)
    with serving(folder) as client, page(client) as one:
        one.receive("snapshots")
        taken = take(one, note="first")
        file = folder / f"small.review/snapshots/{taken['id']}.toml"
        file.write_text(file.read_text().replace("first", "from a colleague"))
        assert one.receive("snapshots")["snapshots"][0]["note"] == "from a colleague"
        file.write_text("not toml")
        assert one.receive("snapshots")["snapshots"] == []
        assert "cannot be read" in one.receive("notice")["message"]
    assert file.read_text() == "not toml"


def test_the_folder_is_not_a_link_out_of_the_project(folder: Path):
    outside = folder.parent / "outside"
    outside.mkdir()
    (folder / "small.review").mkdir()
    (folder / "small.review/snapshots").symlink_to(outside)
    with serving(folder) as client, page(client) as one:
        one.receive("snapshots")
        one.send(kind="take_snapshot", look=LOOK, picture=picture())
        assert "outside of the project" in one.receive_trouble()
    assert not list(outside.iterdir())
