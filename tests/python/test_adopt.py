"""``ringlet adopt``: recipes of finished hair, which stays as it is, and follows the settings of the recipe."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import small_example
from commands import edit, refused, run
from ringlet.adoption import find_clumps, fit_coils
from ringlet.adoption.scalp import scalp_of_roots
from ringlet.api.adoption import distances
from ringlet.data.hair_scene import CurveSet, HairScene
from ringlet.data.painted import per_lock
from ringlet.data.random import Random, soft_threshold
from ringlet.groom.operators.operator import grid, resampled
from ringlet.groom.scalp import Scalp
from ringlet.io import read_hairs, write_scene

from ringlet import (
    Curves,
    StageSpace,
    UserError,
    adopt,
    build_groom,
    build_hairs,
    convert,
    read_groom,
    read_recipe,
    write_groom,
    write_hairs,
)

LOCKS, PER_LOCK = 40, 6
EXAMPLES = Path(__file__).parents[2] / "examples"

RECIPE = f"""
ringlet = 2
[scalp]
file = "head.usda"
region = "scalp"
[guides]
count = 20
length = 8
[locks]
count = {LOCKS}
points = 100
[curl]
width = {{ value = "8 mm", vary = 0.2 }}
pitch = {{ value = "12 mm", vary = 0.15 }}
[hairs]
per_lock = {PER_LOCK}
lock_radius = "1.5 mm"
"""


@pytest.fixture(scope="module")
def known(tmp_path_factory):
    """The hairs of a groom whose recipe is known, in ``hair.usdc``, and its locks."""
    folder = tmp_path_factory.mktemp("known")
    small_example.write_head(folder / "head.usda")
    (folder / "known.recipe.toml").write_text(RECIPE)
    groom = build_groom(folder / "known.recipe.toml")
    write_groom(groom, folder / "groom.usdc")
    write_hairs(folder / "groom.usdc", folder / "hair.usdc")
    return folder, groom, adopt(folder / "hair.usdc", folder / "adopted.recipe.toml")


def settings(folder, groom, name):
    """Values of a setting of the curl for each lock."""
    recipe = read_recipe(folder / "known.recipe.toml")
    return per_lock(recipe.curl, name, Random(recipe.seed, f"curl/{name}"), groom.locks, groom.scalp, name)


def test_width_pitch_and_hand_of_known_curls_are_found(known):
    folder, groom, done = known
    coils = fit_coils(grid(resampled(groom.locks, 100)))
    assert (coils.width > 0.0).all()
    for found, name in ((coils.width, "width"), (coils.pitch, "pitch")):
        off = found / settings(folder, groom, name) - 1.0
        assert np.median(np.abs(off)) < 0.05 and abs(np.median(off)) < 0.02, name
    chance = Random(read_recipe(folder / "known.recipe.toml").seed, "curl/hand").uniform(groom.locks.ids)
    right = soft_threshold(settings(folder, groom, "right_handed"), chance) > 0.5
    assert ((coils.hand > 0.0) == right).mean() >= 0.98
    assert abs(done["width"] / np.median(settings(folder, groom, "width")) - 1.0) < 0.05
    assert abs(done["pitch"] / np.median(settings(folder, groom, "pitch")) - 1.0) < 0.05
    assert done["coiled"] == done["locks"] == LOCKS


def test_a_regular_coil_is_fitted_to_a_tenth_of_a_percent():
    s = np.linspace(0.0, 1.0, 2000)
    angle = 2.0 * np.pi * 6.0 * s
    coil = np.stack([0.004 * np.cos(angle), 0.08 * s, -0.004 * np.sin(angle)], axis=1)
    one = resampled(Curves.from_list([coil, coil * [-1.0, 1.0, 1.0]]), 120)
    coils = fit_coils(grid(one))
    np.testing.assert_allclose(coils.width, 0.008, rtol=1e-3)
    np.testing.assert_allclose(coils.pitch, 0.08 / 6.0, rtol=1e-3)
    assert coils.hand.tolist() == [1.0, -1.0]


def test_the_hair_stays_as_it_is(known):
    folder, _, done = known
    assert done["hairs"] == LOCKS * PER_LOCK
    assert done["error"]["median"] < 2e-4 and done["error"]["95"] < 5e-4
    groom = build_groom(folder / "adopted.recipe.toml")
    write_groom(groom, folder / "again.usdc")
    back = build_hairs(read_groom(folder / "again.usdc")).curves
    np.testing.assert_allclose(back.points, build_hairs(groom).curves.points, atol=1e-6)
    assert len(back) == LOCKS * PER_LOCK and len(groom.locks) == LOCKS


def test_settings_of_the_recipe_change_adopted_hair(known, tmp_path):
    folder, _, _ = known
    for file in folder.glob("adopted.*"):
        (tmp_path / file.name).write_bytes(file.read_bytes())
    for name in ("hair.usdc", "groom.usdc", "head.usda"):
        (tmp_path / name).write_bytes((folder / name).read_bytes())
    before = build_groom(tmp_path / "adopted.recipe.toml")
    recipe = read_recipe(tmp_path / "adopted.recipe.toml")
    width = recipe.curl.width.value
    edit(tmp_path / "adopted.recipe.toml", f'value = "{1e3 * width:.6g} mm"', f'value = "{0.5e3 * width:.6g} mm"')
    edit(tmp_path / "adopted.recipe.toml", "tolerance =", "residual = 0\ntolerance =")
    after = build_groom(tmp_path / "adopted.recipe.toml")
    was, now = (fit_coils(grid(resampled(groom.locks, 120))).width for groom in (before, after))
    assert abs(np.median(now / was) - 0.5) < 0.05
    edit(tmp_path / "adopted.recipe.toml", "[hairs]", "[hairs]\noffset = 0")
    locks = build_groom(tmp_path / "adopted.recipe.toml")
    off = []
    for groom in (after, locks):
        hairs = build_hairs(groom).curves
        lines = grid(groom.locks)[hairs.curve["lock"]]
        off.append(distances(grid(hairs)[:, 20:].astype(float), lines).mean())
    assert off[0] > 5e-4 and off[1] < 5e-5


def test_the_pitch_of_hair_that_is_straight_in_part_can_be_doubled(known, tmp_path):
    folder, _, _ = known
    hairs = read_hairs(folder / "hair.usdc")
    lines, straight = grid(hairs).astype(float), hairs.curve["lock"] < LOCKS // 5
    along = np.linspace(0.0, 1.0, lines.shape[1])[:, None]
    lines[straight] = lines[straight, :1] + along * (lines[straight, -1:] - lines[straight, :1])
    mixed = hairs.with_points(lines.reshape(-1, 3).astype(np.float32))
    write_scene(HairScene([CurveSet("hairs", mixed, False)]), tmp_path / "mixed.hair", StageSpace())
    recipe = tmp_path / "adopted.recipe.toml"
    done = adopt(tmp_path / "mixed.hair", recipe, head=folder / "head.usda")
    assert done["error"]["95"] < 5e-4
    pitch = read_recipe(recipe).curl.pitch.value
    edit(recipe, f'value = "{1e3 * pitch:.6g} mm"', f'value = "{2e3 * pitch:.6g} mm"')
    coils = fit_coils(grid(resampled(build_groom(recipe).locks, 120)))
    assert not coils.coiled[: LOCKS // 5].any() and coils.coiled[LOCKS // 5 :].mean() > 0.9


def test_clumps_are_found_by_the_shapes_of_hairs(known):
    folder, _, _ = known
    hairs = build_hairs(read_groom(folder / "groom.usdc")).curves
    points = grid(resampled(hairs, 60))
    clumps = find_clumps(points, hairs.lengths(), {})
    assert clumps.source == "shape" and len(clumps) == LOCKS
    pairs = np.unique(np.stack([clumps.of, hairs.curve["lock"]]), axis=1)
    assert pairs.shape[1] == LOCKS
    assert find_clumps(points, hairs.lengths(), hairs.curve).source == "lock"
    assert len(find_clumps(points, hairs.lengths(), {}, 7)) <= 7


@pytest.mark.parametrize(("kind", "exactly"), [("3A", 79), ("3B", 78)])
def test_clumps_of_wide_curls_are_found_by_gaps(kind, exactly):
    """Distances within locks and between them overlap over the head, but hardly around one hair."""
    groom = build_groom(read_recipe(EXAMPLES / f"types/{kind}.recipe.toml", {"locks.count": 98}))
    groom.hairs = {name: value for name, value in groom.hairs.items() if name != "density"} | {"per_lock": 8}
    hairs = build_hairs(groom).curves
    lock = hairs.curve["lock"]
    clumps = find_clumps(grid(resampled(hairs, int(hairs.counts.max()))), hairs.lengths(), {})
    sizes = np.bincount(clumps.of)
    whole = [len(set(clumps.of[lock == row])) == 1 and sizes[clumps.of[lock == row][0]] == 8 for row in set(lock)]
    assert clumps.source == "shape" and sum(whole) >= 0.95 * exactly
    assert abs(len(clumps) / len(groom.locks) - 1.0) < 0.06


def test_hair_without_gaps_has_no_clumps():
    rng = np.random.default_rng(0)
    points = np.zeros((400, 32, 3))
    points[:, :, [0, 2]] = 0.2 * rng.random((400, 1, 2))
    points[:, :, 1] = np.linspace(0.0, 0.1, 32)
    points += rng.normal(0.0, 0.002, (400, 1, 3)) * np.linspace(0.0, 1.0, 32)[None, :, None]
    assert find_clumps(points, np.full(400, 0.1), {}).source == "each"


def test_strands_that_bend_are_no_coils():
    """Strands as games have them: one to two bends of some centimetres, and no turns."""
    rng = np.random.default_rng(1)
    s = np.linspace(0.0, 1.0, 32)
    waves = [
        np.stack([a * np.sin(np.pi * (1.0 + b) * s), 0.2 * s, c * np.sin(np.pi * (1.0 + d) * s + e)], axis=1)
        for a, b, c, d, e in rng.random((300, 5)) * [0.02, 1.0, 0.02, 1.0, 3.0]
    ]
    assert fit_coils(grid(resampled(Curves.from_list(waves), 32))).coiled.sum() == 0


def mane(path, curly=False):
    """Straight hairs on the upper half of a sphere of 0.1 m, without a head."""
    rng = np.random.default_rng(0)
    out = rng.normal(size=(60, 3))
    out[:, 1] = np.abs(out[:, 1]) + 0.3
    out /= np.linalg.norm(out, axis=1, keepdims=True)
    along = np.linspace(0.1, 0.16, 16)[:, None]
    curves = Curves.from_list([along * d + (along - 0.1) ** 2 * [0.0, -8.0, 0.0] for d in out])
    write_scene(HairScene([CurveSet("hairs", curves)]), path, StageSpace())
    return curves


@pytest.mark.parametrize("name", ["hair.usda", "hair.obj", "hair.hair", "hair.tfx"])
def test_straight_hair_without_a_head_becomes_a_lock_each(tmp_path, name):
    curves = mane(tmp_path / name)
    done = adopt(tmp_path / name, tmp_path / "a.recipe.toml")
    assert (done["locks"], done["coiled"], done["clumps"]) == (60, 0, "each")
    assert done["error"]["95"] < 1e-5
    groom = build_groom(tmp_path / "a.recipe.toml")
    normals = groom.scalp.normals()
    assert (np.einsum("kx,kx->k", normals, groom.scalp.points) > 0.0).all()
    ends = groom.locks.points[groom.locks.offsets[1:] - 1]
    np.testing.assert_allclose(ends, curves.points[curves.offsets[1:] - 1], atol=1e-5)


def roots_of(kind, count, random):
    """Roots in a position that is not general, in any direction; None where they span no surface."""
    along, across = np.linalg.qr(random.normal(size=(3, 2)))[0].T
    t, s = random.uniform(-0.1, 0.1, (2, count, 1))
    angle = random.uniform(0.0, 2.0 * np.pi, (count, 1))
    directions = random.normal(size=(count, 3))
    places = {
        "line": t * along,
        "plane": t * along + s * across,
        "circle": 0.1 * (np.cos(angle) * along + np.sin(angle) * across),
        "two lines": t * along + 0.01 * np.sign(s) * across,
        "sphere": 0.1 * directions / np.linalg.norm(directions, axis=1, keepdims=True),
        "cloud": 0.1 * directions,
    }
    return random.uniform(-1.0, 1.0, 3) + places[kind]


@pytest.mark.parametrize("kind", ["line", "plane", "circle", "two lines", "sphere", "cloud"])
def test_roots_in_any_position_get_a_surface_or_are_refused(kind):
    random = np.random.default_rng(53)
    for count in [3, 4, 5, 8, 20, 60] * 5:
        roots = roots_of(kind, count, random)
        try:
            surface = scalp_of_roots(roots, "hair")
        except UserError as error:
            flat = np.linalg.svd(roots - roots.mean(axis=0))[1][1] < 1e-3  # within a millimetre of a line
            assert flat and str(error).endswith("which spans no surface; give it a head with --head")
            continue
        assert kind != "line"
        Scalp(surface, None)  # of one orientation
        distance = np.linalg.norm(surface.points[None] - roots[:, None], axis=2).min(axis=1)
        assert distance.max() < 1e-3  # the surface passes through all roots


def test_the_surface_through_the_roots_of_a_head_faces_outwards():
    directions = np.random.default_rng(1).normal(size=(200, 3))
    directions[:, 1] = np.abs(directions[:, 1])
    surface = scalp_of_roots(0.1 * directions / np.linalg.norm(directions, axis=1, keepdims=True), "hair")
    assert (np.einsum("nk,nk->n", surface.normals(), surface.points) > 0.0).all()


def test_finished_hair_is_simulated_on_its_moving_head(known, tmp_path):
    folder, _, _ = known
    convert(folder / "hair.usdc", tmp_path / "plain.usdc", only="hairs")
    (tmp_path / "a.shot.toml").write_text('ringlet = 2\ngroom = "plain.usdc"\nframes = [1, 2]\n[rest]\nmode = "none"\n')
    assert run("sim", tmp_path / "a.shot.toml", "-o", tmp_path / "a.usdc", "--locks", 9).exit_code == 0
    locks = read_groom(tmp_path / "a.usdc").locks
    assert len(locks) <= 9
    assert run("hair", tmp_path / "a.usdc", "-o", tmp_path / "h.usdc").exit_code == 0
    again = ("--groom", tmp_path / "a.groom.usdc", "--locks", 3)
    refused(run("sim", tmp_path / "a.shot.toml", "-o", tmp_path / "b.usdc", *again), "has locks already")


def test_wrong_input_is_refused_and_leaves_nothing(known, tmp_path):
    folder, _, _ = known
    mane(tmp_path / "hair.obj")
    before = sorted(tmp_path.iterdir())
    far = tmp_path / "a.recipe.toml"
    for words, says in (
        ((tmp_path / "none.obj", "-o", far), "cannot be read"),
        ((tmp_path / "hair.obj", "-o", tmp_path / "a.json"), "must end in .toml"),
        ((tmp_path / "hair.obj", "-o", far, "--locks", 61), "there are 60 hairs"),
        ((tmp_path / "hair.obj", "-o", far, "--head", folder / "head.usda", "--from-unit", "ft"), "same unit and axis"),
        ((folder / "head.usda", "-o", far), "has no curves"),
    ):
        refused(run("adopt", *words), says)
    assert sorted(tmp_path.iterdir()) == before
    with pytest.raises(UserError, match="holds no offsets"):
        edit(far, "", "") if far.exists() else None
        (tmp_path / "b.recipe.toml").write_text(
            f'ringlet = 2\n[scalp]\nfile = "{folder / "head.usda"}"\n[hairs]\nfile = "{folder / "hair.usdc"}"\n'
        )
        build_groom(tmp_path / "b.recipe.toml")


def test_adopted_hairs_that_do_not_fit_the_groom_are_refused(known):
    folder, _, _ = known
    groom = build_groom(folder / "adopted.recipe.toml")
    groom.offsets.root_triangle[3] = 10**6
    with pytest.raises(UserError, match="root on triangle 1000000"):
        build_hairs(groom)
    groom.offsets.lock[:] = groom.locks.ids[0]
    with pytest.raises(UserError, match=f"of {LOCKS - 1} locks in all"):
        build_hairs(groom)


def test_adopted_hairs_are_refused_among_several_grooms(known, tmp_path):
    folder, _, _ = known
    several = folder / "several.recipe.toml"
    several.write_text('ringlet = 2\n[grooms.hair]\nextends = "adopted.recipe.toml"\n')
    refused(
        run("groom", several, "-o", tmp_path / "g.usdc"), "grooms.hair.hairs.file: adopted hairs cannot be combined"
    )
    assert not (tmp_path / "g.usdc").exists()
