"""Curls that a sphere of 50 000 triangles flies through; `make test` has one of 12 500."""

import pytest
from contact_scenes import run_through
from trial import judged_run


@pytest.mark.parametrize("newton", [1, 5])
def test_a_fine_sphere_flies_through_curls_without_a_crossing(newton):
    result = judged_run(run_through(), newton)
    assert result.finite
    assert result.crossings == 0
    assert result.stretch < 3.0
