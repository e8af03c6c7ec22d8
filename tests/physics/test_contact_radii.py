"""Locks with a radius of their own touch at it."""

import numpy as np
import pytest
from ringlet.data.curves import Curves
from ringlet.data.groom import STRAND_PROFILE, STRAND_RADIUS
from ringlet.shot.contact import Contact, ShotContact
from ringlet.shot.material import Material
from ringlet.sim.contact_radii import contact_radii
from ringlet.sim.scene import Scene
from ringlet.sim.strands import Strands

APART = 3e-3  # [m]


def pair() -> Curves:
    """Two straight strands that hang side by side."""
    z = np.linspace(0.0, -0.05, 11)
    return Curves.from_list([np.c_[np.full(11, x), 0 * z, z] for x in (0.0, APART)])


def gap_of_tips(radius: float) -> float:
    """Distance of the tips [m] after two seconds, of strands that touch at ``radius`` [m]."""
    strands = Strands(pair(), Material(), 2)
    scene = Scene(strands, contact=Contact(radius=5e-4, separation_speed=0.1), radii=np.full(22, radius))
    for _ in range(50):
        scene.step(None, 1 / 24)
    return float(np.linalg.norm(strands.positions[21] - strands.positions[10]))


def test_strands_part_where_their_radii_overlap():
    assert gap_of_tips(5e-4) == pytest.approx(APART, abs=1e-9)
    assert gap_of_tips(2e-3) > 0.98 * 4e-3


def test_a_part_of_their_own_radius_counts_where_it_is_more():
    locks = pair()
    assert contact_radii(ShotContact(), locks) is None
    locks.curve[STRAND_RADIUS] = np.array([4e-4, 4e-3], np.float32)
    radii = contact_radii(ShotContact(radius=5e-4, own_radius=0.85), locks)
    np.testing.assert_allclose(radii, np.repeat([5e-4, 3.4e-3], 11))
    assert contact_radii(ShotContact(own_radius=0.0), locks) is None
    locks.curve[STRAND_PROFILE] = np.array([[1.0, 1.0, 1.0], [1.0, 0.5, 0.0]])
    np.testing.assert_allclose(contact_radii(ShotContact(), locks)[11:], np.linspace(3.4e-3, 0.0, 11).clip(5e-4))
