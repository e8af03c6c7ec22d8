"""Rods of eight vertices move as the coils that they stand for."""

import numpy as np
import pytest
from numpy.typing import NDArray
from ringlet.live.hanging import HangingRods
from ringlet.live.rods import HELD, HELD_EDGE, VERTICES, Rods, Wire
from ringlet.motion import HelicalSpring
from ringlet.sim.strands import Strands
from ringlet.validate.rods import bending_stiffness, line_density

from ringlet import Curves, Material

MATERIAL = Material(stretch_scale=1.0, damping=0.0, drag=0.0)
RADIUS, PITCH, PER_TURN = 5e-3, 3e-3, 24


def coil(turns: int) -> Curves:
    """Hangs from the origin."""
    turn = 2.0 * np.pi * np.arange(turns * PER_TURN + 1) / PER_TURN
    points = np.c_[RADIUS * np.cos(turn), -PITCH * turn / (2.0 * np.pi), RADIUS * np.sin(turn)]
    return Curves.from_list([points])


def displaced(strands: Strands, load: tuple[float, float, float]) -> NDArray[np.float64]:
    """Of the mean of the last turn, or of the tip of a rod, under a load on all mass [m/s²]."""
    last = slice(-PER_TURN, None) if len(strands.positions) > VERTICES else slice(-1, None)
    before = strands.positions[last].mean(axis=0)
    strands.settle(gravity=load, dt=100.0, tolerance=1e-9, steps=60)
    return strands.positions[last].mean(axis=0) - before


def rod_of(curves: Curves, material: Material = MATERIAL) -> Strands:
    return Rods.of(curves).strands(Wire.of(curves, material, {}))


def test_a_rod_lengthens_as_a_helical_spring_does() -> None:
    """Love 1927, art. 271: by λ g φ L² / 2."""
    curves, gravity = coil(16), 1e-3
    rise = PITCH / np.hypot(2.0 * np.pi * RADIUS, PITCH)
    bend = bending_stiffness(MATERIAL)
    spring = HelicalSpring(RADIUS, rise, bend, MATERIAL.twist_ratio * bend)
    length = float(curves.lengths()[0])
    expected = 0.5 * line_density(MATERIAL) * gravity * spring.flexibility * length**2
    sagged = displaced(rod_of(curves), (0.0, -gravity, 0.0))
    free = 1.0 - (HELD - 1) * HELD_EDGE  # the head holds the rest
    assert -sagged[1] == pytest.approx(expected * free**2, rel=0.06)


@pytest.mark.parametrize("direction", [(0.0, -1.0, 0.0), (1.0, 0.0, 0.0), (0.0, 0.0, 1.0)])
def test_a_rod_gives_way_as_the_whole_coil_does(direction: tuple[float, float, float]) -> None:
    curves = coil(16)
    load = tuple(1e-3 * np.array(direction))
    whole = displaced(Strands(curves, MATERIAL, HELD), load) @ direction
    of_rod = displaced(rod_of(curves), load) @ direction
    assert of_rod == pytest.approx(whole, rel=0.2)


def test_a_rod_has_the_mass_and_the_drag_of_its_lock() -> None:
    curves, material = coil(7), MATERIAL.model_copy(update={"drag": 3e-5})
    rod = rod_of(curves, material)
    whole = Strands(curves, material.model_copy(update={"correct_resolution": False}), HELD)
    assert rod.masses.sum() == pytest.approx(whole.masses.sum(), rel=1e-3)
    assert rod.drag.sum() == pytest.approx(whole.drag.sum(), rel=1e-3)


def test_soft_hair_swings_as_a_hanging_chain() -> None:
    """It swings at 0.191 √(g / l); with a dead load in place of tension it would swing at a tenth of that."""
    length, gravity, dt = 0.3, (0.0, -9.81, 0.0), 1.0 / 480.0
    line = Curves.from_list([np.outer(np.linspace(0.0, length, 60), [0.0, -1.0, 0.0])])
    wire = Wire.of(line, MATERIAL.model_copy(update={"bend_scale": 0.02}), {})
    strands, support = HangingRods(Rods.of(line), wire, gravity).strands(wire, gravity)
    strands.place(Rods.of(line).points)
    still = strands.positions.copy()
    strands.velocities[HELD:, 2] = 0.05 * np.linspace(0.0, 1.0, VERTICES - HELD)
    aside = []
    for _ in range(480):
        strands.step(still, dt, gravity=gravity, forces=support)
        aside.append(strands.positions[-1, 2])
    crossings = np.flatnonzero(np.diff(np.sign(aside))) * dt
    assert len(crossings) >= 2
    frequency = 0.5 / np.diff(crossings).mean()
    assert frequency == pytest.approx(0.191 * np.sqrt(9.81 / length), rel=0.1)


def test_a_straight_lock_is_a_rod_of_its_own_stiffness() -> None:
    """sin α is 1 and R is 0: stretch, bend and twist are those of the wire."""
    wire = HelicalSpring(0.0, 1.0, 2e-9, 1.5e-9, 40.0)
    assert (wire.axial_stretch, wire.axial_bend, wire.axial_twist) == pytest.approx((40.0, 2e-9, 1.5e-9))


def test_what_contact_adds_is_bend_stiffness_of_the_wire() -> None:
    curves = coil(7)
    added = 2.5 * bending_stiffness(MATERIAL)
    stiffer = Rods.of(curves).strands(Wire.of(curves, MATERIAL, {}, added))
    scaled = rod_of(curves, MATERIAL.model_copy(update={"bend_scale": 3.5}))
    for one, other in zip(stiffer.stiffness, scaled.stiffness, strict=True):
        assert one == pytest.approx(other)


def test_neighbours_hold_a_lock_only_where_it_has_some() -> None:
    lock, count = np.asarray(coil(7).points), 25
    for spacing, least, most in ((2.0 * RADIUS, 0.9, 1.0), (40.0 * RADIUS, 0.0, 0.02)):
        away = spacing * np.stack(np.divmod(np.arange(count), 5), axis=1)
        crowd = Curves.from_list([lock + [x, 0.0, z] for x, z in away])
        assert least <= np.median(Rods.of(crowd).crowding()) <= most
    assert Rods.of(coil(7)).crowding() == pytest.approx(0.0)
