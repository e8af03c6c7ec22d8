"""What the pages of a session say, and what becomes of the groom and its files."""

from __future__ import annotations

import time
from pathlib import Path
from typing import Any

import numpy as np
from pages import Page, page, read, serving

import ringlet
from ringlet import io


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


def test_muting_leaves_the_file_unchanged(folder: Path):
    with serving(folder) as client, page(client) as one:
        curled = one.hear("locks")["points"]
        one.hear("numbers")
        one.say(kind="mute", stages=["curl"])
        assert not one.hear("document")["dirty"]
        assert np.abs(one.hear("locks", draft=False)["points"] - curled).max() > 0.002


def test_one_page_holds_the_edit_lock_and_the_others_follow(folder: Path):
    with serving(folder) as client, page(client, "one") as one, page(client, "two") as two:
        assert one.hear("role", leads=True) and two.hear("role", leads=False)
        two.say(kind="set", changes=[[["curl", "width"], 2.0]], gesture=1)
        assert "leads" in two.hear("trouble")["message"]
        one.say(kind="set", changes=[[["curl", "width"], 1.4]], gesture=1)
        assert two.hear("document", dirty=True)["said"]["curl"]["width"] == 1.4
        two.say(kind="lead")
        assert two.hear("role", leads=True) and one.hear("role", leads=False)


def test_a_restarted_server_restores_the_document_of_a_page(folder: Path):
    with serving(folder) as client, page(client) as one:
        one.say(kind="set", changes=[[["curl", "width"], 1.7]], gesture=1)
        text = one.hear("document", dirty=True)["text"]
    with serving(folder) as client, page(client) as one:
        assert not one.hear("document")["dirty"]
        one.say(kind="restore", text=text)
        document = one.hear("document", dirty=True)
        assert document["said"]["curl"]["width"] == 1.7 and document["undo"]


def test_every_page_receives_the_build_error_until_the_groom_is_built(folder: Path):
    recipe = folder / "small.recipe.toml"
    recipe.write_text(recipe.read_text().replace('region = "scalp"', 'region = "gone"'))
    with serving(folder) as client:
        for name in ("one", "two"):
            with page(client, name) as one:
                while (message := read(one.socket.receive_bytes()))["kind"] != "trouble":
                    pass
                assert "no region 'gone'" in message["message"]
        with page(client, "one") as one:
            one.say(kind="restore", text=recipe.read_text().replace("gone", "scalp"))
            while read(one.socket.receive_bytes())["kind"] != "numbers":
                pass
        with page(client, "one") as one:
            assert one.hear("numbers")["locks"] == 8  # and no trouble before it


def test_only_caches_are_offered_for_comparison(folder: Path, tmp_path, monkeypatch):
    def offered(one) -> list[str]:
        return [name for name in one.hear("files")["names"] if ".usd" in name]

    groom, other = folder / "groom.usdc", tmp_path / "elsewhere"
    other.mkdir()
    ringlet.write_groom(ringlet.build_groom(folder / "small.recipe.toml"), groom)
    cache = ringlet.simulate(folder / "small.shot.toml")
    for path in (folder / "cache.usdc", folder / "text.usda", other / "cache.usdc"):
        ringlet.write_cache(cache, groom, path)
    ringlet.write_hairs(groom, folder / "hair.usdc")
    (folder / "damaged.usdc").write_bytes((folder / "cache.usdc").read_bytes()[:300])
    (folder / "odd.usda").write_text("#usda 1.0\n(\n    customLayerData = {\n        int ringlet = 3\n    }\n)\n")
    (folder / "empty.usd").touch()
    (folder / "link.usdc").symlink_to(other / "cache.usdc")
    looked: list[str] = []
    is_cache = io.is_cache
    monkeypatch.setattr(io, "is_cache", lambda path: looked.append(path.name) or is_cache(path))
    monkeypatch.setattr("ringlet.viewer.session.LOOK_EVERY", 0.1)
    with serving(folder) as client:
        with page(client) as one:
            assert offered(one) == ["cache.usdc", "text.usda"] and "cache.usdc" in looked
            looked.clear()
            (folder / "new.usdc").write_bytes((folder / "cache.usdc").read_bytes())  # while the page is open
            while (names := offered(one)) != ["cache.usdc", "new.usdc", "text.usda"]:
                assert set(names) < {"cache.usdc", "new.usdc", "text.usda"}
            assert set(looked) == {"new.usdc"}  # the others have not changed
            (folder / "cache.usdc").write_bytes(groom.read_bytes())
            while offered(one) != ["new.usdc", "text.usda"]:
                pass
        with page(client, "later") as two:
            assert offered(two) == ["new.usdc", "text.usda"]


def test_a_reconnected_page_receives_the_count_of_processed_messages(folder: Path):
    with serving(folder) as client:
        with page(client) as one:
            assert one.hear("welcome")["heard"] == 0
            one.say(kind="set", changes=[[["curl", "width"], 1.7]], gesture=1)
            one.say(kind="set", changes=[[["no", "such"], 1.7]], gesture=2)  # refused, and heard
            while (message := read(one.socket.receive_bytes()))["kind"] != "heard" or message["count"] < 2:
                pass
        with page(client) as one:
            assert one.hear("welcome")["heard"] == 2
        with page(client, "other") as other:
            assert other.hear("welcome")["heard"] == 0


def test_a_drag_builds_drafts_and_its_end_the_full_groom(folder: Path):
    with serving(folder) as client, page(client) as one:
        one.hear("numbers", draft=False)
        one.say(kind="set", changes=[[["curl", "width"], 1.5]], gesture=1, resting=False)
        assert one.hear("locks")["draft"]
        time.sleep(0.05)
        one.say(kind="set", changes=[[["curl", "width"], 1.6]], gesture=1)
        assert one.hear("locks", draft=False)
        one.say(kind="undo")
        assert one.hear("document", dirty=False)


def test_only_an_isolated_lock_is_dragged(folder: Path):
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


def test_a_brush_stroke_is_one_step_and_is_saved_beside_the_recipe(folder: Path):
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


def test_a_restarted_server_restores_sculpts(folder: Path):
    with serving(folder) as client, page(client) as one:
        stroke(one, one.hear("guides"))
        document = one.hear("document", dirty=True)
    with serving(folder) as client, page(client) as one:
        assert one.hear("guides")["changed"].sum() == 0
        one.say(kind="restore", text=document["text"], edits=document["edits"])
        assert one.hear("guides")["changed"][0] == 1
        one.say(kind="undo")
        assert one.hear("guides")["changed"].sum() == 0


def test_undo_follows_the_order_of_edits_across_files(folder: Path):
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


def test_a_setting_of_one_lock_changes_no_other_lock(folder: Path):
    with serving(folder) as client, page(client) as one:
        locks = one.hear("locks")
        one.been_told("numbers", draft=False)
        lock = int(locks["ids"][3])
        one.say(kind="set", changes=[[["curl", "width", "lock", str(lock)], 2.5]], gesture=1)
        assert one.hear("document", dirty=True)["said"]["curl"]["width"] == {"value": 1.0, "lock": {str(lock): 2.5}}
        moved = np.abs(one.hear("locks", draft=False)["points"] - locks["points"]).reshape(8, -1).max(axis=1)
        assert moved[3] > 0.002 and np.delete(moved, 3).max() == 0.0
