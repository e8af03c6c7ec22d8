"""What braids wear in a shot: bands and beads have mass, and take up room."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from ringlet.data.curves import Curves
from ringlet.data.groom import SECTION, STRAND_RADIUS, TIED, WORN_MASS, WORN_RADIUS
from ringlet.shot.contact import ShotContact
from ringlet.shot.material import Material
from ringlet.sim.contact_radii import contact_radii
from ringlet.sim.cores import Cores
from ringlet.sim.scene import Scene
from ringlet.sim.strands import Strands
from ringlet.sim.worn import worn_factors
from styles import BRAID, groom

MATERIAL = Material(radius=1e-3, youngs_modulus=1e8, damping=0.0, drag=0.0)
GRAVITY = (0.0, -9.81, 0.0)
POINTS, LENGTH, BEAD = 24, 0.2, slice(18, 21)


def strings(direction, x=(0.0,), mass=0.0, radius=0.0):
    """Strands of 20 cm in a direction, side by side, the first with a bead on three of its points."""
    line = np.linspace(0.0, LENGTH, POINTS)[:, None] * np.asarray(direction, float)
    locks = Curves.from_list([line + [at, 0.0, 0.0] for at in x])
    worn, room = np.zeros(len(locks.points)), np.zeros(len(locks.points))
    worn[BEAD], room[BEAD] = mass / 3.0, radius
    return replace(
        locks,
        curve={**locks.curve, STRAND_RADIUS: np.full(len(x), 1e-3), SECTION: np.arange(len(x))},
        point={WORN_MASS: worn, WORN_RADIUS: room},
    )


def strands(locks):
    return Strands(locks, MATERIAL, variation=worn_factors(locks, MATERIAL, np.ones(len(locks.points))))


@pytest.mark.parametrize("mass", [1e-4, 1e-3, 2e-2])
def test_strands_have_the_mass_of_what_they_wear_and_bend_as_without(mass):
    plain, heavy = strands(strings([0, -1, 0])), strands(strings([0, -1, 0], mass=mass))
    added = heavy.masses - plain.masses
    assert added.sum() == pytest.approx(mass, rel=1e-6)
    assert added[BEAD].sum() > 0.7 * mass and np.count_nonzero(added > 1e-9 * mass) == 5
    assert heavy.stiffness[1] == pytest.approx(plain.stiffness[1], rel=1e-9)


def test_a_heavy_bead_lowers_the_tip():
    tips = []
    for mass in (0.0, 5e-4, 2e-3):
        bent = strands(strings([1, 0, 0], mass=mass))
        assert bent.settle(gravity=GRAVITY, tolerance=1e-7)
        tips.append(bent.positions[-1, 1])
    assert tips[0] > tips[1] + 5e-3 > tips[2] + 1e-2


def test_a_heavy_bead_slows_the_swing():
    times = []
    for mass in (0.0, 2e-3):
        swinging = Strands(
            locks := strings([0, -1, 0], mass=mass),
            MATERIAL,
            variation=worn_factors(locks, MATERIAL, np.ones(len(locks.points))),
        )
        swinging.velocities[:, 0] = 0.5 * np.linspace(0.0, 1.0, POINTS) ** 2
        still, dt = swinging.positions.copy(), 1e-3
        path = []
        for _ in range(800):
            swinging.step(still, dt)  # without gravity it is its stiffness that swings it
            path.append(swinging.positions[-1, 0])
        crossed = np.flatnonzero((np.array(path[:-1]) > 0.0) & (np.array(path[1:]) <= 0.0))
        times.append(crossed[0] * dt)
    assert times[1] > 1.5 * times[0]


def test_a_bead_pushes_a_neighbour_away():
    apart, reached = 6e-3, []
    for radius in (0.0, 8e-3):
        locks = strings([0, -1, 0], x=(0.0, apart), mass=1e-3, radius=radius)
        both, contact = strands(locks), ShotContact(radius=5e-4)
        scene = Scene(both, contact=contact, radii=contact_radii(contact, locks))
        still = both.positions.copy()
        for _ in range(150):
            scene.step(still, 0.02, gravity=GRAVITY)
        at = both.positions.reshape(2, POINTS, 3)
        reached.append(np.linalg.norm(at[1, BEAD] - at[0, BEAD], axis=1).min())
    assert reached[0] == pytest.approx(apart, abs=1e-4)
    assert reached[1] > 0.008


def test_beads_and_bands_of_a_braid_load_its_tied_points_with_their_mass_and_room():
    beads = "end = 'bead'\nbead = 1\nbead_length = 0.7\nbeads = 2\ntail = 1\n"
    light, brass = (groom("strands = 3", BRAID + beads + density, "points = 200") for density in ("", "density = 8500"))
    locks, tied = light.locks, light.locks.point[TIED] > 0.5
    assert locks.point[WORN_MASS][tied].sum() > 0.9 * locks.point[WORN_MASS].sum()
    # A ring of 10 mm around a hole of 5 mm, 7 mm long: between half of its box and all of it, in plastic.
    box = 1000.0 * np.pi * (0.005**2 - 0.0025**2) * 0.007
    sections = len(np.unique(locks.curve[SECTION]))
    assert 0.7 < locks.point[WORN_MASS].sum() / (2 * sections * box) < 1.0
    assert brass.locks.point[WORN_MASS] == pytest.approx(8.5 * locks.point[WORN_MASS], rel=1e-5)
    assert np.median(locks.point[WORN_RADIUS][tied]) > 0.002 and locks.point[WORN_RADIUS].max() <= 0.005


def test_a_bead_has_its_radius_on_a_core_and_strands_in_it_keep_theirs():
    beads = "end = 'bead'\nbead = 1\ntail = 1\n"
    strands_of_braid, core = (
        groom("strands = 3", BRAID + beads + simulate, "points = 200") for simulate in ("", "simulate = 'core'")
    )
    contact = ShotContact(radius=5e-4)
    one = Cores.of(core).groom.locks
    assert one.point[WORN_MASS].sum() == pytest.approx(core.locks.point[WORN_MASS].sum(), rel=1e-5)
    of_core, of_strands = (contact_radii(contact, locks) for locks in (one, strands_of_braid.locks))
    assert of_core is not None and of_strands is not None
    widest = of_core.reshape(len(one), -1).max(axis=1)
    assert widest == pytest.approx(np.full(len(one), 0.005), abs=2e-4)
    assert of_strands.max() < 0.004
