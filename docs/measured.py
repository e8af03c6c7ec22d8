"""Tables of what was measured: a directive whose rows name runs in bench/results, so that no figure is typed.

```{measured}
a step of 500 strands | strands_threads_1
curl 2 000 locks | slider_threads_1 | curl
```
"""

from __future__ import annotations

import json
import subprocess
from functools import cache
from pathlib import Path
from typing import Any

from docutils.nodes import Element, Node
from docutils.statemachine import StringList
from sphinx.util.docutils import SphinxDirective

ROOT = Path(__file__).parents[1]
RESULTS = ROOT / "bench" / "results"
NOTHING = "–"  # in a cell


class Measured(SphinxDirective):
    """A line gives what was measured, the run, and the stage where it is not the whole."""

    has_content = True

    def run(self) -> list[Node]:
        """The table."""
        lines = ["| what | command | CPU | of |", "|---|---|---|---|"]
        for line in self.content:
            what, name, *stage = (cell.strip() for cell in line.split("|"))
            run = json.loads((RESULTS / f"{name}.json").read_text())
            milliseconds = run["result"]["stages"][stage[0]] if stage else run["result"]["cpu_ms"]["median"]
            lines.append(f"| {what} | `{run['command']}` | {time(milliseconds)} | {core_of(run, whole=not stage)} |")
        within = Element()
        self.state.nested_parse(StringList(lines), 0, within)
        return within.children


class Recorded(SphinxDirective):
    """Any values of runs: the columns, what they hold as a path with a format, and a run for each row.

    The commands and the core that they ran stand below the first table of a page that they are in.

    ```{recorded}
    coils | kept
    coils:,d | kept:.0%
    nest_rings_1_threads_1
    ```
    ``NAME : PATH`` makes a row for each item of what is there; ``key`` is the name of the item. What an item does not
    hold is looked up in the whole result.
    """

    has_content = True

    def run(self) -> list[Node]:
        """The table."""
        names, paths, *runs = self.content
        columns = [cell.strip() for cell in paths.split("|")]
        rows: list[list[str]] = []
        commands: dict[str, list[str]] = {}  # by the core that they ran
        for line in runs:
            name, _, path = (word.strip() for word in line.partition(":"))
            run = json.loads((RESULTS / f"{name}.json").read_text())
            found = at(run["result"], path) if path else [run["result"]]
            for key, item in found.items() if isinstance(found, dict) else enumerate(found):
                cells = [value(run["result"] | item | {"key": key}, column) for column in columns]
                rows.append(cells)
            commands.setdefault(core_of(run, whole=False), []).append(run["command"])
        if empty := [path for path, *cells in zip(columns, *rows, strict=False) if {*cells} == {NOTHING}]:
            raise self.error(f"recorded: no run holds {', '.join(empty)}")
        lines = [f"| {names} |", "|---" * len(columns) + "|", *(f"| {' | '.join(row)} |" for row in rows)]
        listed = self.env.temp_data.setdefault("recorded", set[str]())  # of the page
        for core, ran in commands.items():
            if new := [command for command in ran if command not in listed]:
                lines += ["", f"Of {core}:", "", "```sh", *new, "```"]
            listed.update(ran)
        within = Element()
        self.state.nested_parse(StringList(lines), 0, within)
        return within.children


class Growth(SphinxDirective):
    """A table of a run of ``ringlet bench growth``, which is the argument, with its exponents."""

    required_arguments = 1

    def run(self) -> list[Node]:
        """The table and a sentence."""
        run = json.loads((RESULTS / f"{self.arguments[0]}.json").read_text())
        result = run["result"]
        lines = [
            f"`{run['command']}`, of {core_of(run)}: time grows with exponent {result['exponent']:.2f}, contacts with "
            f"{result['contacts_exponent']:.2f}.",
            "",
            "| wisps | CPU per step (median) | contacts | CG iterations per step |",
            "|---|---|---|---|",
        ]
        lines += [
            f"| {one['strands']:,} | {time(one['cpu_ms'])} | {one['contacts']:,.0f} | {one['linear_iterations']:.0f} |"
            for one in result["sizes"]
        ]
        within = Element()
        self.state.nested_parse(StringList(lines), 0, within)
        return within.children


def at(result: dict[str, Any], path: str) -> Any:
    """What a result holds at a path of names with points between; None where it holds nothing there."""
    for name in path.split("."):
        result = result.get(name) if result is not None else None
    return result


def value(result: dict[str, Any], column: str) -> str:
    """What a result holds at ``path:format``, written so; a dash where it holds nothing there."""
    path, _, style = column.partition(":")
    found = at(result, path)
    return NOTHING if found is None else format(found, style)


def time(milliseconds: float) -> str:
    """A time with three digits, in ms or s."""
    return f"{milliseconds:.3g} ms" if milliseconds < 1000 else f"{milliseconds / 1e3:.3g} s"


def core_of(run: dict[str, Any], whole: bool = True) -> str:
    """The commit that a run is of, whether its sources are those of today, and the ratio by turns of the whole."""
    if "commit" not in run:
        return "an older core"
    now = {folder: tree_of(folder) for folder in run["sources"]}
    changed = "" if now == run["sources"] else ", changed since"
    if not whole or not (reference := run.get("reference")):
        return run["commit"] + changed
    spread = f"{reference['least']:.2f} to {reference['most']:.2f}"
    return f"{run['commit']}{changed}; by turns {reference['ratio']:.2f} times {reference['commit']} ({spread})"


@cache
def tree_of(folder: str) -> str:
    """The name that git gives the content of a folder at HEAD; empty where there is no history."""
    command = ["git", "rev-parse", "--verify", "--quiet", f"HEAD:{folder}"]
    return subprocess.run(command, cwd=ROOT, stdout=subprocess.PIPE, text=True).stdout.strip()
