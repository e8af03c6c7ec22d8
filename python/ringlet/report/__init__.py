"""The report of a run: settings, output files, timings and statistics of the simulation."""

from ringlet.report.charts import line_chart
from ringlet.report.findings import explain_slowest, percent
from ringlet.report.model import Machine, MadeFile, Picture, RunReport, Stage, Table
from ringlet.report.page import document, figure, table
from ringlet.report.start import start_table, start_warnings
from ringlet.report.verdict import Finding, Verdict, judge
from ringlet.report.write import write_report

__all__ = [
    "Finding",
    "Machine",
    "MadeFile",
    "Picture",
    "RunReport",
    "Stage",
    "Table",
    "Verdict",
    "document",
    "explain_slowest",
    "figure",
    "judge",
    "line_chart",
    "percent",
    "start_table",
    "start_warnings",
    "table",
    "write_report",
]
