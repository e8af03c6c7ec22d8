"""Wedges and whole shots: on this machine, on a dask.distributed cluster, or on a render farm."""

from ringlet.farm.shot_job import write_shot_job
from ringlet.farm.wedge import compare_wedge, wedge, write_wedge_template

__all__ = ["compare_wedge", "wedge", "write_shot_job", "write_wedge_template"]
