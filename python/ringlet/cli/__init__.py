"""The command line: one file per command, put together in ``app``."""

from ringlet.cli.app import main

__all__ = ["main"]
