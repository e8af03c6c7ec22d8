"""Configuration of the documents; references are generated from the program, so that they cannot lag behind it."""

import importlib.metadata
import sys
from concurrent.futures import ProcessPoolExecutor
from multiprocessing import get_context
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent))

from benchmarks import write_benchmarks
from docstrings import as_list
from figures import write_figures
from measured import Growth, Measured, Recorded
from motion_figure import write_motion
from plots import write_convergence, write_live_tips, write_memory, write_release, write_speed_up, write_tips
from reference import write_references
from theory import write_theory

project = "Ringlet"
author = copyright = "The Ringlet authors"
version = release = importlib.metadata.version("ringlet")
extensions = ["myst_parser", "sphinx.ext.autodoc"]
myst_enable_extensions = ["colon_fence", "deflist"]
myst_heading_anchors = 3
exclude_patterns = ["_build", "_generated"]
autodoc_typehints = "signature"
autodoc_member_order = "bysource"
autodoc_class_signature = "separated"  # the text has the fields
html_static_path = ["_static"]
html_theme = "alabaster"
html_title = f"Ringlet {release}"
html_theme_options = {
    "description": "Grooms tightly curled hair and simulates it",
    "page_width": "1080px",
    "sidebar_width": "240px",
    "fixed_sidebar": True,
}


def write_generated(folder):
    """What is listed and drawn from the program, the longest first, on all processors: none needs another."""
    folder.mkdir(exist_ok=True)
    writers = {
        write_references: folder,
        write_theory: folder,
        write_convergence: folder / "convergence.svg",
        write_release: folder / "release.svg",
        write_figures: folder,
        write_motion: folder / "figure_motion.svg",
        write_memory: folder / "memory.svg",
        write_tips: folder / "tips.svg",
        write_live_tips: folder / "live_tips.svg",
        write_speed_up: folder / "speed_up.svg",
        write_benchmarks: folder / "benchmarks.md",
    }
    with ProcessPoolExecutor(mp_context=get_context("fork")) as pool:
        for done in [pool.submit(write, path) for write, path in writers.items()]:
            done.result()


def setup(app):
    app.add_directive("growth", Growth)
    app.add_directive("measured", Measured)
    app.add_directive("recorded", Recorded)
    write_generated(Path(app.srcdir) / "_generated")
    app.connect("autodoc-process-docstring", as_list)
