"""Checks the dependencies of modules in C++ and Python against the tables of docs/architecture.md.

Usage: python tools/check_architecture.py [ROOT]. Prints one line per forbidden dependency and exits with 1 if there is
any.
"""

from __future__ import annotations

import ast
import re
import sys
from collections.abc import Iterator
from pathlib import Path

# Folder of src/ringlet → folders that it may include.
CORE = {
    "math": set(),
    "geometry": {"math"},
    "groom": {"geometry", "math"},
    "live": {"geometry", "math"},
    "energy": {"geometry", "math"},
    "linear": {"math"},
    "dynamics": {"linear", "math"},
    "rest": {"energy", "dynamics", "linear", "geometry", "math"},
    "collision": {"geometry", "math"},
    "ccd": {"collision", "geometry", "math"},
    "contact": {"collision", "geometry", "math"},
    "solver": {"contact", "ccd", "dynamics", "collision", "linear", "geometry", "math"},
    "strand": {"solver", "contact", "rest", "energy", "dynamics", "linear", "geometry", "math"},
    "cloth": {"solver", "contact", "energy", "dynamics", "linear", "geometry", "math"},
    "scene": {"solver", "strand", "cloth", "contact", "ccd", "collision", "linear", "geometry", "math"},
}

# Folder of python/ringlet → folders that it may import.
API = "the public API"  # the names of ringlet/__init__.pyi, which are loaded when they are asked for
PYTHON = {
    "data": set(),
    "deform": {"data", "_core"},
    "groom": {"data", "_core", "deform"},
    "adoption": {"data", "_core"},
    "shot": {"data"},
    "motion": {"data"},
    "sim": {"data", "_core", "shot", "motion"},
    "rest": {"data", "_core", "shot", "sim"},
    "live": {"data", "_core", "shot", "motion", "sim", "rest"},
    "validate": {"data", "_core", "shot", "sim", "groom", "motion"},
    "io": {"data", "deform"},
    "picture": {"data"},
    "report": {"data"},
    "api": {
        "data",
        "_core",
        "adoption",
        "deform",
        "groom",
        "shot",
        "sim",
        "live",
        "rest",
        "motion",
        "validate",
        "io",
        "picture",
        "report",
        API,  # for the doctor, which starts where a package is missing
    },
    "viewer": {"data", "_core", "groom", "shot", "sim", "live", "io", "picture", "api"},
    "host": {"data", "groom", "shot", "io", "report", "api", "viewer"},
    "farm": {"data", "groom", "shot", "report", "api"},
    API: {"data", "api", "groom", "shot", "sim", "live", "rest", "viewer", "farm", "host"},
    "cli": {API},
}
# Subfolder of python/ringlet/viewer → subfolders that it may import. Its top-level modules may import all of them.
VIEWER = {
    "files": set(),
    "show": {"files"},
    "edit": {"files", "show"},
    "play": {"files", "show"},
    "keep": {"files", "show"},
}
OUTSIDE = ("bench", "examples")  # folders that may use the public API only

INCLUDE = re.compile(r'^\s*#\s*include\s+"ringlet/([^/"]+)/', re.MULTILINE)
FOREIGN = re.compile(r'^\s*#\s*include\s+[<"](nanobind/|Python\.h|iostream|fstream|cstdio|filesystem)', re.MULTILINE)


def core_problems(root: Path) -> Iterator[str]:
    """Forbidden dependencies between folders of the core, and of the core on other libraries."""
    for file in sorted([*(root / "src/ringlet").rglob("*.h"), *(root / "src/ringlet").rglob("*.cpp")]):
        where, text = file.relative_to(root), file.read_text()
        folder = where.parts[2]
        if folder not in CORE:
            yield f"{where}: '{folder}' is not a folder of the core"
            continue
        for used in sorted({*INCLUDE.findall(text)} - CORE[folder] - {folder}):
            yield f"{where}: {folder} may not use {used}"
        if foreign := FOREIGN.search(text):
            yield f"{where}: the core knows no files, no printing and no Python, but includes {foreign[1]}"


class Package:
    """The modules of python/ringlet and their rows in the table."""

    def __init__(self, root: Path) -> None:
        self.folder = root / "python/ringlet"
        files = sorted(self.folder.rglob("*.py"))
        self.modules = {self.name(file): file for file in files}
        if (stub := self.folder / "__init__.pyi").exists():
            self.modules[""] = stub

    def name(self, file: Path) -> str:
        """Dotted name below ringlet, empty for ringlet itself."""
        return ".".join(file.relative_to(self.folder).with_suffix("").parts).removesuffix("__init__").removesuffix(".")

    def row(self, module: str) -> str:
        """Row of the table for a module."""
        return module.split(".")[0] or API

    def used(self, file: Path) -> set[str]:
        """Rows that a file imports, at any place in it."""
        return {self.row(module) for module in self.imported(file)}

    def imported(self, file: Path) -> set[str]:
        """Modules of the package that a file imports, at any place in it."""
        modules = set()
        for node in ast.walk(ast.parse(file.read_text(), str(file))):
            if isinstance(node, ast.Import):
                names = [alias.name for alias in node.names]
            elif isinstance(node, ast.ImportFrom) and not node.level:
                # An imported name may itself be a module: `from ringlet import _core`.
                names = [f"{node.module}.{alias.name}" for alias in node.names]
            elif isinstance(node, ast.ImportFrom) and file.suffix == ".pyi":  # lazy_loader takes relative names only
                names = [f"ringlet.{node.module}.{alias.name}" for alias in node.names]
            elif isinstance(node, ast.ImportFrom):
                raise SyntaxError(f"{file}:{node.lineno}: relative import; write the full name")
            else:
                continue
            for name in names:
                if name == "ringlet" or name.startswith("ringlet."):
                    modules.add(self.module(name.removeprefix("ringlet").removeprefix(".")))
        return modules

    def module(self, name: str) -> str:
        """Module that contains a dotted name."""
        while name and name not in self.modules and name != "_core":
            name = name.rpartition(".")[0]
        return name


def python_problems(root: Path) -> Iterator[str]:
    """Forbidden dependencies between Python modules, and of examples and benchmarks on them."""
    package = Package(root)
    for module, file in package.modules.items():
        where, row = file.relative_to(root), package.row(module)
        if row not in PYTHON:
            yield f"{where}: '{row}' is not a folder of the package"
            continue
        for used in sorted(package.used(file) - PYTHON[row] - {row}):
            yield f"{where}: {row} may not use {used}"
        folder = module.split(".")[1] if module.startswith("viewer.") else ""
        if folder in VIEWER:
            others = {name.split(".")[1] for name in package.imported(file) if name.startswith("viewer.")} & set(VIEWER)
            for used in sorted(others - VIEWER[folder] - {folder}):
                yield f"{where}: {folder} may not use {used}"
    for folder in OUTSIDE:
        for file in sorted((root / folder).rglob("*.py")):
            for used in sorted(package.used(file) - {API}):
                yield f"{file.relative_to(root)}: {folder} may use the public API only, but uses {used}"


def problems(root: Path) -> list[str]:
    """One line per forbidden dependency in the tree below ``root``."""
    return [*core_problems(root), *python_problems(root)]


def main() -> int:
    """Prints the problems of a tree, by default this one; returns the exit code."""
    found = problems(Path(sys.argv[1]) if len(sys.argv) > 1 else Path(__file__).parents[1])
    print("\n".join(found), end="\n" if found else "")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
