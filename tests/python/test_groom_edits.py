"""Edits of single locks: they survive changes of the recipe and can be reverted."""

import json

import numpy as np
import pytest
from ringlet.cli.app import app
from small_example import write_head
from typer.testing import CliRunner

import ringlet
from ringlet import UserError
from ringlet.groom import parse_recipe

RECIPE = """
ringlet = 2
name = "edited"
edits = "a.edits.toml"
[scalp]
file = "head.usda"
region = "scalp"
[guides]
count = 8
length = 6
[locks]
count = 12
points = 64
[collide]
margin = 0
[[shape]]
op = "scraggle"
magnitude = 0.3
[curl]
width = 0.6
curls = 4
irregularity = 0
"""


@pytest.fixture
def recipe(tmp_path):
    write_head(tmp_path / "head.usda")
    (tmp_path / "a.toml").write_text(RECIPE)
    return tmp_path / "a.toml"


def change(recipe, old, new):
    text = recipe.read_text()
    assert old in text
    recipe.write_text(text.replace(old, new))


def locks(recipe):
    return ringlet.build_groom(recipe).locks


def others_stay(before, after, lock):
    keep = before.ids != lock
    np.testing.assert_array_equal(before.take(keep).points, after.take(keep).points)


def test_moved_points_keep_their_positions_and_no_other_lock_changes(recipe):
    before = locks(recipe)
    lock = int(before.ids[5])
    wanted = before[5] + np.linspace(0, 1, 64)[:, None] * [0.01, 0.002, -0.004]
    ringlet.edit_lock(recipe, lock, points=wanted)
    after = locks(recipe)
    np.testing.assert_allclose(after[5], wanted, atol=1e-8)
    others_stay(before, after, lock)


def test_an_edit_follows_changes_of_the_recipe(recipe):
    before = locks(recipe)
    lock = int(before.ids[5])
    ringlet.edit_lock(recipe, lock, points=before[5] + np.linspace(0, 1, 64)[:, None] * [0.01, 0.0, 0.0])
    for old, new in (
        ("length = 6", "length = 8"),
        ("magnitude = 0.3", "magnitude = 0.6"),
        ("width = 0.6", "width = 0.9"),
        ("curls = 4", "curls = 5"),
        ("points = 64", "points = 96"),
    ):
        change(recipe, old, new)
        edited = ringlet.build_groom(recipe)
        plain = ringlet.build_groom(parse_recipe(recipe.read_text().replace("edits =", "# edits ="), recipe))
        row = int(np.flatnonzero(edited.locks.ids == lock)[0])
        difference = edited.locks[row] - plain.locks[row]
        u = np.linspace(0, 1, len(difference))
        # the displacement is kept along the lock, on top of the change of the recipe
        np.testing.assert_allclose(np.linalg.norm(difference, axis=1), 0.01 * u, atol=2e-4)
        assert np.abs(plain.locks[row][-1] - before[5][-1]).max() > 1e-4
        others_stay(plain.locks, edited.locks, lock)


def test_a_frozen_lock_ignores_changes_of_the_recipe(recipe):
    before = ringlet.build_groom(recipe)
    lock = int(before.locks.ids[3])
    ringlet.edit_lock(recipe, lock)
    change(recipe, "width = 0.6", "width = 1.2")
    change(recipe, "magnitude = 0.3", "magnitude = 1")
    after = locks(recipe)
    np.testing.assert_allclose(after[3], before.locks[3], atol=2e-5)
    assert np.abs(after[4] - before.locks[4]).max() > 1e-3


def test_a_replaced_curve_equals_its_input(recipe):
    before = locks(recipe)
    root = before[2][0]
    line = root + np.linspace(0, 1, 20)[:, None] * (root / np.linalg.norm(root)) * 0.05
    ringlet.edit_lock(recipe, int(before.ids[2]), points=line, relative=False)
    after = locks(recipe)[2]
    np.testing.assert_allclose(np.linalg.norm(after - root, axis=1), np.linspace(0, 0.05, 64), atol=1e-6)


def test_an_edited_shape_is_still_curled_by_the_recipe(recipe):
    before = ringlet.build_groom(recipe)
    lock, shape = int(before.locks.ids[6]), before.shapes[6]
    bent = shape + np.linspace(0, 1, len(shape))[:, None] ** 2 * [0.03, 0, 0]
    ringlet.edit_lock(recipe, lock, points=bent, stage="shape")
    after = ringlet.build_groom(recipe)
    np.testing.assert_allclose(after.shapes[6], bent, atol=1e-8)
    straight = np.linalg.norm(np.diff(after.shapes[6], axis=0), axis=1).sum()
    assert after.locks.lengths()[6] > 1.05 * straight  # the curl lengthens it
    others_stay(before.locks, after.locks, lock)


def test_a_setting_of_one_lock_changes_it_alone_and_overrides_the_recipe(recipe):
    before = locks(recipe)
    lock = int(before.ids[7])
    ringlet.edit_lock(recipe, lock, settings={"curl.width": "12 mm"})
    ringlet.edit_lock(recipe, lock, settings={"scraggle.magnitude": 0})
    wide = locks(recipe)
    others_stay(before, wide, lock)
    change(recipe, "width = 0.6", "width = 1.2")
    assert np.abs(locks(recipe)[7] - wide[7]).max() < 1e-12  # its own width overrides the recipe
    assert ringlet.list_edits(recipe) == [
        {"lock": lock, "stage": "groom", "what": ["curl.width", "scraggle.magnitude"], "there": True}
    ]


def test_edits_of_locks_are_reverted(recipe):
    before = locks(recipe)
    ids = [int(before.ids[k]) for k in (1, 2, 3)]
    for lock in ids:
        ringlet.edit_lock(recipe, lock, settings={"curl.width": 2.0})
    ringlet.edit_lock(recipe, ids[0])
    assert ringlet.release_locks(recipe, [ids[0]]) == [ids[0]]
    np.testing.assert_array_equal(locks(recipe)[1], before[1])
    assert ringlet.release_locks(recipe) == sorted(ids[1:])
    np.testing.assert_array_equal(locks(recipe).points, before.points)
    with pytest.raises(UserError, match=rf"lock {ids[0]} is not edited; nothing is edited there"):
        ringlet.release_locks(recipe, [ids[0]])


def test_an_edit_of_a_missing_lock_is_reported_and_kept(recipe):
    before = locks(recipe)
    lock = int(before.ids[0])
    ringlet.edit_lock(recipe, lock, settings={"curl.width": 2.0})
    kept = (recipe.parent / "a.edits.toml").read_bytes()
    recipe.write_text("seed = 5\n" + recipe.read_text())  # another seed grows other locks
    groom = ringlet.build_groom(recipe)
    assert lock not in groom.locks.ids
    assert groom.conflicts == [
        f"lock {lock} was edited but is no longer there; its edit is kept: bring the lock back, or release the edit"
    ]
    assert ringlet.list_edits(recipe)[0]["there"] is False
    assert (recipe.parent / "a.edits.toml").read_bytes() == kept
    recipe.write_text(RECIPE)
    assert ringlet.build_groom(recipe).conflicts == []
    assert np.abs(locks(recipe)[0] - before[0]).max() > 1e-3


def test_invalid_edits_are_refused_and_leave_the_file_unchanged(recipe):
    lock = int(locks(recipe).ids[0])
    for action, words in (
        (lambda: ringlet.edit_lock(recipe, lock, settings={"crul.width": 1}), "did you mean 'curl'"),
        (lambda: ringlet.edit_lock(recipe, lock, settings={"curl.widht": 1}), "curl.widht is not a setting; did you"),
        (lambda: ringlet.edit_lock(recipe, lock, settings={"curl.width": "-3 m"}), "must be at least 0"),
        (lambda: ringlet.edit_lock(recipe, lock + 1), f"there is no lock {lock + 1}; the nearest id is"),
        (lambda: ringlet.edit_lock(recipe, lock, points=np.zeros((4, 2))), "must be finite, of shape (k, 3)"),
    ):
        with pytest.raises(UserError) as error:
            action()
        assert words in str(error.value) and "\n" not in str(error.value)
        assert not (recipe.parent / "a.edits.toml").exists()
    change(recipe, 'edits = "a.edits.toml"', "")
    with pytest.raises(UserError, match=r'names no file for edits; add a line edits = "a.edits.toml"'):
        ringlet.edit_lock(recipe, lock)


def test_a_moved_point_moves_its_neighbourhood_and_keeps_the_rest(recipe):
    before = locks(recipe)
    change(
        recipe,
        "[collide]",
        f"[[edit]]\nlock = {before.ids[4]}\nmove = [{{ at = 0.5, by = [1, 0, 0], falloff = 0.25 }}]\n[collide]",
    )
    moved = np.linalg.norm(locks(recipe)[4] - before[4], axis=1)
    u = np.linspace(0, 1, 64)
    assert moved[np.abs(u - 0.5).argmin()] == pytest.approx(0.01, rel=0.01)
    assert not moved[np.abs(u - 0.5) > 0.25].any()


def test_the_command_edits_lists_and_reverts(recipe):
    def run(*args):
        done = CliRunner().invoke(app, ["edit", str(recipe), *args])
        return done.exit_code, done.stdout, done.stderr

    lock = int(locks(recipe).ids[0])
    assert run() == (0, "no lock is edited\n", "")
    code, out, err = run("--set", f"{lock}:curl.width=9mm", "--freeze", str(lock), "--json")
    assert code == 0, err
    assert [edit["what"] for edit in json.loads(out)["edits"]] == [["curl.width"], ["curve"]]
    assert run("--set", "nonsense")[0] == 2
    assert run("--release", str(lock)) == (0, "no lock is edited\n", "")


def test_hairs_follow_an_edited_lock_and_its_own_settings(recipe, tmp_path):
    lock = int(locks(recipe).ids[4])
    change(recipe, "[curl]", '[hairs]\nper_lock = 5\nwidth = "0.1 mm"\n[curl]')
    ringlet.edit_lock(recipe, lock, points=locks(recipe)[4] + np.linspace(0, 0.01, 64)[:, None])
    ringlet.edit_lock(recipe, lock, settings={"hairs.width": "0.3 mm", "hairs.per_lock": 9})
    ringlet.write_groom(ringlet.build_groom(recipe), tmp_path / "groom.usdc")
    groom = ringlet.read_groom(tmp_path / "groom.usdc")
    hairs = ringlet.build_hairs(groom).curves
    own = hairs.curve["guide_id"] == lock
    assert own.sum() == 9 and (~own).sum() == 5 * 11
    first, widths = np.flatnonzero(own)[0], hairs.point["width"][hairs.offsets[:-1]]
    np.testing.assert_allclose(hairs[first], groom.locks[4], atol=1e-6)
    assert widths[own].mean() == pytest.approx(3e-4, rel=0.15) and widths[~own].mean() == pytest.approx(1e-4, rel=0.1)


def test_a_setting_of_an_unknown_stage_is_refused_with_a_suggestion(recipe):
    with pytest.raises(UserError, match=r"hair.width is no setting of an operator.*hairs"):
        ringlet.edit_lock(recipe, int(locks(recipe).ids[0]), settings={"hair.width": "1 mm"})


@pytest.mark.parametrize("factor", [0.4, 1.5])
def test_an_edit_gives_one_lock_another_length(recipe, factor):
    before = ringlet.build_groom(recipe)
    lock = int(before.locks.ids[5])
    recipe.with_name("a.edits.toml").write_text(
        f'ringlet = 2\n[[edit]]\nlock = {lock}\nstage = "shape"\nlength = {factor}\n'
    )
    after = ringlet.build_groom(recipe)
    lengths = [groom.shapes.lengths()[5] for groom in (before, after)]
    assert lengths[1] == pytest.approx(factor * lengths[0], rel=0.01)
    others_stay(before.locks, after.locks, lock)
