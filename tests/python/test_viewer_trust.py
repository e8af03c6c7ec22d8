"""No edit in the review is lost: outside writes, killed servers, pages that leave, and grooms that cannot be made."""

from __future__ import annotations

import random
from collections import Counter
from contextlib import suppress
from pathlib import Path
from typing import Any

import pytest
from pages import Page, page, serving
from ringlet.data.errors import UserError
from ringlet.viewer import protocol
from ringlet.viewer.files.conflicts import differences
from ringlet.viewer.files.document import set_value
from ringlet.viewer.files.merge import Versions
from ringlet.viewer.pages import Page as SessionPage
from ringlet.viewer.project import Project
from ringlet.viewer.session import Session
from ringlet.viewer.show.grooming import Grooming

from ringlet.groom import read_recipe


def edit(one: Page, width: float, gesture: int = 1, **more: Any) -> None:
    one.send(kind="set", changes=[[["curl", "width"], width]], gesture=gesture, **more)


def problem(one: Page, subject: str) -> dict[str, Any]:
    """Waits for a problem."""
    while True:
        for message in reversed(one.received):
            found = [each for each in message.get("problems", []) if each["subject"] == subject]
            if found:
                return found[0]
        one.receive("problems")


def problem_with(one: Page, subject: str, words: str) -> dict[str, Any]:
    """Waits for a problem whose message has these words."""
    while words not in (found := problem(one, subject))["message"]:
        one.receive("problems")
    return found


def without_problem(one: Page, subject: str) -> None:
    """Waits until a problem is gone."""
    while any(each["subject"] == subject for each in one.receive("problems")["problems"]):
        pass


def press(one: Page, found: dict[str, Any], label: str) -> None:
    """Presses a button of a problem."""
    message = next(fix["message"] for fix in found["fixes"] if fix["label"] == label)
    one.send(**message, **({"gesture": 99} if message["kind"] == "set" else {}))


# Outside writes


def test_an_outside_write_is_loaded_as_an_undo_step(folder: Path):
    recipe = folder / "small.recipe.toml"
    with serving(folder) as client, page(client) as one:
        before = one.receive("document")["text"]
        recipe.write_text(before.replace("pitch = 1.5", "pitch = 1.9 # by hand"))
        document = one.receive("document", dirty=False)
        assert document["said"]["curl"]["pitch"] == 1.9 and document["undo"]
        one.send(kind="undo")
        document = one.receive("document", dirty=True)
        assert document["text"] == before
    assert "by hand" in recipe.read_text()


def test_an_outside_write_of_the_base_of_a_variant_is_seen(folder: Path):
    base, variant = folder / "small.recipe.toml", folder / "more.recipe.toml"
    variant.write_text('ringlet = 2\nextends = "small.recipe.toml"\n')
    with serving(folder, variant.name) as client, page(client) as one:
        one.receive("document")
        base.write_text(base.read_text().replace("pitch = 1.5", "pitch = 1.9"))
        assert one.receive("document")["values"]["curl"]["pitch"]["value"] == pytest.approx(0.019)


@pytest.fixture
def conflict(folder: Path):
    """A page with another width and length, and a file with another pitch and width."""
    recipe = folder / "small.recipe.toml"
    with serving(folder) as client, page(client) as one:
        one.receive("document")
        one.send(kind="set", changes=[[["curl", "width"], 2.0], [["guides", "length"], 6]], gesture=1)
        one.receive("document", dirty=True)
        recipe.write_text(recipe.read_text().replace("pitch = 1.5", "pitch = 1.9 # by hand").replace("1.0", "1.2"))
        yield one, recipe


def test_a_conflict_is_shown_and_saving_is_refused_until_it_is_resolved(conflict: tuple[Page, Path]):
    one, recipe = conflict
    differences = {each["name"]: each for each in problem(one, "conflict/recipe")["differences"]}
    assert {name for name, each in differences.items() if each["both"]} == {"curl.width"}
    pitch = differences["curl.pitch"]
    assert (pitch["base"], pitch["mine"], pitch["theirs"]) == ("1.5", "1.5", "1.9")
    one.send(kind="save")
    with pytest.raises(AssertionError, match="changed by another program; choose first"):
        one.receive("saved")
    assert "by hand" in recipe.read_text() and "2.0" not in recipe.read_text()


def test_a_conflict_is_noticed_at_saving_before_the_watcher_has_seen_it(folder: Path, monkeypatch):
    monkeypatch.setattr("ringlet.viewer.disk_changes.WATCH_INTERVAL", 60.0)
    recipe = folder / "small.recipe.toml"
    with serving(folder) as client, page(client) as one:
        edit(one, 2.0)
        one.receive("document", dirty=True)
        recipe.write_text(recipe.read_text().replace("pitch = 1.5", "pitch = 1.9"))
        one.send(kind="save")
        assert problem(one, "conflict/recipe")
    assert "pitch = 1.9" in recipe.read_text() and "2.0" not in recipe.read_text()


@pytest.mark.parametrize("choice, width, pitch, length", [("mine", 2.0, 1.5, 6), ("theirs", 1.2, 1.9, 5)])
def test_a_conflict_is_resolved_by_one_side(conflict: tuple[Page, Path], choice: str, width, pitch, length):
    one, recipe = conflict
    press(one, problem(one, "conflict/recipe"), "Keep mine" if choice == "mine" else "Load theirs")
    without_problem(one, "conflict/recipe")
    said = one.receive("document", dirty=choice == "mine")["said"]
    assert (said["curl"]["width"], said["curl"]["pitch"], said["guides"]["length"]) == (width, pitch, length)
    one.send(kind="save")
    one.receive("saved")
    assert f"pitch = {pitch}" in recipe.read_text()


def test_a_conflict_is_merged_by_setting(conflict: tuple[Page, Path]):
    one, recipe = conflict
    problem(one, "conflict/recipe")
    one.send(kind="resolve", choice="merge", mine=["guides.length"], theirs=["curl.pitch"])
    with pytest.raises(AssertionError, match=r"curl\.width differs; choose one"):
        one.receive("saved")
    one.send(kind="resolve", choice="merge", mine=["guides.length", "curl.width"], theirs=["curl.pitch"])
    one.send(kind="save")
    one.receive("saved")
    text = recipe.read_text()
    assert "width = 2.0" in text and "pitch = 1.9 # by hand" in text and "length = 6" in text


def test_a_merge_takes_whole_lists_of_operators_with_their_comments():
    base = 'ringlet = 2\n\n[[shape]]\nop = "clump"\n\n[curl]\nwidth = 1\n'
    mine = base.replace("[curl]", '# flat\n[[shape]]\nop = "volume" # a little\n\n[curl]')
    theirs = base.replace("width = 1", "width = 2 # wide")
    versions = Versions(base, mine, theirs)
    (place, difference), _ = versions.differences()
    assert place == ["shape"] and not difference.both
    assert versions.merged([place]) == mine.replace("width = 1", "width = 2 # wide")


# Grooms that cannot be made


def test_a_groom_that_cannot_be_made_has_remedies_and_saving_asks(folder: Path):
    with serving(folder) as client, page(client) as one:
        one.receive("numbers", draft=False)
        one.send(kind="set", changes=[[["curl", "pitch"], "2 mm"]], gesture=1)
        found = problem(one, "groom")
        assert found["setting"] == "locks.points" and "too few" in found["message"]
        labels = [fix["label"] for fix in found["fixes"]]
        assert labels[0].startswith("Set points to ") and labels[-1] == "Undo"
        one.send(kind="save")
        asked = problem(one, "save")
        assert "2 mm" not in (folder / "small.recipe.toml").read_text()
        press(one, found, labels[0])
        assert one.receive("numbers", draft=False)
        assert one.latest("document")["said"]["locks"]["points"] > 40
        assert [fix["label"] for fix in asked["fixes"]] == ["Save anyway", "Go on"]


def test_a_groom_of_many_times_the_work_waits_for_a_word(folder: Path, monkeypatch):
    monkeypatch.setattr("ringlet.viewer.show.work.SMALL", 10_000)
    with serving(folder) as client, page(client) as one:
        one.receive("numbers", draft=False)
        one.send(kind="set", changes=[[["locks", "count"], 200]], gesture=1)
        found = problem(one, "work")
        assert "25 times as many points" in found["message"]
        press(one, found, "Make it")
        assert one.receive("numbers", draft=False)["locks"] == 200
        one.send(kind="undo")  # fewer are no question
        assert one.receive("numbers", draft=False)["locks"] == 8


# Gestures


def test_a_draft_is_completed_when_no_hand_is_heard(folder: Path):
    with serving(folder) as client, page(client) as one:
        one.receive("numbers", draft=False)
        edit(one, 1.5, resting=False)
        assert one.receive("numbers")["draft"]
        assert one.receive("numbers", draft=False)


def test_a_draft_is_completed_when_its_page_leaves(folder: Path, monkeypatch):
    monkeypatch.setattr("ringlet.viewer.editing.REST_AFTER", 60.0)
    with serving(folder) as client, page(client, "two") as two:
        two.receive("numbers", draft=False)
        with page(client, "one") as one:
            one.send(kind="lead")
            two.receive("role", asked=True)
            two.send(kind="hand", over=True)
            one.receive("role", leads=True)
            edit(one, 1.5, resting=False)
            assert two.receive("numbers")["draft"]
        assert two.receive("numbers", draft=False)


def test_acting_alone_keeps_the_mutes(folder: Path):
    recipe = folder / "small.recipe.toml"
    recipe.write_text(recipe.read_text() + '[[shape]]\nop = "scraggle"\n[[shape]]\nop = "volume"\n')
    with serving(folder) as client, page(client) as one:
        one.send(kind="mute", stages=["shape/0"])
        one.send(kind="mute", stages=["shape/0"], solo="shape/1")
        one.send(kind="mute", stages=["shape/0"])
        one.receive("document", undo=True)
        stages = {tuple(stage["place"]): stage for stage in one.receive("document")["stages"]}
        assert stages["shape", 1]["solo"] and stages["shape", 0]["muted"] and not stages["shape", 1]["muted"]
        stages = {tuple(stage["place"]): stage for stage in one.receive("document")["stages"]}
        assert [place for place, stage in stages.items() if stage["muted"]] == [("shape", 0)]


# Frames


def test_frames_tell_their_run_and_come_back_with_their_groom(folder: Path):
    with serving(folder, "small.shot.toml") as client, page(client) as one:
        one.receive("numbers", draft=False)
        one.send(kind="play", action="start")
        timeline = one.receive("timeline", state="done")
        assert timeline["runs"].tolist() == [1] * 4 and not timeline["stale"].any()
        one.send(kind="set", file="shot", changes=[[["strands", "bend_scale"], 0.5]], gesture=1)
        while not one.receive("timeline")["stale"].all():
            pass
        one.send(kind="play", action="again_from", frame=2)
        timeline = one.receive("timeline", state="done")
        assert timeline["runs"].tolist() == [1, 1, 2, 2] and timeline["stale"].tolist() == [1, 1, 0, 0]
        edit(one, 1.4)
        while len(one.receive("timeline")["frames"]):
            pass
        one.send(kind="undo")
        while not len((timeline := one.receive("timeline"))["frames"]):
            pass
        assert timeline["runs"].tolist() == [1, 1, 2, 2]
        assert len(one.watch(1.0, 4.0)) == 2


# Files


def test_operators_are_added_to_a_recipe_that_extends_another(folder: Path):
    base = folder / "small.recipe.toml"
    base.write_text(base.read_text() + '[curves.wave]\npoints = [[0, 9, 0], [0, 14, 0]]\n[[shape]]\nop = "volume"\n')
    (folder / "more.recipe.toml").write_text('ringlet = 2\nextends = "small.recipe.toml"\n')
    with serving(folder, "more.recipe.toml") as client, page(client) as one:
        one.send(kind="arrange", action="add", at=1, op="attract", values={"curve": "wave"})
        one.send(kind="arrange", action="add", at=2, op="scraggle")
        one.send(kind="arrange", action="move", at=2, to=1)
        one.send(kind="arrange", action="remove", at=2)
        one.receive("document")
        ops = [[stage["op"] for stage in one.receive("document")["stages"]][2:-5] for _ in range(4)]
        assert ops == [
            ["volume", "attract"],
            ["volume", "attract", "scraggle"],
            ["volume", "scraggle", "attract"],
            ["volume", "scraggle"],
        ]
        one.send(kind="save")
        one.receive("saved")
    assert [operator.op for operator in read_recipe(folder / "more.recipe.toml").shape] == ["volume", "scraggle"]


def test_saving_as_goes_on_with_the_new_file(folder: Path):
    before = (folder / "small.recipe.toml").read_text()
    with serving(folder) as client, page(client) as one:
        edit(one, 1.5)
        one.send(kind="save", name="wide")
        assert one.receive("welcome", name="wide.recipe.toml")
        assert not one.receive("document", name="wide.recipe.toml")["dirty"]
        edit(one, 1.6, gesture=2)
        one.receive("document", dirty=True)
        one.send(kind="save")
        one.receive("document", dirty=False)
    assert (folder / "small.recipe.toml").read_text() == before
    assert "width = 1.6" in (folder / "wide.recipe.toml").read_text()


def test_a_shot_uses_the_copy_of_its_recipe_when_it_is_asked_to(folder: Path):
    before = (folder / "small.recipe.toml").read_text()
    with serving(folder, "small.shot.toml") as client, page(client) as one:
        one.receive("numbers", draft=False)
        edit(one, 1.5)
        one.send(kind="save", name="wide")
        found = problem(one, "copied")
        assert "the shot still names small.recipe.toml" in found["message"]
        edit(one, 1.6, gesture=2)
        one.receive("numbers")
        assert "copied" in {
            each["subject"] for each in one.latest("problems")["problems"]
        }  # a new groom leaves the offer
        press(one, found, "Use wide.recipe.toml in the shot")  # the copy lacks this change
        with pytest.raises(AssertionError, match="was changed since its copy was saved"):
            one.receive("welcome")
        one.send(kind="undo")
        one.send(kind="save", name="wider")
        press(one, problem_with(one, "copied", "wider"), "Use wider.recipe.toml in the shot")
        assert one.receive("welcome", mode="shot")
        document = one.receive("document", name="wider.recipe.toml")
        assert document["said"]["curl"]["width"] == 1.5 and not document["dirty"]
    assert (folder / "small.recipe.toml").read_text() == before
    assert 'groom = "wider.recipe.toml"' in (folder / "small.shot.toml").read_text()


def test_a_recipe_that_is_deleted_is_reported_and_written_again(folder: Path):
    recipe = folder / "small.recipe.toml"
    text = recipe.read_text()
    with serving(folder) as client, page(client) as one:
        one.receive("numbers", draft=False)
        recipe.unlink()
        found = problem(one, "gone/recipe")
        assert (
            found["message"]
            == "small.recipe.toml is no longer on disk; what it said is kept here, and Save writes it again"
        )
        recipe.write_text(text)  # it is back
        while one.receive("problems")["problems"]:
            pass
        recipe.unlink()
        press(one, problem(one, "gone/recipe"), "Save")
        one.receive("saved")
        assert recipe.read_text() == text
        assert "gone/recipe" not in {each["subject"] for each in one.latest("problems")["problems"]}


def test_a_shot_that_is_saved_with_its_recipe_under_other_names_names_the_copy(folder: Path):
    before = {path: path.read_text() for path in (folder / "small.recipe.toml", folder / "small.shot.toml")}
    with serving(folder, "small.shot.toml") as client, page(client) as one:
        one.receive("numbers", draft=False)
        edit(one, 1.5)
        one.receive("numbers", draft=False)
        one.send(kind="set", file="shot", changes=[[["name"], "slow"]], gesture=2, resting=True)
        one.receive("document", file="shot", dirty=True)
        one.send(kind="save", name="wide")
        one.send(kind="save", file="shot", name="slow", with_copy=True)
        assert one.receive("welcome", name="slow.shot.toml")["mode"] == "shot"
        assert one.receive("document", name="wide.recipe.toml")["said"]["curl"]["width"] == 1.5
    slow = (folder / "slow.shot.toml").read_text()
    assert 'groom = "wide.recipe.toml"' in slow and 'name = "slow"' in slow
    assert before == {path: path.read_text() for path in before}


def test_another_file_is_opened_and_unsaved_changes_keep_it_out(folder: Path):
    other = folder / "other.recipe.toml"
    other.write_text((folder / "small.recipe.toml").read_text().replace("count = 8", "count = 9"))
    with serving(folder) as client, page(client) as one:
        one.receive("numbers", draft=False)
        one.send(kind="open", name="other.recipe.toml")
        assert one.receive("welcome", name="other.recipe.toml")
        assert one.receive("numbers", draft=False)["locks"] == 9
        edit(one, 1.5)
        one.receive("document", dirty=True)
        one.send(kind="open", name="small.shot.toml")
        with pytest.raises(AssertionError, match="has unsaved changes; save them, or discard them"):
            one.receive("welcome", mode="shot")
        one.send(kind="open", name="small.shot.toml", discard=True)
        assert one.receive("welcome", mode="shot") and one.receive("document", file="shot")
        assert one.receive("timeline")
        one.send(kind="open", name="../elsewhere.toml")
        with pytest.raises(AssertionError, match="outside of the project"):
            one.receive("welcome")


# The end of a server


class Killed(BaseException):
    """The server dies."""


class Client:
    """A page that resends what it was not answered, as ``web/src/link.ts`` does."""

    def __init__(self, number: int) -> None:
        self.name, self.owed, self.heard = f"page {number}", list[protocol.FromPage](), 0

    def join(self, session: Session) -> None:
        """Connects, and says again what the server has not heard."""
        self.page: SessionPage = session.join(self.name, leads=True)
        session.handle(self.page, protocol.Lead())
        now = session._heard[self.name] - 1
        self.owed, self.heard = self.owed[max(0, now - self.heard) :], session._heard[self.name]
        again, self.owed = self.owed, []
        for message in again:
            self.say(session, message)

    def say(self, session: Session, message: protocol.FromPage) -> None:
        """Sends a message; it is owed until it is answered, also by a refusal."""
        self.owed.append(message)
        with suppress(UserError):
            session.handle(self.page, message)
        self.owed.pop(0)
        self.heard += 1


def test_a_hundred_kills_outside_writes_and_leaving_pages_lose_nothing(folder: Path, monkeypatch):
    """Each lock gets a value of its own on the page, or in the file, with random ends in between."""
    chance = random.Random(7)
    record, dying = Session._record, [""]

    def mortal(session: Session) -> None:
        when, dying[0] = dying[0], ""
        if when == "before":
            raise Killed
        record(session)
        if when == "after":
            raise Killed

    monkeypatch.setattr(Session, "_record", mortal)
    monkeypatch.setattr(Grooming, "request", lambda grooming, **_: None)  # the groom is no part of this
    here, there = ("width", "phase", "irregularity", "kink", "wave"), ("pitch", "start", "flatness", "taper", "end")

    def edited(recipe: Path, locks: int) -> Counter[str]:
        """Edits a recipe and returns how often what happened; nothing is lost."""

        def start() -> Session:
            return Session(recipe, Project(folder))

        session, client, happened = start(), Client(0), Counter[str]()
        client.join(session)
        for lock in range(locks):
            if session.files.recipe.theirs is not None:
                client.say(session, _merge(session))
            change = protocol.Set(changes=[(["curl", here[lock % len(here)], "lock", str(lock)], 0.5)], gesture=lock)
            dying[0] = chance.choice(["", *4 * ["before", "after"]])
            try:
                if chance.random() < 0.3:
                    client.say(session, protocol.Save())
                client.say(session, change)
            except Killed:
                happened["kills"] += 1
                said = change in client.owed
                session = start()
                client.join(session)
                if not said:
                    client.say(session, change)
            if chance.random() < 0.5:
                happened["writes"] += 1
                place: list[str | int] = ["curl", there[lock % len(there)], "lock", str(lock)]
                recipe.write_text(set_value(recipe.read_text(), place, 0.5))
                if chance.random() < 0.5:  # the watcher sees it
                    session._disk.meet({recipe})
            if chance.random() < 0.5:
                happened["leaves"] += 1
                session.leave(client.page)
                client = Client(happened["leaves"])
                client.join(session)
        session.files.meet_disk("recipe")
        if session.files.recipe.theirs is not None:
            session.handle(client.page, _merge(session))
        session.handle(client.page, protocol.Save())
        curl = read_recipe(recipe).curl
        assert curl is not None
        assert sorted(int(lock) for name in here for lock in getattr(curl, name).lock) == list(range(locks))
        assert sum(len(getattr(curl, name).lock) for name in there) == happened["writes"]
        return happened

    happened = Counter[str]()
    for part in range(10):  # files grow with each lock, and with them the time of an edit
        recipe = folder / f"part{part}.recipe.toml"
        recipe.write_text((folder / "small.recipe.toml").read_text())
        happened += edited(recipe, 12)
    assert happened["kills"] >= 100 and min(happened["writes"], happened["leaves"]) > 50


def _merge(session: Session) -> protocol.Resolve:
    """Keeps all that each side changed."""
    names = [(one.name, one.mine != one.base) for one in differences(session.files.recipe)]
    mine = [name for name, changed in names if changed]
    return protocol.Resolve(choice="merge", mine=mine, theirs=[name for name, changed in names if not changed])


def test_a_killed_server_comes_back_with_unsaved_changes_and_counts_of_messages(folder: Path):
    session = Session(folder / "small.recipe.toml", Project(folder))
    one = session.join("one")
    session.handle(one, protocol.Set(changes=[(["curl", "width"], 1.7)], gesture=1))
    del session  # without its end
    with serving(folder) as client, page(client) as again:
        welcome = again.receive("welcome")
        assert welcome["heard"] == 1 and welcome["recovered"]
        document = again.receive("document", dirty=True)
        assert document["said"]["curl"]["width"] == 1.7 and document["undo"]
        press(again, problem(again, "recovered"), "Discard them")
        again.receive("document", dirty=False)
    assert not list(folder.glob(".*"))


def test_changes_of_a_killed_server_meet_those_that_were_written_meanwhile(folder: Path):
    recipe = folder / "small.recipe.toml"
    session = Session(recipe, Project(folder))
    session.handle(session.join("one"), protocol.Set(changes=[(["curl", "width"], 1.7)], gesture=1))
    del session
    recipe.write_text(recipe.read_text().replace("pitch = 1.5", "pitch = 1.9"))
    with serving(folder) as client, page(client) as one:
        names = {each["name"] for each in problem(one, "conflict/recipe")["differences"]}
        assert names == {"curl.width", "curl.pitch"}


def test_an_unreadable_journal_is_set_aside(folder: Path):
    (folder / ".small.recipe.toml.unsaved").write_text("{")
    with serving(folder) as client, page(client) as one:
        assert "unreadable" in problem(one, "recovered")["message"]
    assert (folder / ".small.recipe.toml.unsaved.unreadable").read_text() == "{"


def test_the_page_that_led_leads_again_after_a_restart(folder: Path):
    with serving(folder) as client, page(client, "two") as two:
        assert two.receive("role", leads=True)
        with page(client, "one", hello=False) as one:
            one.send(kind="hello", version=protocol.VERSION, client="one", leads=True)
            assert one.receive("role", leads=True) and two.receive("role", leads=False)
