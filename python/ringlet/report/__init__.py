"""The report of a run: what was asked, what was made, how long it took, and how the simulation behaved."""

from ringlet.report.findings import explain_slowest
from ringlet.report.model import Machine, MadeFile, Picture, RunReport, Stage, Table
from ringlet.report.start import start_table, start_warnings
from ringlet.report.write import write_report

__all__ = [
    "Machine",
    "MadeFile",
    "Picture",
    "RunReport",
    "Stage",
    "Table",
    "explain_slowest",
    "start_table",
    "start_warnings",
    "write_report",
]
