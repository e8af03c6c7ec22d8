"""What contact adds to the stiffness of live hair is found from a short run in contact, in a process of its own."""

from __future__ import annotations

import os
import select
import subprocess
import time
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray
from ringlet.live.calibration import Calibration
from ringlet.shot import ShotContact
from ringlet.viewer.play import calibrator
from ringlet.viewer.play.calibrator import Calibrator
from small_example import write_example

import ringlet
from ringlet import Groom, Live, Material
from ringlet.live import calibration

Array = NDArray[np.float64]


@pytest.fixture(scope="module")
def groom(tmp_path_factory: pytest.TempPathFactory) -> Groom:
    folder = write_example(tmp_path_factory.mktemp("calibration"))
    return ringlet.build_groom(folder / "small.recipe.toml")


def calibration_of(groom: Groom, material: Material | None = None) -> Calibration:
    return Calibration(groom, material or Material(), (), (0.0, -9.81, 0.0), 24.0, ShotContact())


def test_the_contact_that_moved_a_sample_is_found(groom: Groom, monkeypatch: pytest.MonkeyPatch) -> None:
    def in_contact(_: Calibration, sample: Groom, heads: Array) -> Array:
        live = Live(sample)
        live.contact, live.trunk = 0.05, np.eye(4)
        return calibration._live(live, heads)

    monkeypatch.setattr(calibration, "FIRMEST", 1.0)  # as eight locks hardly hold one another
    monkeypatch.setattr(Calibration, "_in_contact", in_contact)
    assert ringlet.calibrate(groom) == pytest.approx(0.05, rel=0.1)


def test_hair_that_hardly_moves_keeps_the_default(groom: Groom, monkeypatch: pytest.MonkeyPatch) -> None:
    def in_contact(_: Calibration, sample: Groom, heads: Array) -> Array:
        return np.repeat(np.asarray(sample.locks.points, np.float64)[None], len(heads), axis=0)

    monkeypatch.setattr(Calibration, "_in_contact", in_contact)
    assert ringlet.calibrate(groom) == Live(groom).contact


def test_a_sample_moves_in_contact_with_its_head(groom: Groom, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(calibration, "SETTLING", 2)
    heads = calibration._heads(np.array([0.0, -0.1, 0.0]), 24.0)[:8]
    points = calibration_of(groom)._in_contact(groom, heads)
    roots = groom.locks.offsets[:-1]
    assert points[:, roots] == pytest.approx(np.broadcast_to(groom.locks.points[roots], (8, len(roots), 3)), abs=1e-5)
    assert 1e-3 < np.linalg.norm(points[-1] - points[0], axis=1).max() < 0.1


def test_the_key_is_that_of_groom_and_material(groom: Groom) -> None:
    one, same, stiffer = (calibration_of(groom, Material(bend_scale=scale)) for scale in (1.0, 1.0, 2.0))
    assert one.key == same.key != stiffer.key


@pytest.fixture
def counted(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> Iterator[Path]:
    """Processes that find 3e-4 at once; each leaves a line in a file."""
    log = tmp_path / "log"
    log.touch()
    code = f"import os; open({str(log)!r}, 'a').write(f'{{os.nice(0)}}\\n'); print(3e-4)"
    monkeypatch.setattr(calibrator, "COMMAND", [calibrator.sys.executable, "-c", code])
    monkeypatch.setattr(calibrator, "REST", 0.2)
    yield log


def found(calibrator: Calibrator) -> float:
    end = time.monotonic() + 60.0
    while (contact := calibrator.poll()) is None:
        assert time.monotonic() < end
        time.sleep(0.01)
    return contact


def test_a_contact_is_found_once_hair_has_rested(groom: Groom, counted: Path) -> None:
    one = Calibrator()
    one.change(lambda: calibration_of(groom))
    began = time.monotonic()
    assert one.poll() is None
    assert found(one) == 3e-4
    assert time.monotonic() - began >= calibrator.REST
    assert one.poll() is None
    one.change(lambda: calibration_of(groom))
    assert found(one) == 3e-4
    assert len(counted.read_text().splitlines()) == 1  # the second is known


def test_it_runs_at_a_low_priority(groom: Groom, counted: Path) -> None:
    one = Calibrator()
    one.change(lambda: calibration_of(groom))
    found(one)
    assert int(counted.read_text()) == min(19, os.nice(0) + calibrator.NICE)


def test_a_change_gives_up_what_is_being_found(groom: Groom, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(calibrator, "COMMAND", [calibrator.sys.executable, "-c", "import time; time.sleep(600)"])
    monkeypatch.setattr(calibrator, "REST", 0.0)
    one = Calibrator()
    one.change(lambda: calibration_of(groom))
    assert one.poll() is None
    process = one._process
    assert process is not None and process.poll() is None
    one.change(lambda: calibration_of(groom))
    assert process.poll() is not None
    one.stop()
    assert one.poll() is None


def test_a_process_that_fails_leaves_the_default(groom: Groom, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(calibrator, "COMMAND", [calibrator.sys.executable, "-c", "raise SystemExit(1)"])
    monkeypatch.setattr(calibrator, "REST", 0.0)
    one = Calibrator()
    one.change(lambda: calibration_of(groom))
    one.poll()
    assert one._process is not None
    one._process.wait()
    assert one.poll() is None
    assert one._process is None


def test_a_calibration_ends_with_a_server_that_is_killed() -> None:
    begins = f"import os, subprocess; subprocess.Popen([*{calibrator.COMMAND!r}, str(os.getpid())])"
    waits = f"{begins}; print('began', flush=True); input()"
    command = [calibrator.sys.executable, "-c", waits]
    with subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True) as server:
        assert server.stdout is not None
        assert server.stdout.readline() == "began\n"
        server.kill()
        ended = select.select([server.stdout], [], [], 60.0)[0]  # once no process writes there
        assert ended
        assert server.stdout.read() == ""
