"""Content of pages: hairs, shots, cloth, names and measurements."""

from __future__ import annotations

import threading
from pathlib import Path

import numpy as np
import pytest
from pages import page, read, serving
from ringlet.data.pigment import curve_reflectance
from ringlet.groom.thinning import spread
from ringlet.viewer.show import display_groom
from small_example import write_head
from wear import SCARF, write_wear

import ringlet
from ringlet.groom import make_hairs


def test_the_first_hairs_are_spread_over_all_locks(folder: Path):
    with serving(folder) as client, page(client) as one:
        hairs = one.receive("hairs")
        assert sorted(hairs["lock"][:8]) == list(range(8))
        assert np.all(hairs["offset"][:16] == 0.0) and np.any(hairs["offset"][16:] != 0.0)


def test_a_page_that_comes_later_gets_few_hairs_that_stand_for_all_then_the_locks_then_all(
    folder: Path, monkeypatch: pytest.MonkeyPatch
):
    monkeypatch.setattr(display_groom, "GLIMPSE", 8)
    with serving(folder) as client:
        with page(client) as one:
            whole = one.receive("hairs")
            one.receive("numbers", draft=False)
        with page(client) as two:
            few, locks, later = two.receive("hairs"), two.receive("locks"), two.receive("hairs")
        assert few["count"] == 8 < whole["count"] == later["count"] and len(locks["ids"]) == 8
        assert sorted(few["lock"]) == list(range(8)) and np.array_equal(few["lock"], whole["lock"][:8])
        assert few["width"] == pytest.approx(whole["width"][:8] * whole["count"] / 8)
        assert np.array_equal(few["thinning"], whole["thinning"])


def test_the_head_is_shown_before_its_groom_is_made_and_once(folder: Path, monkeypatch: pytest.MonkeyPatch):
    seen, made = threading.Event(), display_groom.make_groom

    def make_groom(*inputs, **named):
        assert seen.wait(30)
        return made(*inputs, **named)

    monkeypatch.setattr(display_groom, "make_groom", make_groom)
    with serving(folder) as client, page(client) as one:
        subject, body = one.receive("subject"), one.receive("body")
        seen.set()
        one.receive("numbers", draft=False)
        roots = one.latest("locks")["points"].reshape(8, -1, 3)[:, 0]
        low, high = np.array(subject["low"]), np.array(subject["high"])
        assert np.all(roots > low - 1e-3) and np.all(roots < high + 1e-3)
        assert np.ptp(body["points"].reshape(-1, 3), axis=0).max() >= (high - low).max()
        one.send(kind="set", changes=[[["curl", "width"], 1.5]], gesture=1)
        one.receive("numbers", draft=False)
        bodies = [message["index"] for message in one.received if message["kind"] == "body"]
        assert bodies == sorted(set(bodies))


def test_a_shot_streams_its_frames_and_reruns_from_a_frame(folder: Path):
    with serving(folder, "small.shot.toml") as client, page(client) as one:
        assert one.receive("welcome")["mode"] == "shot"
        one.latest("timeline", state="still")
        one.send(kind="play", action="start")
        frames = one.watch(1, 2, 3, 4)
        assert [frame["frame"] for frame in frames] == [1, 2, 3, 4]
        assert frames[0]["points"].shape == (8 * 40 * 3,) and len(frames[0]["curl"]) == 8 * 40
        assert np.abs(frames[3]["points"] - frames[0]["points"]).max() > 1e-3
        first = one.latest("timeline", state="done")
        one.send(kind="set", file="shot", changes=[[["strands", "bend_scale"], 30.0]], gesture=1)
        one.send(kind="play", action="again_from", frame=2)
        one.receive("timeline", key=first["key"] + 1)
        again = one.watch(3, 4)
        assert [frame["frame"] for frame in again] == [3, 4]
        assert np.abs(again[1]["points"] - frames[3]["points"]).max() > 1e-6


def test_a_groom_and_its_cache_are_shown_read_only(folder: Path):
    groom = ringlet.build_groom(folder / "small.recipe.toml")
    ringlet.write_groom(groom, folder / "groom.usda")
    ringlet.write_cache(
        ringlet.simulate(folder / "small.shot.toml", groom), folder / "groom.usda", folder / "cache.usda"
    )
    with serving(folder, "groom.usda") as client, page(client) as one:
        assert one.receive("welcome")["mode"] == "stage"
        assert len(one.receive("locks")["ids"]) == 8
        one.send(kind="set", changes=[[["curl", "width"], 2.0]], gesture=1)
        assert "no recipe" in one.receive("trouble")["message"]
    with serving(folder, "cache.usda") as client, page(client) as one:
        assert one.receive("timeline", state="none")["frames"].tolist() == [1, 2, 3, 4]
        last, second = one.watch(4, 2)
        assert (last["frame"], second["frame"]) == (4, 2) and last["points"].shape == (8 * 40 * 3,)
        assert np.abs(last["points"] - second["points"]).max() > 1e-3


def test_cloth_and_colliders_of_a_shot_are_shown_in_place(folder: Path):
    write_wear(folder)
    write_head(folder / "hand.usda")
    shot = folder / "small.shot.toml"
    shot.write_text(shot.read_text() + SCARF + '[[collider]]\n[[collider]]\nfile = "hand.usda"\nanimated = false\n')
    groom = ringlet.build_groom(folder / "small.recipe.toml")
    cache = ringlet.simulate(shot, groom)
    assert np.abs(cache.cloths[0].points[3] - cache.cloths[0].points[0]).max() > 1e-3
    with serving(folder, shot.name) as client, page(client) as one:
        one.latest("timeline", state="still")
        one.send(kind="play", action="start")
        first, last = one.watch(1, 4)
        bodies = {body["index"]: body for body in one.received if body["kind"] == "body"}
        assert [bodies[k]["name"] for k in range(3)] == ["skin", "scarf", "skin"] and bodies[1]["made_of"] == "cloth"
        head = len(bodies[0]["points"])
        for frame, number in ((first, 0), (last, 3)):
            assert np.abs(frame["bodies"][head : head + 3 * 81] - cache.cloths[0].points[number].ravel()).max() < 1e-6
        assert np.abs(last["bodies"][:head] - first["bodies"][:head]).max() > 0.01
        assert np.array_equal(last["bodies"][head + 3 * 81 :], first["bodies"][:head])
    ringlet.write_groom(groom, folder / "groom.usda")
    ringlet.write_cache(cache, folder / "groom.usda", folder / "cache.usda")
    with serving(folder, "cache.usda") as client, page(client) as one:
        assert {one.receive("body")["made_of"] for _ in range(2)} == {"cloth", "skin"}
        (last,) = one.watch(4)
        scarf = cache.cloths[0].points[3].ravel()
        assert np.abs(last["bodies"][-len(scarf) :] - scarf).max() < 1e-6


def test_an_unreadable_cloth_is_reported_and_the_groom_shown(folder: Path):
    shot = folder / "small.shot.toml"
    shot.write_text(shot.read_text() + SCARF)
    with serving(folder, shot.name) as client, page(client) as one:
        kinds: set[str] = set()
        while "timeline" not in kinds:
            kinds.add(read(one.socket.receive_bytes())["kind"])
        assert {"body", "locks"} <= kinds
        one.send(kind="play", action="start")
        while (message := read(one.socket.receive_bytes()))["kind"] != "trouble":
            pass
        assert "wear.usda: there is no such file" in message["message"]


def test_the_page_receives_the_names_that_settings_may_use(folder: Path):
    recipe = folder / "small.recipe.toml"
    recipe.write_text(recipe.read_text() + "[curves.tie]\npoints = [[0, 12, 0], [1, 12, 0]]\n")
    with serving(folder) as client, page(client) as one:
        names = one.receive("names")
        assert names["regions"] == ["scalp"] and names["curves"] == ["tie"]


def test_pins_and_penetration_of_the_head_are_measured_at_rest(folder: Path):
    recipe = folder / "small.recipe.toml"
    recipe.write_text(recipe.read_text() + '[[pin]]\nlength = "1 cm"\n[collide]\nmargin = 0\n')
    text = (
        recipe.read_text().replace("[collide]\nmargin = 0\n", "").replace("length = 5", "length = 5\ngravity_bend = 3")
    )
    with serving(folder) as client, page(client) as one:
        measured = one.receive("measured")
        pin = measured["pin"].reshape(8, 40)
        assert np.all(pin[:, 0] == 255) and np.all(pin[:, -1] == 0)
        one.send(kind="restore", text=text)
        one.send(kind="mute", stages=["collide"])
        one.receive("numbers", draft=False)
        inside = one.receive("measured")
        if inside["inside"] == 0:  # measured before the collide stage was muted
            inside = one.receive("measured")
        assert inside["inside"] > 0 and inside["depth"].max() > 0


def test_frames_include_contacts_and_penetration_of_the_head(folder: Path):
    shot = folder / "small.shot.toml"
    shot.write_text(shot.read_text().replace("frames = [1, 4]", "frames = [1, 2]") + "[contact]\nradius = 0.004\n")
    recipe = folder / "small.recipe.toml"
    recipe.write_text(
        recipe.read_text().replace("length = 5", "length = 5\ngravity_bend = 3")
    )  # lowers the locks onto the head
    with serving(folder, "small.shot.toml") as client, page(client) as one:
        one.latest("timeline", state="still")
        one.send(kind="play", action="start")
        frame = one.watch(2)[0]
        assert len(frame["contact"]) == len(frame["depth"]) == 8 * 40
        assert frame["statistics"]["contacts"] > 0 and frame["contact"].max() > 0
        assert frame["statistics"]["inside"] == 0 and frame["depth"].max() == 0


def test_the_page_receives_the_colours_that_files_have(folder: Path):
    with serving(folder) as client, page(client) as one:
        assert one.receive("colors")["stations"] == 0, "a recipe without colour has none"
        color = {"preset": "brown", "melanin": {"value": 0.8, "ramp": [[0, 1], [1, 0.3]]}}
        one.send(kind="set", changes=[[["color"], color]], gesture=1)
        colors = one.receive("colors")
        one.send(kind="set", changes=[[["color", "gray"], 1.0]], gesture=2)
        white = one.receive("colors")
    recipe = folder / "small.recipe.toml"
    recipe.write_text(
        recipe.read_text() + '[color]\npreset = "brown"\nmelanin = { value = 0.8, ramp = [[0, 1], [1, 0.3]] }\n'
    )
    made = make_hairs(ringlet.build_groom(recipe))
    hairs, order = made.curves, spread(np.diff(made.layout["first"]))
    ends = curve_reflectance(hairs, "hairs").reshape(len(hairs), -1, 3)[:, [0, -1]]
    shown = (colors["reflectance"].reshape(len(hairs), colors["stations"], 3) / 255.0) ** 4
    assert np.allclose(shown[:, [0, -1]], ends[order], rtol=0.05, atol=1e-4)
    assert white["reflectance"].min() > 200


def test_some_hairs_in_a_row_are_a_part_of_each_lock_and_cover_its_cross_section():
    counts = np.array([300, 60, 600, 300])
    first = np.append(0, np.cumsum(counts))
    order = spread(counts)
    assert sorted(order) == list(range(counts.sum()))
    for part in np.split(order, 4):
        for begin, count in zip(first, counts, strict=False):
            number = part[(part >= begin) & (part < begin + count)] - begin
            assert len(number) == pytest.approx(count / 4, abs=1)
            angle = number * np.pi * (3.0 - np.sqrt(5.0))  # the spiral of a lock
            places = np.sqrt(number / count)[:, None] * np.stack([np.cos(angle), np.sin(angle)], axis=1)
            assert np.linalg.norm(places.mean(axis=0)) < 0.2
            assert np.linalg.norm(places, axis=1).mean() == pytest.approx(2 / 3, abs=0.05)
