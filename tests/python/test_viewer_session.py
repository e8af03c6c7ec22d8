"""Sessions: edits of pages, the groom and its files, undo, and reconnection."""

from __future__ import annotations

import time
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from pages import Page, page, read, serving

import ringlet
from ringlet import io


def test_an_edit_changes_the_groom_and_the_document_and_saving_writes_it(folder: Path):
    with serving(folder) as client, page(client) as one:
        before = one.receive("locks")["points"]
        one.receive("numbers")
        one.send(kind="set", changes=[[["curl", "width"], 2.0]], gesture=1)
        assert one.receive("document")["dirty"]
        after = one.receive("locks", draft=False)["points"]
        assert np.abs(after - before).max() > 0.002
        one.send(kind="undo")
        assert np.allclose(one.receive("locks", draft=False)["points"], before)
        one.send(kind="redo")
        one.send(kind="save")
        one.receive("saved")
        assert "width = 2.0" in (folder / "small.recipe.toml").read_text()


def test_muting_leaves_the_file_unchanged(folder: Path):
    with serving(folder) as client, page(client) as one:
        curled = one.receive("locks")["points"]
        one.receive("numbers")
        one.send(kind="mute", stages=["curl"])
        assert not one.receive("document")["dirty"]
        assert np.abs(one.receive("locks", draft=False)["points"] - curled).max() > 0.002


def test_one_page_holds_the_edit_lock_and_the_others_follow(folder: Path):
    with serving(folder) as client, page(client, "one") as one, page(client, "two") as two:
        assert one.receive("role", leads=True) and two.receive("role", leads=False)
        two.send(kind="set", changes=[[["curl", "width"], 2.0]], gesture=1)
        assert "leads" in two.receive("trouble")["message"]
        one.send(kind="set", changes=[[["curl", "width"], 1.4]], gesture=1)
        assert two.receive("document", dirty=True)["said"]["curl"]["width"] == 1.4
        two.send(kind="lead")
        assert one.receive("role", asked=True) and two.receive("role", asks=True)
        one.send(kind="hand", over=False)
        assert two.receive("role", asks=False, leads=False)
        two.send(kind="lead")
        one.receive("role", asked=True)
        one.send(kind="hand", over=True)
        assert two.receive("role", leads=True) and one.receive("role", leads=False)


def test_a_page_knows_whether_it_leads_before_what_it_may_edit(folder: Path):
    with serving(folder) as client, page(client) as one, page(client, "two") as two:
        for each, leads in ((one, True), (two, False)):
            each.receive("document")
            assert [message["kind"] for message in each.received[:2]] == ["welcome", "role"]
            assert each.received[1]["leads"] == leads


def test_a_page_that_does_not_answer_hands_the_edit_lock_over(folder: Path, monkeypatch):
    monkeypatch.setattr("ringlet.viewer.edit_lock.ANSWER_AFTER", 0.1)
    with serving(folder) as client, page(client, "one") as one, page(client, "two") as two:
        one.receive("role", leads=True)
        two.send(kind="lead")
        assert two.receive("role", leads=True)


def test_pages_that_follow_receive_the_look_of_the_one_that_leads(folder: Path):
    look = {"camera": [0.0] * 6, "light": "studio", "color": "", "overlay": "", "file": "recipe", "locks": []}
    with serving(folder) as client, page(client, "one") as one:
        one.send(kind="look", place=["curl"], frame=None, **look)
        with page(client, "two") as two:
            assert two.receive("followed")["place"] == ["curl"]
            two.send(kind="look", place=["locks"], frame=None, **look)
            two.send(kind="point", at=[0.0, 0.0, 0.0])
            one.send(kind="look", place=["guides"], frame=None, **look)
            one.send(kind="point", at=[0.1, 0.2, 0.3])
            assert two.receive("followed")["place"] == ["guides"]
            assert two.receive("pointer")["at"] == [0.1, 0.2, 0.3]
        assert not [message for message in one.received if message["kind"] in ("followed", "pointer")]


def people(one: Page) -> list[dict[str, Any]]:
    return one.receive("role")["people"]


def test_people_have_names_and_colors_of_their_own(folder: Path):
    with serving(folder) as client, page(client, "one") as one:
        assert [person["name"] for person in people(one)] == ["Guest 1"]
        with page(client, "two") as two:
            found = people(two)
            assert [(each["name"], each["leads"], each["you"]) for each in found] == [
                ("Guest 1", True, False),
                ("Guest 2", False, True),
            ]
            assert found[0]["hue"] != (hue := found[1]["hue"])
            two.send(kind="introduce", person="  Bo   of Paris ", follows=False)
            while (last := people(one)[-1])["name"] != "Bo of Paris":
                pass
            assert not last["follows"] and last["hue"] == hue
        while len(people(one)) > 1:
            pass
        with page(client, "three"), page(client, "two") as two:
            assert people(two)[-1]["hue"] == hue  # a page that comes back keeps its color


def test_who_asks_to_edit_is_named_and_the_answer_is_announced(folder: Path):
    with serving(folder) as client, page(client, "one") as one, page(client, "two") as two:
        two.send(kind="introduce", person="Bo")
        two.send(kind="lead")
        assert one.receive("role", asked=True)["asking"] == "Bo"
        one.send(kind="hand", over=False)
        assert two.receive("notice")["message"] == "Guest 1 goes on editing"
        two.send(kind="lead")
        one.receive("role", asked=True)
        one.send(kind="hand", over=True)
        assert one.receive("notice")["message"] == two.receive("notice")["message"] == "Bo can edit now"


def test_a_page_that_edits_keeps_the_lock_until_it_rests(folder: Path, monkeypatch):
    monkeypatch.setattr("ringlet.viewer.edit_lock.ANSWER_AFTER", 1.5)
    with serving(folder) as client, page(client, "one") as one, page(client, "two") as two:
        two.send(kind="lead")
        one.receive("role", asked=True)
        for k in range(24):
            one.send(kind="set", changes=[[["curl", "width"], 1.0 + 0.05 * k]], gesture=1)
            one.receive("heard")
            time.sleep(0.1)
        assert one.latest("role")["leads"]
        assert two.receive("role", leads=True)


def forget_unsaved(folder: Path) -> None:
    """Removes the journal, as in a folder that cannot be written."""
    (folder / ".small.recipe.toml.unsaved").unlink()


def test_a_restarted_server_restores_the_document_of_a_page(folder: Path):
    with serving(folder) as client, page(client) as one:
        edited = one_edit(one)
    forget_unsaved(folder)
    with serving(folder) as client, page(client) as one:
        assert not one.receive("document")["dirty"]
        one.send(kind="restore", **{name: edited[name] for name in ("text", "saved")})
        document = one.receive("document", dirty=True)
        assert document["said"]["curl"]["width"] == 1.7 and document["undo"]


def one_edit(one: Page) -> dict[str, Any]:
    """Changes a setting; returns the document."""
    one.send(kind="set", changes=[[["curl", "width"], 1.7]], gesture=1)
    return one.receive("document", dirty=True)


def test_every_page_receives_the_build_error_until_the_groom_is_built(folder: Path):
    recipe = folder / "small.recipe.toml"
    recipe.write_text(recipe.read_text().replace('region = "scalp"', 'region = "gone"'))
    with serving(folder) as client:
        for name in ("one", "two"):
            with page(client, name) as one:
                while not (problems := one.receive("problems")["problems"]):
                    pass
                assert problems[0]["subject"] == "groom" and "no region 'gone'" in problems[0]["message"]
        with page(client, "one") as one:
            one.send(kind="restore", text=recipe.read_text().replace("gone", "scalp"))
            one.receive("numbers")
        with page(client, "one") as one:
            assert one.receive("numbers")["locks"] == 8
            assert not one.latest("problems")["problems"]


def test_only_caches_are_offered_for_comparison(folder: Path, tmp_path, monkeypatch):
    def offered(one) -> list[str]:
        return [name for name in one.receive("files")["names"] if ".usd" in name]

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
    checked: list[str] = []
    is_cache = io.is_cache
    monkeypatch.setattr(io, "is_cache", lambda path: checked.append(path.name) or is_cache(path))
    monkeypatch.setattr("ringlet.viewer.disk_changes.FILES_INTERVAL", 0.1)
    with serving(folder) as client:
        with page(client) as one:
            assert offered(one) == ["cache.usdc", "text.usda"] and "cache.usdc" in checked
            checked.clear()
            (folder / "new.usdc").write_bytes((folder / "cache.usdc").read_bytes())  # while the page is open
            while (names := offered(one)) != ["cache.usdc", "new.usdc", "text.usda"]:
                assert set(names) < {"cache.usdc", "new.usdc", "text.usda"}
            assert set(checked) == {"new.usdc"}  # unchanged files are not read again
            (folder / "cache.usdc").write_bytes(groom.read_bytes())
            while offered(one) != ["new.usdc", "text.usda"]:
                pass
        with page(client, "later") as two:
            assert offered(two) == ["new.usdc", "text.usda"]


def test_a_reconnected_page_receives_the_count_of_processed_messages(folder: Path):
    with serving(folder) as client:
        with page(client) as one:
            assert one.receive("welcome")["heard"] == 0
            one.send(kind="set", changes=[[["curl", "width"], 1.7]], gesture=1)
            one.send(kind="set", changes=[[["no", "such"], 1.7]], gesture=2)  # refused but counted
            while (message := read(one.socket.receive_bytes()))["kind"] != "heard" or message["count"] < 2:
                pass
        with page(client) as one:
            assert one.receive("welcome")["heard"] == 2
        with page(client, "other") as other:
            assert other.receive("welcome")["heard"] == 0


def test_a_drag_builds_drafts_and_its_end_the_full_groom(folder: Path):
    with serving(folder) as client, page(client) as one:
        one.receive("numbers", draft=False)
        one.send(kind="set", changes=[[["curl", "width"], 1.5]], gesture=1, resting=False)
        assert one.receive("locks")["draft"]
        time.sleep(0.05)
        one.send(kind="set", changes=[[["curl", "width"], 1.6]], gesture=1)
        assert one.receive("locks", draft=False)
        one.send(kind="undo")
        assert one.receive("document", dirty=False)


def test_only_an_isolated_lock_is_dragged(folder: Path):
    with serving(folder) as client, page(client) as one:
        lock = int(one.receive("locks")["ids"][0])
        one.receive("numbers")
        one.send(kind="drag", lock=lock, point=20, to=[0, 0.2, 0], gesture=1)
        assert "isolate" in one.receive("trouble")["message"]
        one.send(kind="isolate", locks=[lock])
        before = one.receive("locks", draft=False)
        assert before["marked"][0] == 1
        tip = before["points"].reshape(8, 40, 3)[0, -1]
        one.send(kind="drag", lock=lock, point=39, to=(tip + [0.01, 0, 0]).tolist(), falloff=0.3, gesture=2)
        after = one.receive("locks", draft=False)["points"] - before["points"]
        moved = np.linalg.norm(after.reshape(8, 40, 3), axis=2)
        assert moved[0, -1] > 0.005 and moved[0, 0] == 0 and moved[1:].max() < 1e-6
        one.send(kind="isolate", locks=[lock], out=False)
        back = one.receive("locks", draft=False)
        assert back["marked"][0] == 0 and "edit" not in one.latest("document", dirty=False)["said"]


def stroke(one: Page, guides: dict[str, Any], gesture: int = 7, **more: Any) -> None:
    """Combs the tip of the first guide by 1 cm in two messages."""
    tip = guides["points"].reshape(-1, 3)[guides["offsets"][1] - 1].tolist()
    brush = {"tool": "comb", "radius": 0.02, "gesture": gesture, **more}
    one.send(kind="sculpt", at=tip, by=[0, 0, 0], resting=False, **brush)
    one.send(kind="sculpt", at=tip, by=[0.01, 0, 0], **brush)


def test_a_brush_stroke_is_one_step_and_is_saved_beside_the_recipe(folder: Path):
    with serving(folder) as client, page(client) as one:
        guides = one.receive("guides")
        before = one.latest("locks")["points"]
        one.latest("numbers", draft=False)
        stroke(one, guides)
        document = one.receive("document", dirty=True)
        assert document["said"]["edits"] == "small.edits.toml" and "[[sculpt]]" in document["edits"]
        after = one.receive("locks", draft=False)["points"]
        assert np.abs(after - before).max() > 0.002
        while not (changed := one.latest("guides")["changed"]).any():
            one.receive("guides")
        assert changed.tolist() == [1, 0, 0, 0, 0, 0]
        assert not (folder / "small.edits.toml").exists()
        one.send(kind="undo")
        assert "edits" not in one.receive("document", dirty=False)["said"]
        assert np.array_equal(one.receive("locks", draft=False)["points"], before)
        one.send(kind="redo")
        one.send(kind="save")
        one.receive("saved")
    assert (folder / "small.edits.toml").read_text().count("guide = ") == 1
    with serving(folder) as client, page(client) as one:
        assert one.receive("guides")["changed"][0] == 1
        one.send(kind="unsculpt")
        assert one.receive("guides")["changed"].sum() == 0
        assert np.array_equal(one.latest("guides")["points"], guides["points"])


def test_frozen_guides_stay_under_every_brush(folder: Path):
    with serving(folder) as client, page(client) as one:
        guides = one.receive("guides")
        one.latest("numbers", draft=False)
        tip = guides["points"].reshape(-1, 3)[guides["offsets"][1] - 1].tolist()
        brush = {"at": tip, "by": [0, 0, 0], "radius": 0.02, "gesture": 1}
        one.send(kind="sculpt", tool="freeze", **brush)
        assert one.receive("guides")["frozen"].tolist() == [1, 0, 0, 0, 0, 0]
        stroke(one, guides, gesture=2)
        one.receive("guides")
        assert np.array_equal(one.receive("guides")["points"], guides["points"])
        one.send(kind="sculpt", tool="thaw", **brush)
        assert not one.receive("guides")["frozen"].any()
        stroke(one, guides, gesture=3)
        one.receive("guides")
        assert not np.array_equal(one.receive("guides")["points"], guides["points"])


def test_a_restarted_server_restores_sculpts(folder: Path):
    with serving(folder) as client, page(client) as one:
        stroke(one, one.receive("guides"))
        document = one.receive("document", dirty=True)
    forget_unsaved(folder)
    with serving(folder) as client, page(client) as one:
        assert one.receive("guides")["changed"].sum() == 0
        one.send(kind="restore", text=document["text"], edits=document["edits"])
        assert one.receive("guides")["changed"][0] == 1
        one.send(kind="undo")
        assert one.receive("guides")["changed"].sum() == 0


def test_undo_follows_the_order_of_edits_across_files(folder: Path):
    with serving(folder, "small.shot.toml") as client, page(client) as one:
        for file in ("recipe", "shot"):
            one.latest("document", file=file)
        one.send(kind="set", file="recipe", changes=[[["curl", "width"], 1.5]], gesture=1)
        one.receive("document", file="recipe", dirty=True)
        one.send(kind="set", file="shot", changes=[[["held"], 3]], gesture=2)
        one.receive("document", file="shot", dirty=True)
        one.send(kind="undo")
        one.receive("document", file="shot", dirty=False)
        assert one.latest("document", file="recipe")["dirty"]
        one.send(kind="undo")
        one.receive("document", file="recipe", dirty=False)
        one.send(kind="redo")
        assert one.receive("document", file="recipe", dirty=True)["said"]["curl"]["width"] == 1.5


def test_a_setting_of_one_lock_changes_no_other_lock(folder: Path):
    with serving(folder) as client, page(client) as one:
        locks = one.receive("locks")
        one.latest("numbers", draft=False)
        lock = int(locks["ids"][3])
        one.send(kind="set", changes=[[["curl", "width", "lock", str(lock)], 2.5]], gesture=1)
        assert one.receive("document", dirty=True)["said"]["curl"]["width"] == {"value": 1.0, "lock": {str(lock): 2.5}}
        moved = np.abs(one.receive("locks", draft=False)["points"] - locks["points"]).reshape(8, -1).max(axis=1)
        assert moved[3] > 0.002 and np.delete(moved, 3).max() == 0.0


@pytest.mark.filterwarnings("ignore::ringlet.data.former_names.FormerNames")
def test_a_file_with_former_names_is_shown_by_present_names_and_saved_with_its_comments(folder: Path):
    recipe = folder / "small.recipe.toml"
    old = recipe.read_text().replace("ringlet = 2", "ringlet = 1").replace("length = 5", "length = 5\ndroop = 3 # down")
    recipe.write_text(old)
    with serving(folder) as client, page(client) as one:
        assert (document := one.receive("document"))["said"]["guides"]["gravity_bend"] == 3 and not document["dirty"]
        (problem,) = one.latest("problems")["problems"]
        assert problem["message"].startswith("small.recipe.toml: guides.droop is now gravity_bend; the next save")
        before = one.receive("locks", draft=False)["points"]
        one.send(kind="set", changes=[[["guides", "gravity_bend"], 1]], gesture=1)
        assert np.abs(one.receive("locks", draft=False)["points"] - before).max() > 0.002
        assert recipe.read_text() == old
        one.send(kind="save")
        one.receive("saved")
        assert not one.latest("problems")["problems"]
    assert recipe.read_text() == old.replace("ringlet = 1", "ringlet = 2").replace("droop = 3", "gravity_bend = 1")
