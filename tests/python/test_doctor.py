"""The diagnosis of an installation."""

import json
import subprocess
import sys

import pytest
from ringlet.api import doctor
from ringlet.cli.app import app
from typer.testing import CliRunner

import ringlet


def test_the_doctor_finds_this_installation_complete():
    findings = {finding.name: finding for finding in ringlet.diagnose()}
    assert {finding.state for finding in findings.values()} <= {"ok", "optional"}
    assert "known answers hold" in findings["simulation"].found
    assert "stopped" in findings["contact"].found
    assert {"numpy", "scipy", "server of the review", "usd-core"} <= findings.keys()
    assert "locks groomed" in findings["groom and USD"].found
    assert findings["picture"].state == "ok"


def test_a_failed_check_is_reported_and_the_others_still_run(monkeypatch):
    def broken(folder):
        raise RuntimeError("out of order")

    monkeypatch.setattr(doctor, "_test_core", broken)
    monkeypatch.setattr(doctor, "_test_files", lambda folder: doctor.Finding("groom and USD", "ok", "fine"))
    monkeypatch.setattr(doctor, "_test_picture", broken)
    monkeypatch.setattr(doctor, "_test_contact", broken)
    monkeypatch.setattr(doctor, "_needed", lambda: ["numpy", "no-such-package"])
    result = CliRunner().invoke(app, ["doctor", "--json"])
    assert result.exit_code == 1
    findings = {entry["name"]: entry for entry in json.loads(result.stdout)}
    assert findings["numpy"]["state"] == "ok" and findings["groom and USD"]["state"] == "ok"
    assert findings["no-such-package"]["state"] == "fails" and "pip install" in findings["no-such-package"]["remedy"]
    assert "out of order" in findings["broken"]["found"]


@pytest.mark.parametrize(("package", "fail"), [("pxr", {"files", "picture"}), ("scipy.sparse", {"core", "pardiso"})])
def test_the_doctor_reports_where_a_package_is_missing(package, fail):
    text = f"import sys; sys.modules['{package}'] = None; from ringlet.cli.app import main; main()"
    run = subprocess.run([sys.executable, "-c", text, "doctor", "--json"], capture_output=True, text=True)
    assert run.returncode == 1, run.stderr
    failed = {entry["name"]: entry["found"] for entry in json.loads(run.stdout) if entry["state"] == "fails"}
    assert failed.keys() >= fail and all(package in found for found in failed.values())


def test_no_simulation_runs_without_the_self_test(monkeypatch):
    monkeypatch.setattr(doctor, "_test_core", None)
    result = CliRunner().invoke(app, ["doctor", "--no-self-test"])
    assert result.exit_code == 0 and "processor" in result.stdout and "simulation" not in result.stdout
    assert "ringlet[direct]" in result.stdout or "opened" in result.stdout
