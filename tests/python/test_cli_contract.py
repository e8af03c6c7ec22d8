"""The interface for programs: JSON and exit codes of ``bench`` and ``validate``."""

from __future__ import annotations

import json
import math
import subprocess
import sys
from dataclasses import dataclass
from functools import partial
from itertools import pairwise

import pytest
from commands import run

import ringlet


@dataclass
class Answer:
    """A fake row of a validation."""

    case: str
    expected: float
    got: float
    tolerance: float = 0.1

    @property
    def error(self) -> float:
        return abs(self.got / self.expected - 1)

    @property
    def passed(self) -> bool:
        return self.error <= self.tolerance

    def json(self) -> dict:
        return {**vars(self), "error": self.error, "pass": self.passed}


@pytest.mark.parametrize(
    ("arguments", "expected"),
    [
        (["groom", "--locks", "20", "--hairs", "60"], {"locks": 20, "hairs": 60}),
        (["cloth", "--side", "5", "--steps", "3"], {"side": 5, "steps": 3}),
        (["cloth", "--side", "6", "--steps", "3", "--contacts", "on"], {"side": 6, "contacts": "on"}),
        (["mixed", "--strands", "3", "--side", "6", "--steps", "3"], {"strands": 3, "side": 6}),
        (["direct", "--strands", "4", "--vertices", "12", "--method", "builtin"], {"strands": 4, "method": "builtin"}),
        (["growth", "--least", "2", "--most", "4", "--steps", "4"], {"least": 2, "most": 4}),
        (["iterations", "--frames", "1", "--converged", "2", "--contacts", "off"], {"frames": 1, "contacts": "off"}),
        (["liveliness", "--locks", "30", "--frames", "2", "--stiffness", "0.1"], {"locks": 30, "stiffness": 0.1}),
        (["liveliness", "--locks", "9", "--frames", "2", "--linear-tolerance", "0.02"], {"linear_tolerance": 0.02}),
        (["memory", "--strands", "20"], {"strands": 20}),
        (["strands", "--strands", "4", "--steps", "3"], {"strands": 4, "steps": 3}),
        (["head", "--locks", "30", "--points", "30", "--frames", "2", "--preroll", "0"], {"locks": 30, "points": 30}),
        (["twirl", "--strands", "3", "--contacts", "off", "--steps", "4"], {"strands": 3, "contacts": "off"}),
        (["twirl", "--strands", "3", "--contacts", "on", "--steps", "4"], {"strands": 3, "contacts": "on"}),
        (["twirl", "--strands", "3", "--contacts", "on", "--steps", "4", "--heads", "2"], {"strands": 3, "heads": 2}),
    ],
)
def test_bench_prints_the_documented_object(arguments, expected):
    result = run("bench", *arguments, "--json", "--threads", "1")
    assert result.exit_code == 0, result.output
    output = json.loads(result.stdout)
    assert output["name"] == arguments[0]
    assert expected.items() <= output["params"].items()
    assert output["threads"] == 1
    assert output["simd"] in ("baseline", "avx2", "avx512")
    for times in (output["cpu_ms"], output["wall_ms"]):
        assert 0 < times["min"] <= times["median"] <= times["max"]
    assert all(time >= 0 for time in output["stages"].values())


def test_bench_view_stops_its_server_and_prints_only_json():
    program = "import sys; from ringlet.cli import main; sys.argv[0] = 'ringlet'; main()"
    arguments = ["bench", "view", "--locks", "12", "--per_lock", "3", "--steps", "3", "--json"]
    done = subprocess.run([sys.executable, "-c", program, *arguments], capture_output=True, text=True, timeout=120)
    output = json.loads(done.stdout)
    assert done.stderr == "" and output["hairs"] == 36 and output["frame_bytes"] > 12 * 12 * 96


@pytest.fixture
def twirls(monkeypatch):
    """Records the parameters that ``ringlet bench growth`` passes to the twirl scene, without running it."""
    calls = []

    def run_bench(name, **params):
        calls.append((params["strands"], params["radius"], params["heads"]))
        counts = {"contacts": 2.0 * params["strands"], "candidates": 0, "linear_iterations": 0}
        return {"cpu_ms": {"median": 3.0 * params["strands"] ** 1.5}, **counts}

    monkeypatch.setattr(ringlet, "run_bench", run_bench)
    return calls


run_growth = partial(ringlet.run_bench, "growth", least=64, most=256)


def test_bench_growth_at_constant_density_scales_the_sphere(twirls):
    output = run_growth(kept="density")
    density = pytest.approx(256 / 0.1525**2)
    assert [(n, n / radius**2, heads) for n, radius, heads in twirls] == [(n, density, 1) for n in (64, 128, 256)]
    assert output["exponent"] == pytest.approx(1.5) and output["contacts_exponent"] == pytest.approx(1.0)


def test_bench_growth_at_constant_size_adds_heads(twirls):
    run_growth(kept="heads")
    assert twirls == [(64, 0.1525, 1), (128, 0.1525, 2), (256, 0.1525, 4)]


def test_bench_growth_takes_the_fastest_repetition_of_each_size(monkeypatch):
    times = iter(
        [10.0, 40.0, 160.0, 12.0, 20.0, 40.0]
    )  # two rounds over three sizes; the first time of the second size is an outlier

    def run_bench(name, **params):
        return {"cpu_ms": {"median": next(times)}, "contacts": 1, "candidates": 0, "linear_iterations": 0}

    monkeypatch.setattr(ringlet, "run_bench", run_bench)
    output = run_growth(turns=2)
    assert [size["cpu_ms"] for size in output["sizes"]] == [10, 20, 40] and output["exponent"] == pytest.approx(1.0)
    with pytest.raises(ringlet.UserError, match="turns is 0; must be at least 1"):
        run_growth(turns=0)


def test_bench_growth_fits_a_power_to_the_times_of_all_sizes():
    result = run("bench", "growth", "--least", "2", "--most", "9", "--steps", "4", "--json", "--threads", "1")
    output = json.loads(result.stdout)
    assert [size["strands"] for size in output["sizes"]] == [2, 4, 8]
    steps = [math.log2(b["cpu_ms"] / a["cpu_ms"]) for a, b in pairwise(output["sizes"])]
    assert min(steps) - 1e-9 <= output["exponent"] <= max(steps) + 1e-9


def test_validate_prints_rows_and_succeeds_when_all_pass():
    result = run("validate", "cantilever", "--json")
    assert result.exit_code == 0, result.output
    rows = json.loads(result.stdout)
    assert rows
    for row in rows:
        assert set(row) == {"case", "expected", "got", "error", "tolerance", "pass"}
        assert row["pass"] is (row["error"] <= row["tolerance"])


@pytest.mark.parametrize("got", [2.0, math.nan])
def test_validate_exits_with_1_when_a_row_fails(monkeypatch, got):
    rows = [Answer("good", 1.0, 1.0), Answer("bad", 1.0, got)]
    monkeypatch.setattr(ringlet, "run_validation", lambda *_, **__: rows)
    assert run("validate").exit_code == 1
    result = run("validate", "--json")
    assert result.exit_code == 1
    assert [row["pass"] for row in json.loads(result.stdout)] == [True, False]


def test_validate_shows_a_table(monkeypatch):
    monkeypatch.setattr(ringlet, "run_validation", lambda *_, **__: [Answer("a rod that bends", 1.0, 2.0)])
    output = run("validate").stdout
    assert "a rod that bends" in output
    assert "FAILS" in output
