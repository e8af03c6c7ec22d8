"""Ringlet in cosseratbench, a benchmark of rods by others: its experiments, metrics and references judge.

Needs the extra ``cosserat``. The numbers are in docs/cosserat_bench.md.
"""

from dataclasses import replace

import numpy as np
import pytest

pytest.importorskip("cosseratbench", reason="cosseratbench is not installed: pip install ringlet[cosserat]")

from cosseratbench import experiment, registry
from cosseratbench.metrics import twist_angles
from cosseratbench.scenario import End, EndCondition, Motion


def result(name, elements=None, **values):
    """The result of an experiment with Ringlet, found through its entry point."""
    found = experiment.run(
        registry.load_experiment(name), registry.load_solver("ringlet"), values=values, n_elements=elements
    )
    assert found.outcome == experiment.COMPLETED, found
    return found


@pytest.mark.parametrize("elements", [20, 40])
def test_a_cantilever_bends_as_euler_and_bernoulli_say(elements):
    """To the 0.1 % that the reference leaves out; a clamp half an element off would be 7 % off at 20 elements."""
    assert result("cantilever", elements).metrics["tip_deflection_error"] < 1e-3


@pytest.mark.parametrize("modulus", [1e5, 1e6])
def test_a_cable_hangs_as_the_elastic_catenary(modulus):
    """A polygon of 50 sides is a fiftieth squared off, in sag; the bending that the reference leaves out is less."""
    metrics = result("catenary", youngs_modulus=modulus).metrics
    assert metrics["shape_error"] < 1e-3 and metrics["sag_error"] < 4e-4
    assert metrics["settling_residual"] < 1e-8


def test_a_hanging_cable_swings_at_its_period_and_keeps_its_amplitude():
    """The period is a fiftieth squared off; BDF-2 takes (ωh)⁴ of the swing a step."""
    metrics = result("pendulum").metrics
    assert metrics["period_error"] < 4e-4 and abs(metrics["amplitude_change"]) < 1e-4


@pytest.mark.parametrize(("overhang", "holds"), [(0.95, True), (1.05, False)])
def test_a_rope_on_a_cylinder_slides_where_the_capstan_equation_says(overhang, holds):
    """What holds moves less than a rod's radius while its elements leave the cylinder that they cut at the start."""
    found = result("capstan", overhang=overhang)
    slide = found.metrics["slide"]
    assert slide < 1e-3 if holds else slide > 0.1
    assert found.observations["max_penetration"] < 0.02


def test_a_rope_lies_on_another_as_the_elastica_does():
    """With a node where they touch; between nodes the ropes slide to one, as polygons do."""
    found = result("crossing", 50)
    assert found.metrics["shape_error"] < 1e-3 and found.metrics["lift_error"] < 5e-3
    assert found.metrics["settling_residual"] < 1e-8
    assert found.observations["max_rod_overlap"] < 0.02


def test_a_twisted_rod_buckles_at_the_twist_of_greenhill():
    """The measurement is uncertain by half a per cent, says the experiment."""
    found = result("twist")
    assert found.metrics["critical_twist_error"] < 0.01
    assert found.observations["max_rod_overlap"] < 0.1
    scenario, trajectory = registry.load_experiment("twist").scenario, found.trajectory
    held = trajectory.times > 7.0
    for rod, positions, directors in zip(scenario.rods[:2], trajectory.positions, trajectory.directors, strict=False):
        twist = twist_angles(positions[held], directors[held]).sum(axis=-1)
        given = rod.end_motion.rotation[-1][0]
        assert np.abs(twist / given - 49 / 50).max() < 1e-3  # between the middles of 50 elements


def test_a_pile_of_rope_does_not_pass_through_itself_and_comes_to_rest():
    found = result("pile", 60)
    assert found.observations["max_rod_overlap"] < 0.05 and found.observations["max_penetration"] < 0.2
    assert found.metrics["settling_residual"] < 0.01


def test_a_trajectory_begins_as_the_scenario_says():
    scenario = registry.load_experiment("twist").scenario
    begins = registry.load_solver("ringlet").run(replace(scenario, duration=1e-3), n_elements=20, n_frames=2)
    for rod, positions, directors in zip(scenario.rods, begins.positions, begins.directors, strict=True):
        np.testing.assert_allclose(positions[0], rod.nodes(20), atol=1e-15)
        np.testing.assert_allclose(directors[0], rod.directors(20), atol=1e-12)


def test_what_strands_cannot_do_is_unsupported_and_named():
    cantilever = registry.load_experiment("cantilever")
    slides = Motion((0.0, 1.0), ((0.0, 0.0, 0.0),) * 2, ((0.0, 0.0, 0.0),) * 2, slides_along=(1.0, 0.0, 0.0))
    rod = cantilever.scenario.rods[0]
    assert rod.condition(End.START) is EndCondition.CLAMPED
    for rods, words in (
        ((rod, replace(rod, radius=0.01)), "rods that differ in radius"),
        ((replace(rod, start_motion=slides),), "a start that slides"),
    ):
        scenario = replace(cantilever.scenario, rods=rods)
        found = experiment.run(replace(cantilever, build=lambda s=scenario: s), registry.load_solver("ringlet"))
        assert found.outcome == experiment.UNSUPPORTED and found.missing == (words,)
