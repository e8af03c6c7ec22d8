"""Wedges of a shot: on this machine, on a dask.distributed cluster, or on a render farm."""

from ringlet.farm.shot_job import write_shot_template
from ringlet.farm.wedge import compare_wedge, wedge, write_wedge_template

__all__ = ["compare_wedge", "wedge", "write_shot_template", "write_wedge_template"]
