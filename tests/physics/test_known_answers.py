"""Every known answer, at every resolution."""

import pytest
from ringlet.validate import CASES, run_case


@pytest.mark.parametrize("name", CASES)
def test_the_simulator_gives_the_known_answer(name):
    rows = run_case(name)
    assert len(rows) > 0
    failed = [f"{row.case}: expected {row.expected:.6g}, got {row.got:.6g}" for row in rows if not row.passed]
    assert not failed, "\n".join(failed)


def test_a_wrong_material_fails_the_cantilever(monkeypatch):
    """The rows can fail: a rod that is 5 % too stiff is caught."""
    from ringlet.validate import cantilever

    right = cantilever.rod_material
    monkeypatch.setattr(cantilever, "rod_material", lambda: right().model_copy(update={"bend_scale": 1.05}))
    monkeypatch.setattr(
        cantilever, "gravity_for", lambda g, length, material, old=cantilever.gravity_for: old(g, length, right())
    )
    cantilever.tip.cache_clear()
    assert not all(row.passed for row in cantilever.run())
    cantilever.tip.cache_clear()
