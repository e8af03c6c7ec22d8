"""What the server lets in, what it answers, and what it never reads."""

from __future__ import annotations

import json
import struct
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from fastapi.testclient import TestClient
from ringlet.errors import UserError
from ringlet.viewer.project import Project
from ringlet.viewer.protocol import VERSION
from ringlet.viewer.server import REFUSED, WRONG, Door, make_app
from ringlet.viewer.session import Session
from ringlet.viewer.wire import MOST
from small_example import write_example
from starlette.testclient import WebSocketTestSession
from starlette.websockets import WebSocketDisconnect

HOST = {"host": "localhost"}


class Page:
    """A page without a browser."""

    def __init__(self, socket: WebSocketTestSession) -> None:
        self.socket = socket
        self.heard: list[dict[str, Any]] = []

    def say(self, **message: Any) -> None:
        text = json.dumps(message).encode()
        self.socket.send_bytes(struct.pack("<I", len(text)) + text)

    def hear(self, kind: str, **wanted: Any) -> dict[str, Any]:
        """The next message of a kind that has the wanted values."""
        for _ in range(200):
            message = read(self.socket.receive_bytes())
            self.heard.append(message)
            if message["kind"] == kind and all(message[name] == value for name, value in wanted.items()):
                return message
            assert message["kind"] != "trouble", message["message"]
        raise AssertionError(f"no {kind} among {[m['kind'] for m in self.heard]}")

    def been_told(self, kind: str, **wanted: Any) -> dict[str, Any]:
        """The same, of those that were heard already, too: subjects come in no order of their own."""
        for message in reversed(self.heard):
            if message["kind"] == kind and all(message[name] == value for name, value in wanted.items()):
                return message
        return self.hear(kind, **wanted)


def read(data: bytes) -> dict[str, Any]:
    length = struct.unpack_from("<I", data)[0]
    message = json.loads(data[4 : 4 + length])
    at = 4 + length
    for name, kind, size in message.pop("arrays"):
        message[name] = np.frombuffer(data, np.dtype(kind), size, at)
        at += -(-size * np.dtype(kind).itemsize // 8) * 8
    return message


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    return write_example(tmp_path / "project")


@contextmanager
def serving(folder: Path, file: str = "small.recipe.toml", door: Door | None = None) -> Iterator[TestClient]:
    session = Session(folder / file, Project(folder))
    with TestClient(make_app(session, door or Door("127.0.0.1", "")), base_url="http://localhost") as client:
        yield client


@contextmanager
def page(client: TestClient, name: str = "one", hello: bool = True, **headers: str) -> Iterator[Page]:
    with client.websocket_connect("/session", headers={**HOST, **headers}) as socket:
        found = Page(socket)
        if hello:
            found.say(kind="hello", version=VERSION, client=name)
        yield found


def closed_with(client: TestClient, url: str = "/session", **headers: str) -> int:
    with (
        client.websocket_connect(url, headers={**HOST, **headers}) as socket,
        pytest.raises(WebSocketDisconnect) as end,
    ):
        socket.receive_bytes()
    return end.value.code


def test_a_page_is_told_all_there_is(folder: Path):
    with serving(folder) as client, page(client) as one:
        welcome = one.hear("welcome")
        assert one.heard[0]["kind"] == "welcome" and welcome["mode"] == "recipe"
        document, locks = one.hear("document"), one.hear("locks")
        assert document["said"]["curl"]["width"] == 1.0
        assert document["values"]["curl"]["width"]["value"] == pytest.approx(0.01)
        assert len(locks["ids"]) == 8 and locks["points"].shape == (8 * 40 * 3,)
        assert one.hear("numbers", draft=False)["hairs"] == 24


def test_an_edit_changes_the_groom_and_the_document_and_saving_writes_it(folder: Path):
    with serving(folder) as client, page(client) as one:
        before = one.hear("locks")["points"]
        one.hear("numbers")
        one.say(kind="set", changes=[[["curl", "width"], 2.0]], gesture=1)
        assert one.hear("document")["dirty"]
        after = one.hear("locks", draft=False)["points"]
        assert np.abs(after - before).max() > 0.002
        one.say(kind="undo")
        assert np.allclose(one.hear("locks", draft=False)["points"], before)
        one.say(kind="redo")
        one.say(kind="save")
        one.hear("saved")
        assert "width = 2.0" in (folder / "small.recipe.toml").read_text()


def test_hairs_come_in_an_order_of_which_the_beginning_is_spread_over_the_locks(folder: Path):
    with serving(folder) as client, page(client) as one:
        hairs = one.hear("hairs")
        assert sorted(hairs["lock"][:8]) == list(range(8))
        assert np.all(hairs["offset"][:16] == 0.0) and np.any(hairs["offset"][16:] != 0.0)


def test_muting_leaves_the_file_alone(folder: Path):
    with serving(folder) as client, page(client) as one:
        curled = one.hear("locks")["points"]
        one.hear("numbers")
        one.say(kind="mute", stages=["curl"])
        assert not one.hear("document")["dirty"]
        assert np.abs(one.hear("locks", draft=False)["points"] - curled).max() > 0.002


def test_one_leads_and_the_others_follow(folder: Path):
    with serving(folder) as client, page(client, "one") as one, page(client, "two") as two:
        assert one.hear("role", leads=True) and two.hear("role", leads=False)
        two.say(kind="set", changes=[[["curl", "width"], 2.0]], gesture=1)
        assert "leads" in two.hear("trouble")["message"]
        one.say(kind="set", changes=[[["curl", "width"], 1.4]], gesture=1)
        assert two.hear("document", dirty=True)["said"]["curl"]["width"] == 1.4
        two.say(kind="lead")
        assert two.hear("role", leads=True) and one.hear("role", leads=False)


def test_a_wrong_token_and_a_foreign_origin_are_refused(folder: Path):
    door = Door("127.0.0.1", "secret")
    with serving(folder, door=door) as client:
        assert closed_with(client) == REFUSED
        assert closed_with(client, "/session?token=wrong") == REFUSED
        assert closed_with(client, "/session?token=secret", origin="http://elsewhere.example") == REFUSED
        url = "/session?token=secret"
        with client.websocket_connect(url, headers={**HOST, "origin": "http://localhost"}) as socket:
            one = Page(socket)
            one.say(kind="hello", version=VERSION, client="one")
            assert one.hear("welcome")


def test_a_name_that_is_not_ours_gets_nothing(folder: Path):
    with serving(folder) as client:
        assert client.get("/", headers={"host": "rebound.example"}).status_code == 421
        assert closed_with(client, host="rebound.example") == REFUSED


def test_nothing_but_a_hello_opens_the_talk(folder: Path):
    with serving(folder) as client, client.websocket_connect("/session", headers=HOST) as socket:
        Page(socket).say(kind="undo")
        with pytest.raises(WebSocketDisconnect) as end:
            socket.receive_bytes()
        assert end.value.code == WRONG


@pytest.mark.parametrize(
    "data",
    [
        b"",
        b"\1\0",
        struct.pack("<I", 400) + b"{}",
        struct.pack("<I", 2) + b"{}",
        struct.pack("<I", 4) + b"\xff\xfe\xfd\xfc",
        b"\0" * (MOST + 1),
    ],
)
def test_malformed_messages_are_told_and_do_no_harm(folder: Path, data: bytes):
    with serving(folder) as client, page(client) as one:
        one.socket.send_bytes(data)
        assert one.hear("trouble")["message"].startswith("message:")
        one.say(kind="set", changes=[[["curl", "width"], 1.5]], gesture=1)
        assert one.hear("document", dirty=True)


def test_edits_that_make_no_sense_are_told_in_one_line(folder: Path):
    with serving(folder) as client, page(client) as one:
        for changes in ([[["curl", "width"], -3]], [[["nothing", "here"], 1]], [[[], 1]], [[["shape", 4, "size"], 1]]):
            one.say(kind="set", changes=changes, gesture=1)
            message = one.hear("trouble")["message"]
            assert "\n" not in message and "mistake in Ringlet" not in message
        one.say(kind="redo")
        one.say(kind="set", changes=[[["curl", "width"], 1.5]], gesture=1)
        assert one.hear("document", dirty=True)["said"]["curl"]["width"] == 1.5


@pytest.mark.parametrize(
    "change",
    [["scalp", "file"], ["extends"], ["edits"], ["guides", "file"], ["maps", "stiff"], ["curves", "tie", "file"]],
)
@pytest.mark.parametrize("outside", ["../other.usda", "/etc/passwd", "link.usda"])
def test_files_outside_of_the_project_are_never_read(folder: Path, change: list[str], outside: str):
    (folder.parent / "other.usda").write_text("#usda 1.0\n")
    (folder / "link.usda").symlink_to(folder.parent / "other.usda")
    with serving(folder) as client, page(client) as one:
        one.say(kind="set", changes=[[change, outside]], gesture=1)
        message = one.hear("trouble")["message"]
        assert "outside of the project" in message or "not a setting" in message


@pytest.mark.parametrize("name", ["../new", "/tmp/new", ".hidden", "a/b"])
def test_nothing_is_written_outside_of_the_project(folder: Path, name: str):
    before = sorted(folder.parent.rglob("*"))
    with serving(folder) as client, page(client) as one:
        one.say(kind="save", name=name)
        assert "save" in one.hear("trouble")["message"]
    assert sorted(folder.parent.rglob("*")) == before


def test_a_variant_says_only_what_differs(folder: Path):
    with serving(folder) as client, page(client) as one:
        one.say(kind="set", changes=[[["curl", "width"], 1.5]], gesture=1)
        one.say(kind="save", name="wide", variant=True)
        one.hear("saved")
    text = (folder / "wide.recipe.toml").read_text()
    assert 'extends = "small.recipe.toml"' in text and "width = 1.5" in text and "pitch" not in text


def test_a_server_that_was_started_anew_takes_back_what_a_page_still_had(folder: Path):
    with serving(folder) as client, page(client) as one:
        one.say(kind="set", changes=[[["curl", "width"], 1.7]], gesture=1)
        text = one.hear("document", dirty=True)["text"]
    with serving(folder) as client, page(client) as one:
        assert not one.hear("document")["dirty"]
        one.say(kind="restore", text=text)
        document = one.hear("document", dirty=True)
        assert document["said"]["curl"]["width"] == 1.7 and document["undo"]


def test_while_a_hand_moves_drafts_are_made_and_the_whole_when_it_rests(folder: Path):
    with serving(folder) as client, page(client) as one:
        one.hear("numbers", draft=False)
        one.say(kind="set", changes=[[["curl", "width"], 1.5]], gesture=1, resting=False)
        assert one.hear("locks")["draft"]
        time.sleep(0.05)
        one.say(kind="set", changes=[[["curl", "width"], 1.6]], gesture=1)
        assert one.hear("locks", draft=False)
        one.say(kind="undo")
        assert one.hear("document", dirty=False)


def test_a_file_outside_of_the_project_is_not_opened(folder: Path):
    with pytest.raises(UserError, match="outside of the project"):
        Session(folder / "small.recipe.toml", Project(folder / "elsewhere"))


def test_a_shot_runs_and_its_frames_come(folder: Path):
    with serving(folder, "small.shot.toml") as client, page(client) as one:
        assert one.hear("welcome")["mode"] == "shot"
        one.been_told("timeline", state="still")
        one.say(kind="play", action="start")
        frames = [one.hear("frame") for _ in range(4)]
        assert [frame["frame"] for frame in frames] == [1, 2, 3, 4]
        assert frames[0]["points"].shape == (8 * 40 * 3,) and len(frames[0]["curl"]) == 8 * 40
        assert np.abs(frames[3]["points"] - frames[0]["points"]).max() > 1e-3
        one.been_told("timeline", state="done")
        one.say(kind="set", file="shot", changes=[[["strands", "bend_scale"], 30.0]], gesture=1)
        one.say(kind="play", action="again_from", frame=2)
        again = [one.hear("frame") for _ in range(2)]
        assert [frame["frame"] for frame in again] == [3, 4]
        assert np.abs(again[1]["points"] - frames[3]["points"]).max() > 1e-6


def test_a_groom_and_its_cache_are_shown_as_they_are(folder: Path):
    import ringlet

    groom = ringlet.build_groom(folder / "small.recipe.toml")
    ringlet.write_groom(groom, folder / "groom.usda")
    ringlet.write_cache(
        ringlet.simulate(folder / "small.shot.toml", groom), folder / "groom.usda", folder / "cache.usda"
    )
    with serving(folder, "groom.usda") as client, page(client) as one:
        assert one.hear("welcome")["mode"] == "stage"
        assert len(one.hear("locks")["ids"]) == 8
        one.say(kind="set", changes=[[["curl", "width"], 2.0]], gesture=1)
        assert "no recipe" in one.hear("trouble")["message"]
    with serving(folder, "cache.usda") as client, page(client) as one:
        assert one.hear("frame", frame=4)["points"].shape == (8 * 40 * 3,)
        assert one.been_told("timeline", state="none")["last"] == 4


def test_a_lock_that_is_not_isolated_is_not_dragged(folder: Path):
    with serving(folder) as client, page(client) as one:
        lock = int(one.hear("locks")["ids"][0])
        one.hear("numbers")
        one.say(kind="drag", lock=lock, point=20, to=[0, 0.2, 0], gesture=1)
        assert "isolate" in one.hear("trouble")["message"]
        one.say(kind="isolate", locks=[lock])
        assert one.hear("locks", draft=False)["marked"][0] == 1
        one.say(kind="isolate", locks=[lock], out=False)
        assert one.hear("locks", draft=False)["marked"][0] == 0


def stroke(one: Page, guides: dict[str, Any], gesture: int = 7, **more: Any) -> None:
    """Combs the tip of the first guide 1 cm aside, in two messages."""
    tip = guides["points"].reshape(-1, 3)[guides["offsets"][1] - 1].tolist()
    told = {"tool": "comb", "radius": 0.02, "gesture": gesture, **more}
    one.say(kind="sculpt", at=tip, by=[0, 0, 0], resting=False, **told)
    one.say(kind="sculpt", at=tip, by=[0.01, 0, 0], **told)


def test_a_stroke_of_the_brush_is_one_step_and_is_saved_beside_the_recipe(folder: Path):
    with serving(folder) as client, page(client) as one:
        guides = one.hear("guides")
        before = one.been_told("locks")["points"]
        one.been_told("numbers", draft=False)
        stroke(one, guides)
        document = one.hear("document", dirty=True)
        assert document["said"]["edits"] == "small.edits.toml" and "[[sculpt]]" in document["edits"]
        after = one.hear("locks", draft=False)["points"]
        assert np.abs(after - before).max() > 0.002
        assert one.been_told("guides")["changed"].tolist() == [1, 0, 0, 0, 0, 0]
        assert not (folder / "small.edits.toml").exists()
        one.say(kind="undo")
        assert "edits" not in one.hear("document", dirty=False)["said"]
        assert np.array_equal(one.hear("locks", draft=False)["points"], before)
        one.say(kind="redo")
        one.say(kind="save")
        one.hear("saved")
    assert (folder / "small.edits.toml").read_text().count("guide = ") == 1
    with serving(folder) as client, page(client) as one:
        assert one.hear("guides")["changed"][0] == 1
        one.say(kind="unsculpt")
        assert one.hear("guides")["changed"].sum() == 0
        assert np.array_equal(one.been_told("guides")["points"], guides["points"])


def test_what_was_sculpted_is_given_back_to_a_server_that_was_started_anew(folder: Path):
    with serving(folder) as client, page(client) as one:
        stroke(one, one.hear("guides"))
        document = one.hear("document", dirty=True)
    with serving(folder) as client, page(client) as one:
        assert one.hear("guides")["changed"].sum() == 0
        one.say(kind="restore", text=document["text"], edits=document["edits"])
        assert one.hear("guides")["changed"][0] == 1
        one.say(kind="undo")
        assert one.hear("guides")["changed"].sum() == 0


def test_steps_are_undone_in_the_order_in_which_they_were_done_whatever_the_file(folder: Path):
    with serving(folder, "small.shot.toml") as client, page(client) as one:
        for file in ("recipe", "shot"):
            one.been_told("document", file=file)
        one.say(kind="set", file="recipe", changes=[[["curl", "width"], 1.5]], gesture=1)
        one.hear("document", file="recipe", dirty=True)
        one.say(kind="set", file="shot", changes=[[["held"], 3]], gesture=2)
        one.hear("document", file="shot", dirty=True)
        one.say(kind="undo")
        one.hear("document", file="shot", dirty=False)
        assert one.been_told("document", file="recipe")["dirty"]
        one.say(kind="undo")
        one.hear("document", file="recipe", dirty=False)
        one.say(kind="redo")
        assert one.hear("document", file="recipe", dirty=True)["said"]["curl"]["width"] == 1.5


SHAPES = """
[[shape]]
op = "scraggle"
amount = 0.2
[[shape]]
op = "clump"
size = 3
[[shape]]
op = "scraggle"
amount = 0.1
"""


@pytest.fixture
def extended(folder: Path) -> Path:
    """A recipe that extends one with three operators."""
    base = folder / "small.recipe.toml"
    base.write_text(base.read_text() + SHAPES)
    (folder / "more.recipe.toml").write_text('ringlet = 1\nextends = "small.recipe.toml"\n[curl]\nwidth = 1.3\n')
    return folder


def test_operators_of_a_base_are_changed_and_removed_by_name(extended: Path):
    with serving(extended, "more.recipe.toml") as client, page(client) as one:
        assert [stage["op"] for stage in one.hear("document")["stages"]][2:5] == ["scraggle", "clump", "scraggle"]
        one.say(kind="set", changes=[[["shape", 2, "amount"], 0.4]], gesture=1)
        document = one.hear("document", dirty=True)
        assert document["said"]["shape"] == [{}, {}, {"amount": 0.4}]
        assert document["values"]["shape"][2]["amount"]["value"] == 0.004
        one.say(kind="arrange", action="remove", at=0)
        document = one.hear("document")
        assert [stage["op"] for stage in document["stages"]][2:4] == ["clump", "scraggle"]
        assert document["values"]["shape"][1]["amount"]["value"] == 0.004
        one.say(kind="arrange", action="remove", at=1)
        assert [stage["op"] for stage in one.hear("document")["stages"]][2:4] == ["clump", "curl"]
        one.say(kind="arrange", action="move", at=0, to=0)
        assert "neither move nor add" in one.hear("trouble")["message"]
        one.say(kind="save")
        one.hear("saved")
    text = (extended / "more.recipe.toml").read_text()
    assert "scraggle = false" in text and '"scraggle 2" = false' in text


@pytest.mark.parametrize(
    "say",
    [
        {"kind": "set", "changes": [[["hairs"], None]]},
        {"kind": "set", "changes": [[["locks", "points"], None]]},
        {"kind": "set", "changes": [[["curl", "width"], None]]},
        {"kind": "set", "changes": [[["curl"], None]]},
        {
            "kind": "set",
            "changes": [[["shape", 1, "size"], None], [["shape", 2, "amount"], {"value": 0.3, "vary": 0.1}]],
        },
        {"kind": "arrange", "action": "remove", "at": 0},
        {"kind": "arrange", "action": "move", "at": 0, "to": 1},
    ],
)
def test_a_variant_makes_what_was_seen_also_where_something_was_taken_out(extended: Path, say: dict[str, Any]):
    from ringlet.groom import read_recipe

    with serving(extended) as client, page(client) as one:
        one.hear("document")
        one.say(**say, **({"gesture": 1} if say["kind"] == "set" else {}))
        values = one.hear("document", dirty=True)["values"]
        one.say(kind="save", name="other", variant=True)
        one.hear("saved")
    made = read_recipe(extended / "other.recipe.toml").model_dump(mode="json")
    assert {**made, "extends": None, "sculpt": None} == {**values, "sculpt": None}
    assert "count = 6" not in (extended / "other.recipe.toml").read_text()


def test_a_variant_that_cannot_say_what_was_changed_is_not_written(folder: Path):
    with serving(folder) as client, page(client) as one:
        one.say(kind="set", changes=[[["locks", "count"], None]], gesture=1)  # a variant cannot say "no count"
        one.hear("document", dirty=True)
        one.say(kind="save", name="other", variant=True)
        assert "save a copy instead" in one.hear("trouble")["message"]
    assert not (folder / "other.recipe.toml").exists()


def test_a_setting_of_one_lock_alone_changes_that_lock_and_no_other(folder: Path):
    with serving(folder) as client, page(client) as one:
        locks = one.hear("locks")
        one.been_told("numbers", draft=False)
        lock = int(locks["ids"][3])
        one.say(kind="set", changes=[[["curl", "width", "lock", str(lock)], 2.5]], gesture=1)
        assert one.hear("document", dirty=True)["said"]["curl"]["width"] == {"value": 1.0, "lock": {str(lock): 2.5}}
        moved = np.abs(one.hear("locks", draft=False)["points"] - locks["points"]).reshape(8, -1).max(axis=1)
        assert moved[3] > 0.002 and np.delete(moved, 3).max() == 0.0


def test_the_page_is_told_what_settings_may_name(folder: Path):
    recipe = folder / "small.recipe.toml"
    recipe.write_text(recipe.read_text() + "[curves.tie]\npoints = [[0, 12, 0], [1, 12, 0]]\n")
    with serving(folder) as client, page(client) as one:
        names = one.hear("names")
        assert names["regions"] == ["scalp"] and names["curves"] == ["tie"]


def test_nails_and_what_is_in_the_head_are_measured_at_rest(folder: Path):
    recipe = folder / "small.recipe.toml"
    recipe.write_text(recipe.read_text() + '[[nail]]\nreach = "1 cm"\n[clean]\nmargin = 0\n')
    text = recipe.read_text().replace("[clean]\nmargin = 0\n", "").replace("length = 5", "length = 5\ndroop = 3")
    with serving(folder) as client, page(client) as one:
        measured = one.hear("measured")
        nail = measured["nail"].reshape(8, 40)
        assert np.all(nail[:, 0] == 255) and np.all(nail[:, -1] == 0)
        one.say(kind="restore", text=text)
        one.say(kind="mute", stages=["clean"])
        one.hear("numbers", draft=False)
        inside = one.hear("measured")
        assert inside["inside"] > 0 and inside["depth"].max() > 0


def test_frames_tell_what_touches_and_what_is_in_the_head(folder: Path):
    shot = folder / "small.shot.toml"
    shot.write_text(shot.read_text().replace("frames = [1, 4]", "frames = [1, 2]") + "[contact]\nradius = 0.004\n")
    recipe = folder / "small.recipe.toml"
    recipe.write_text(recipe.read_text().replace("length = 5", "length = 5\ndroop = 3"))  # locks lie on the head
    with serving(folder, "small.shot.toml") as client, page(client) as one:
        one.been_told("timeline", state="still")
        one.say(kind="play", action="start")
        frame = one.hear("frame", frame=2)
        assert len(frame["contact"]) == len(frame["depth"]) == 8 * 40
        assert frame["statistics"]["contacts"] > 0 and frame["contact"].max() > 0
        assert frame["statistics"]["inside"] == 0 and frame["depth"].max() == 0
