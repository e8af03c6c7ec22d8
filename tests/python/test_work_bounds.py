"""Work has bounds: what settings ask for together is limited by what it can change, or refused."""

from __future__ import annotations

import subprocess
import sys

import numpy as np
import pytest
from ringlet.groom.scalp import Scalp
from shapes import ball, sheet

from ringlet import UserError
from ringlet.groom import groups, make_groom, parse_recipe

FEW = "ringlet = 2\n[guides]\ncount = 8\nlength = 6\n[locks]\ncount = 12\n"


def test_levels_of_clumps_beyond_the_distance_of_locks_take_no_samples(monkeypatch):
    counts = []
    sample = Scalp.sample

    def counted(self, count, *more):
        counts.append(count)
        return sample(self, count, *more)

    monkeypatch.setattr(Scalp, "sample", counted)
    shape = "[[shape]]\nop = 'clump'\nsize = 8\nlevels = 8\n"
    made = make_groom(parse_recipe(FEW + shape), ball())
    assert max(counts) < 200  # eight levels took 16 000 times as many as the first
    fewer = make_groom(parse_recipe(FEW + shape.replace("8\nlevels = 8", "8\nlevels = 3")), ball())
    np.testing.assert_array_equal(made.locks.points, fewer.locks.points)


def test_a_level_finer_than_the_locks_leaves_each_its_own_leader():
    scalp = Scalp(sheet(), None)
    roots = np.array([[0.01 * i, 0.0, 0.01 * j] for i in range(5) for j in range(5)])
    shapes = roots[:, None] + np.linspace(0.0, 0.05, 6)[:, None] * [0.0, 1.0, 0.0]
    for size in (4.9e-3, 1e-3, 1e-9):
        np.testing.assert_array_equal(groups.leaders(shapes, size, 60.0, scalp, 1, "size"), np.arange(25))
    # Samples twice as dense as locks are denser than needed: they make each lock a leader too.
    np.testing.assert_array_equal(groups.leaders(shapes, 5.1e-3, 60.0, scalp, 1, "size"), np.arange(25))
    assert len(np.unique(groups.leaders(shapes, 2e-2, 60.0, scalp, 1, "size"))) < 25


@pytest.mark.parametrize(
    ("text", "setting"),
    [
        ("[guides]\nspacing = '0.1 mm'", "guides.spacing"),
        ("[locks]\nspacing = '0.1 mm'", "locks.spacing"),
        ("[locks]\ncount = 40\n[locks.sections]\npattern = 'grid'\nsize = '2 mm'", "locks.sections.size"),
    ],
)
def test_a_spacing_that_takes_too_many_samples_is_refused(text, setting):
    with pytest.raises(UserError, match=rf"{setting} puts .* samples on ball.*at most 1,000,000") as caught:
        make_groom(parse_recipe("ringlet = 2\n" + text), ball(radius=1.0))
    assert "\n" not in str(caught.value)


BEYOND_MEMORY = """
import os, sys, numpy as np
from ringlet.cli import app
memory = os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES")
def groom(*_, **__):
    kept = [np.empty(int(0.6 * memory), np.uint8) for _ in range(2)]  # none of it is touched
app.ringlet.read_recipe = groom
sys.argv = ["ringlet", "groom", "r.recipe.toml", "-o", "g.usdc"]
app.main()
"""


@pytest.mark.skipif(sys.platform != "linux", reason="Linux gives memory that it does not have")
def test_what_does_not_fit_in_memory_is_refused_in_one_line(tmp_path):
    done = subprocess.run([sys.executable, "-c", BEYOND_MEMORY], cwd=tmp_path, capture_output=True, text=True)
    assert done.returncode == 2
    assert done.stderr.startswith("error: memory ran out") and done.stderr.count("\n") == 1
