"""Many runs of one shot: wedges on this machine, on a cluster of dask.distributed, or on a render farm."""

from ringlet.farm.wedge import compare_wedge, wedge, write_wedge_template

__all__ = ["compare_wedge", "wedge", "write_wedge_template"]
