"""Known answers at every resolution."""

import numpy as np
import pytest
from ringlet.validate import CASES, run_case


@pytest.mark.parametrize("name", CASES)
def test_the_simulator_gives_the_known_answer(name):
    rows = run_case(name)
    assert len(rows) > 0
    failed = [f"{row.case}: expected {row.expected:.6g}, got {row.got:.6g}" for row in rows if not row.passed]
    assert not failed, "\n".join(failed)


def test_hinges_overestimate_the_frequency_of_loose_waves():
    """The material frame is within 0.5 % of theory; the hinge model exceeds it by at least 25 %."""
    from ringlet.validate.loose_waves import frequencies, theory

    shape = "wave around an axis"
    frame, hinge = (np.divide(frequencies(shape, 30, model), theory(shape)) for model in ("material_frame", "history"))
    assert (abs(frame - 1) < 5e-3).all()
    assert (hinge > 1.25).all()


def test_a_wrong_material_fails_the_cantilever(monkeypatch):
    """A rod that is 5 % too stiff fails the validation."""
    from ringlet.validate import cantilever

    right = cantilever.rod_material
    monkeypatch.setattr(cantilever, "rod_material", lambda: right().model_copy(update={"bend_scale": 1.05}))
    monkeypatch.setattr(
        cantilever, "gravity_for", lambda g, length, material, old=cantilever.gravity_for: old(g, length, right())
    )
    cantilever.tip.cache_clear()
    assert not all(row.passed for row in cantilever.run())
    cantilever.tip.cache_clear()
