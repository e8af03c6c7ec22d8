"""Bounce, settle and swing of hanging locks: the theory against the exact Hessian, and from words to material."""

from itertools import pairwise

import numpy as np
import pytest
from locks import STRAIGHT
from ringlet.data.curves import Curves
from ringlet.motion import CoilLengths, Stepping, advised_steps, seen_motion
from ringlet.motion.modes import modes_of
from ringlet.shot.material import Material
from ringlet.shot.solver import Solver
from ringlet.sim.hanging import hang
from ringlet.sim.strands import Strands
from ringlet.validate.bounce import lock
from scipy.linalg import eigh

WEIGHT = (0.0, -9.81, 0.0)
FILM = Stepping(1 / 96, "bdf2")  # four steps a frame


def hung(kind, gravity=WEIGHT, variation=None, **material):
    """A lock of a type that hangs still, and how it moves."""
    curves = lock(kind)
    strands = Strands(curves, Material(**material), 3, variation or {})
    return strands, hang(strands, curves.points, gravity)


def exact_frequencies(strands, count):
    """The lowest frequencies [Hz] about the present shape, from differences of the gradient."""
    points, free = strands.positions.copy(), np.repeat(~strands.held, 3)
    columns = []
    for coordinate in np.flatnonzero(free):
        step = np.zeros(points.size)
        step[coordinate] = 1e-7
        up, down = (strands.energy(points + sign * step.reshape(points.shape))[1].ravel() for sign in (1, -1))
        columns.append((up - down)[free] / 2e-7)
    stiffness, masses = np.array(columns), np.repeat(strands.masses, 3)[free]
    squares = eigh(0.5 * (stiffness + stiffness.T), np.diag(masses), eigvals_only=True, subset_by_index=(0, count - 1))
    return np.sqrt(squares) / (2 * np.pi)


@pytest.mark.parametrize("kind", ["2C", "3A", "3B"])
def test_the_lowest_modes_are_those_of_the_exact_hessian_under_weight(kind):
    """Weight and moments included: 3A hangs half as long again as it is groomed."""
    strands, hanging = hung(kind)
    modes = hanging.modes
    ritz = np.sqrt(eigh(modes.flexibility[0] + modes.weight[0], modes.inertia[0], eigvals_only=True)) / (2 * np.pi)
    assert ritz[:7] == pytest.approx(exact_frequencies(strands, 7), rel=0.015)


def test_without_weight_and_moments_the_modes_are_wrong():
    """What weight adds to the stiffness is most of a swing's, and a third of the bounce of a soft lock."""
    _, hanging = hung("3A")
    swing, bounce = hanging.modes.swing(), hanging.modes.bounce()
    assert swing.weight[0] > 0.8 * (swing.weight + swing.elastic)[0]
    assert bounce.weight[0] == pytest.approx(0.3 * (bounce.weight + bounce.elastic)[0], rel=0.3)


@pytest.mark.parametrize("integrator", ["backward_euler", "bdf2"])
def test_steps_show_what_was_wanted_of_them(integrator):
    steps = Stepping(1 / 48, integrator)
    shown = steps.shown(steps.wanted([2.0, 3.5], [0.4, 0.3]))
    assert np.allclose(shown, [[2.0, 3.5], [0.4, 0.3]])


def test_eleven_hertz_cannot_ring_at_24_frames_a_second():
    for integrator in ("backward_euler", "bdf2"):
        assert Stepping(1 / 24, integrator).longest(11.0) == 0.0
    advised = advised_steps(11.0, 0.8, 24.0)
    for integrator, substeps in advised.items():
        longest = [Stepping(1 / 24 / n, integrator).longest(11.0) for n in (substeps - 1, substeps)]
        assert longest[0] < 0.8 <= longest[1]
    assert advised["bdf2"] < advised["backward_euler"]


def test_the_longest_time_to_settle_is_that_of_a_lock_without_damping():
    steps = Stepping(1 / 24, "backward_euler")
    cosine = np.cos(2 * np.pi * 2.0 / 24)
    assert steps.longest(2.0) == pytest.approx(np.log(20) / -np.log(cosine) / 24, rel=1e-3)


def test_locks_of_the_stiffness_and_damping_found_show_the_words():
    """Under a weight that hardly changes their shape."""
    light, wanted = (0.0, -0.01, 0.0), (5.0, 0.7)
    _, hanging = hung("3B", light, damping=1e-3)
    stiffer, damping = hanging.material(FILM, {"bounce": wanted[0], "settle": wanted[1]})
    _, found = hung("3B", light, bend_scale=float(stiffer[0]), damping=1e-3 * float(damping[0]))
    words = found.words(FILM)
    assert (words.bounce[0], words.settle[0]) == pytest.approx(wanted, rel=2e-3)
    stiffer, kept = hanging.material(FILM, {"bounce": wanted[0]})
    _, found = hung("3B", light, bend_scale=float(stiffer[0]), damping=1e-3)
    assert found.words(FILM).bounce[0] == pytest.approx(wanted[0], rel=2e-3)
    unchanged, damping = hanging.material(FILM, {"settle": wanted[1]})
    _, found = hung("3B", light, damping=1e-3 * float(damping[0]))
    assert found.words(FILM).settle[0] == pytest.approx(wanted[1], rel=2e-3)
    assert kept[0] == unchanged[0] == 1.0


def test_words_that_cannot_be_met_have_no_material_or_no_damping():
    """Weight alone bounces a wavy lock faster, and the steps alone settle it sooner."""
    assert np.isnan(hung("2A")[1].material(FILM, {"bounce": 2.0})[0]).all()
    (_, hanging), wanted = hung("3B"), {"bounce": 3.5, "settle": 0.5}
    assert hanging.material(Stepping(1 / 24), wanted)[1] == 0.0
    assert hanging.material(Stepping(1 / 24, "bdf2"), wanted)[1] > 0.0


def test_damping_that_varies_along_a_lock_acts_by_its_strains():
    curves = lock("3C")
    factors = np.linspace(2.0, 0.0, len(curves.points))
    even, varied = (hung("3C", damping=1e-3, drag=0.0, variation=of)[1] for of in ({}, {"damping": factors}))
    upper = even.words().settle[0], varied.words().settle[0]
    assert upper[1] < 0.8 * upper[0]  # the upper half carries most of what hangs below
    ones = hung("3C", damping=1e-3, drag=0.0, variation={"damping": np.full(len(factors), 2.0)})[1]
    assert ones.words().settle[0] == pytest.approx(0.5 * upper[0], rel=1e-3)


def test_locks_of_different_lengths_are_judged_each_by_itself():
    several = Curves.from_list([lock("3C").points, lock("2C").points])
    strands = Strands(several, Material(), 3)
    strands.settle(gravity=WEIGHT, tolerance=1e-8)
    both = modes_of(strands, strands.positions.copy(), WEIGHT).bounce()
    alone = [hung(kind)[1].modes.bounce().elastic[0] for kind in ("3C", "2C")]
    assert both.elastic == pytest.approx(alone, rel=1e-4)


def test_pinned_and_limp_locks_have_no_words():
    curves = Curves.from_list([STRAIGHT @ [[0, -1, 0], [1, 0, 0], [0, 0, 1]]])
    held = np.arange(len(curves.points)) < 3
    held[20] = True
    assert np.isnan(hang(Strands(curves, Material(), held), curves.points, WEIGHT).words().bounce).all()
    limp = Strands(curves, Material(bend_scale=0.0), 3)
    assert np.isnan(hang(limp, curves.points, WEIGHT).words().swing).all()


def test_a_lock_that_falls_over_has_no_words():
    """Straight hair cannot stand on its root."""
    up = Curves.from_list([STRAIGHT[:, [1, 0, 2]]])
    strands = Strands(up, Material(bend_scale=0.01), 3)
    assert np.isnan(modes_of(strands, strands.positions.copy(), WEIGHT).swing().elastic).all()


@pytest.mark.parametrize(("radius", "height"), [(4e-3, 0.065), (8e-3, 0.065), (4e-3, 0.0325)])
def test_a_coil_that_stands_bounces_at_least_so_fast_whatever_its_stiffness(radius, height):
    turn = 2 * np.pi * np.linspace(0.0, height / 6e-3, int(24 * height / 6e-3) + 1)
    out = radius * np.minimum(1.0, turn / (2 * np.pi))
    coil = Curves.from_list([np.c_[out * np.cos(turn), 6e-3 * turn / (2 * np.pi), out * np.sin(turn)]])
    strands = Strands(coil, Material(), 3)
    modes = modes_of(strands, coil.points.astype(np.float64), WEIGHT)
    # It keeps half of its stiffness: F + G - F / 2 is positive.
    least = eigh(-modes.weight[0], 0.5 * modes.flexibility[0], eigvals_only=True).max()
    bounce = modes.bounce(least)
    shown = np.sqrt((bounce.elastic + bounce.weight)[0]) / (2 * np.pi)
    assert shown == pytest.approx(0.37 * np.sqrt(height) / radius, rel=0.03)


def test_the_length_of_a_coil_is_its_rise():
    turn = 2 * np.pi * np.arange(97) / 12
    coil = Curves.from_list([np.c_[5e-3 * np.cos(turn), -6e-3 * turn / (2 * np.pi), 5e-3 * np.sin(turn)]])
    lengths, pulled = CoilLengths(coil), coil.points * [0.9, 1.2, 0.9]
    assert lengths.of(pulled) / lengths.of(coil.points) == pytest.approx(1.2, rel=1e-6)
    bent = np.linspace(0, 1, 97)[:, None] ** 2 * [0.02, 0.0, 0.0]  # its tip goes sideways
    assert lengths.of(coil.points + bent) / lengths.of(coil.points) == pytest.approx(1.0, abs=0.15)


@pytest.mark.parametrize(("bounce", "settle"), [(3.5, 0.4), (3.5, 0.8), (5.5, 0.25), (5.5, 0.8)])
def test_frames_of_a_coil_that_rings_show_how_soon_it_settles(bounce, settle):
    """Its root jerks at first. Another vibration, half as large, does not disturb what is found."""
    turn = 2 * np.pi * np.arange(97) / 12
    coil = Curves.from_list([np.c_[5e-3 * np.cos(turn), -6e-3 * turn / (2 * np.pi), 5e-3 * np.sin(turn)]])
    time = np.maximum(np.arange(36) - 6, 0) / 24
    phase = 2 * np.pi * bounce * time
    opens = 0.1 * 20 ** (-time / settle) * (np.sin(phase) + 0.5 * np.cos(0.4 * phase))
    frames = [coil.points * [1.0, 1.0 + by, 1.0] for by in opens]
    frames[4] = frames[4] + [0.0, 0.01, 0.0]
    seen = seen_motion(coil, iter(frames), WEIGHT, 24.0)
    assert seen.settle[0] == pytest.approx(settle, rel=0.15)
    assert np.isnan(seen_motion(coil, iter(frames[:15]), WEIGHT, 24.0).settle[0])


@pytest.mark.parametrize("kind", ["3A", "3B"])
def test_a_hop_shows_the_bounce_of_the_words(kind):
    """The root hops by 30 mm in a clip of two seconds; the lock opens by half of its length."""
    strands, hanging = hung(kind, damping=3e-3)
    groomed, frames = strands.curves, [strands.positions.copy()]
    heights = 0.03 * np.sin(np.pi * np.clip(np.arange(49) / 24 - 0.2, 0, 0.4) / 0.4) ** 2
    for begin, end in pairwise(heights):
        for part in (0.25, 0.5, 0.75, 1.0):
            up = np.array([0.0, begin + (end - begin) * part, 0.0])
            solver = Solver(newton=20, integrator="bdf2")
            strands.step(groomed.points + up, FILM.dt, gravity=WEIGHT, solver=solver)
        frames.append(strands.positions.copy())
    seen, words = seen_motion(groomed, iter(frames), WEIGHT, 24.0), hanging.words(FILM)
    assert seen.bounce[0] == pytest.approx(words.bounce[0], rel=0.06)
    assert seen.settle[0] == pytest.approx(words.settle[0], rel=0.06)
    assert seen.opens[0] > words.sag[0] + 0.15 > seen.closes[0] + 0.15
    few = seen_motion(groomed, iter(frames[:8]), WEIGHT, 24.0)
    assert np.isnan(few.bounce).all() and few.opens[0] > words.sag[0]
