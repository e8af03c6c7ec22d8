"""Wedges of a shot: on this machine, on a dask.distributed cluster, or on a render farm."""

from ringlet.farm.wedge import compare_wedge, wedge, write_wedge_template

__all__ = ["compare_wedge", "wedge", "write_wedge_template"]
