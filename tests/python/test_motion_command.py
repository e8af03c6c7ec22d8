"""``ringlet motion``: the words of a shot's locks, before it is simulated and after."""

import json

import numpy as np
import pytest
from commands import edit, refused, run
from ringlet.sim.motion_words import describe_lock
from small_example import write_example

import ringlet


@pytest.fixture(scope="module")
def example(tmp_path_factory):
    folder = tmp_path_factory.mktemp("motion")
    write_example(folder)
    return folder


def word(motion, name, group="locks"):
    """The word of a group."""
    return next(word for word in motion.words if (word.group, word.name) == (group, name))


def test_the_words_of_a_shot_need_no_simulation(example):
    motion = ringlet.motion_words(example / "small.shot.toml")
    assert [word.name for word in motion.words] == ["bounce", "settle", "sag", "swing"]
    for each in motion.words:
        assert each.shown.shape == (8,) and np.isfinite(each.shown).all() and not each.found.size
    assert (word(motion, "bounce").by_itself > word(motion, "bounce").shown).all()


def test_a_stiffer_lock_bounces_faster_and_sags_less(example):
    shot = ringlet.read_shot(example / "small.shot.toml")
    stiff = shot.model_copy(update={"strands": shot.strands.model_copy(update={"bend_scale": 4.0})})
    soft, hard = (ringlet.motion_words(each) for each in (shot, stiff))
    ratio = word(hard, "bounce").by_itself / word(soft, "bounce").by_itself
    assert np.median(ratio) == pytest.approx(2.0, rel=0.25)  # weight is a part of the stiffness
    assert np.abs(word(hard, "sag").shown).max() < np.abs(word(soft, "sag").shown).max()


def test_the_steps_that_keep_a_bounce_are_advised_and_do(example):
    shot = ringlet.read_shot(example / "small.shot.toml")
    said = " ".join(ringlet.motion_words(shot).notes)
    assert "The steps end the bounce" in said and 'solver.integrator = "bdf2" and solver.substeps = ' in said
    substeps = int(said.split('"bdf2" and solver.substeps = ')[1].split(".")[0])
    solver = shot.solver.model_copy(update={"integrator": "bdf2", "substeps": substeps})
    assert not ringlet.motion_words(shot.model_copy(update={"solver": solver})).notes


def test_a_cache_shows_how_far_coils_open(example):
    cache = example / "cache.usdc"
    assert run("sim", example / "small.shot.toml", "-o", cache).exit_code == 0
    result = run("motion", example / "small.shot.toml", cache)
    assert result.exit_code == 0, result.output
    header, *rows = result.stdout.splitlines()
    assert "found, median" in header
    assert [" ".join(row.split()[1:3]) for row in rows[:6]] == [
        "bounce [Hz]", "settle [s]", "sag [%]", "swing [Hz]", "opens [%]", "closes [%]"
    ]  # fmt: skip
    motion = ringlet.motion_words(example / "small.shot.toml", cache=cache)
    assert np.isnan(word(motion, "bounce").found).all()  # four frames show no vibration
    assert (word(motion, "opens").found >= word(motion, "closes").found).all()


def test_a_cache_of_other_locks_is_refused(example):
    cache = example / "other.usdc"
    assert run("sim", example / "small.shot.toml", "-o", cache, "--frames", "1:2").exit_code == 0
    recipe = edit(example / "small.recipe.toml", "count = 8", "count = 7")
    refused(run("motion", example / "small.shot.toml", cache), "other.usdc", "not those of the groom", "simulate")
    edit(recipe, "count = 7", "count = 8")


def test_locks_that_are_all_held_are_refused(example):
    shot = example / "held.shot.toml"
    shot.write_text((example / "small.shot.toml").read_text() + "held = 40\n")
    refused(run("motion", shot), "held is 40, but a lock has 40 points")


def test_plot_and_json(example):
    plot = example / "motion.png"
    result = run("motion", example / "small.shot.toml", "--plot", plot, "--json")
    assert result.exit_code == 0, result.output
    found = json.loads(result.stdout)
    assert [each["word"] for each in found["words"]] == ["bounce", "settle", "sag", "swing"]
    low, median, high = found["words"][0]["shown"]
    assert low <= median <= high and found["words"][0]["found"] is None
    assert plot.read_bytes().startswith(b"\x89PNG")
    refused(run("motion", example / "small.shot.toml", "--plot", example / "motion.txt"), "must end in .png, .svg")


def test_grooms_of_a_head_are_groups(example):
    groom = ringlet.load_groom(example / "small.recipe.toml")
    groom.locks.curve["groom"] = np.array([0, 0, 0, 0, 0, 1, 1, 1], np.int32)
    groom.grooms = {"hair": {"region": None}, "fringe": {"region": None}}
    motion = ringlet.motion_words(ringlet.read_shot(example / "small.shot.toml"), groom)
    counts = [len(word(motion, "bounce", group).shown) for group in ("hair", "fringe")]
    assert counts == [5, 3]


def test_braids_that_are_one_rod_have_the_words_of_the_rod(example):
    groom = ringlet.load_groom(example / "small.recipe.toml")
    groom.locks.curve["core"] = np.array([1, 1, 1, 0, 0, 0, 0, 0], np.int32)
    groom.locks.curve["section"] = np.array([0, 0, 0, -1, -1, -1, -1, -1], np.int32)
    motion = ringlet.motion_words(ringlet.read_shot(example / "small.shot.toml"), groom)
    assert word(motion, "bounce").shown.shape == (6,)


def asked(example, words, steps="integrator = 'bdf2'\nsubsteps = 3"):
    """The small shot with words."""
    text = (example / "small.shot.toml").read_text()
    file = example / "asked.shot.toml"
    file.write_text(f"{text}[solver]\n{steps}\n[motion]\n{words}\n")
    return file


def test_what_is_asked_stands_beside_what_is_shown(example):
    shot = asked(example, "bounce = 6\nsettle = { value = 0.3, vary = 0.2 }")
    motion = ringlet.motion_words(shot)
    for name in ("bounce", "settle"):
        assert word(motion, name).shown == pytest.approx(word(motion, name).asked, rel=0.05)
    assert np.ptp(word(motion, "settle").asked) > 0.02 and not any("is asked" in note for note in motion.notes)
    header, bounce, *_ = run("motion", shot).stdout.splitlines()
    assert header.split()[:3] == ["group", "word", "asked"] and bounce.split()[:4] == ["locks", "bounce", "[Hz]", "6"]


def test_words_that_locks_do_not_show_are_counted(example):
    notes = ringlet.motion_words(asked(example, "settle = 30")).notes
    assert any("8 of 8 locks do not show the settle that is asked" in note for note in notes)


def test_a_lock_is_described_with_what_its_words_come_to(example):
    shot = asked(example, "bounce = 6")
    groom, settings = ringlet.load_groom(example / "small.recipe.toml"), ringlet.read_shot(shot)
    said, swing = describe_lock(settings, groom, 3), word(ringlet.motion_words(shot), "swing").shown[3]
    assert said.startswith("bounce 6 Hz, settles in ") and f"swing {swing:.3g} Hz" in said
    held = settings.model_copy(update={"strands": settings.strands.model_copy(update={"twist_ratio": 0.0})})
    assert "no bounce" in describe_lock(held.model_copy(update={"motion": type(held.motion)()}), groom, 3)


def test_locks_that_cannot_stand_are_named_with_what_would_help(example):
    shot = asked(example, "bounce = 4", "integrator = 'bdf2'\nsubsteps = 3\n[rest]\nmode = 'equilibrium'")
    assert run("loft", shot).exit_code == 0
    motion = ringlet.motion_words(shot)
    fallen = word(motion, "bounce").shown > 1.05 * 4
    assert fallen.sum() > 1
    [said] = [note for note in motion.notes if "cannot stand" in note]
    assert f"{fallen.sum()} of 8 locks" in said and "such as lock " in said and "Ask for" in said
    higher = float(said.split("Ask for ")[1].split(" Hz")[0])
    assert higher == pytest.approx(np.percentile(word(motion, "bounce").shown[fallen], 90), rel=0.05)


def test_a_simulation_is_held_against_what_was_asked(example):
    """The head turns in four frames, and is still after them."""
    shot = asked(example, "bounce = 6\nsettle = 0.5")
    cache, early = example / "held_against.usdc", example / "early.usdc"
    shot.write_text(shot.read_text().replace("frames = [1, 4]", "frames = [1, 18]"))
    assert run("sim", shot, "-o", early, "--frames", "1:14").exit_code == 0
    brief = ringlet.motion_words(shot, cache=early)
    assert np.isnan(word(brief, "settle").found).all()
    assert any("does not show how soon locks settle" in note for note in brief.notes)
    assert run("sim", shot, "-o", cache).exit_code == 0
    motion = ringlet.motion_words(shot, cache=cache)
    for name, of in (("bounce", 6.0), ("settle", 0.5)):
        near = np.abs(word(motion, name).found / of - 1.0) <= 0.15
        assert any(f"{near.sum()} of 8 locks show the {name} that is asked within 15 %" in at for at in motion.notes)


def test_a_simulation_has_the_motion_that_words_ask_for(example):
    plain, moved = (ringlet.simulate(asked(example, words)).points[-1] for words in ("", "bounce = 6"))
    assert np.abs(plain - moved).max() > 1e-5
