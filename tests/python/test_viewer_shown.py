"""What pages are shown: hairs, shots, caches, and what is measured in them."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from pages import page, serving


def test_hairs_come_in_an_order_of_which_the_beginning_is_spread_over_the_locks(folder: Path):
    with serving(folder) as client, page(client) as one:
        hairs = one.hear("hairs")
        assert sorted(hairs["lock"][:8]) == list(range(8))
        assert np.all(hairs["offset"][:16] == 0.0) and np.any(hairs["offset"][16:] != 0.0)


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
