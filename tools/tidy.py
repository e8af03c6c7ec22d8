"""Runs clang-tidy over the core in few translation units, since nearly all of the time of one goes into its headers.

Usage: .venv/bin/python tools/tidy.py BUILD, with the compilation database of single files (RINGLET_UNITY=OFF) in BUILD.
A unit is the text of its files, since the analyser follows only functions of the main file; messages name the files.
Files compiled per instruction set stay by themselves, since their anonymous names collide. All are checked for the
baseline, and those that name a set for every set.
"""

import json
import os
import re
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from itertools import accumulate
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
CORE = ROOT / "src/ringlet"
JOBS = 2
# States that the analyser visits in a function at most. Half of the core takes 35 s of processor time, 149 s with the
# analyser's own bound of 225,000; of 101 faults put before its returns, 53 are found, and 52 with that.
NODES = 20_000


def commands(build: Path) -> dict[str, dict[Path, str]]:
    """The command without its source, by instruction set ("" for the core itself) and source."""
    found: dict[str, dict[Path, str]] = {}
    for entry in json.loads((build / "compile_commands.json").read_text()):
        if CORE in (file := Path(entry["file"])).parents:
            # Without the flags that only GCC knows.
            command = re.sub(r" -m(memcpy|memset|move|store)-\S*", "", entry["command"].split(" -o ")[0])
            simd = re.search(r"-DRINGLET_SIMD=(\w+)", command)
            found.setdefault(simd[1] if simd else "", {})[file] = command
    return found


def units(build: Path) -> dict[str, tuple[str, list[Path]]]:
    """Command and files of each translation unit by its name, the longest first."""
    sets = commands(build)
    core, baseline = sets.pop(""), sets.pop("baseline")
    files = sorted(core)
    result = {f"core{i}": (core[files[0]], files[i::JOBS]) for i in range(JOBS)}
    result |= {file.stem: (command, [file]) for file, command in baseline.items()}
    headers = [header for header in CORE.rglob("*.h") if names_a_set(header)]
    for name, of_set in sets.items():
        result[name] = next(iter(of_set.values())), [*headers, *filter(names_a_set, of_set)]
    return result


def names_a_set(file: Path) -> bool:
    return re.search("SIMD_avx|__AVX", file.read_text()) is not None


def text(file: Path, number: int) -> str:
    if file.suffix == ".h":
        return f'#include "{file}"\n'
    return f"#define RINGLET_UNIT_{number}\n{file.read_text()}\n"  # a macro, as the same header may be included again


def place(files: list[Path], line: int) -> str:
    """The file and its line, of a line of the unit."""
    ends = accumulate(text(file, i).count("\n") for i, file in enumerate(files))
    file, end = next((f, end) for f, end in zip(files, ends, strict=True) if line <= end)
    return f"{file.relative_to(ROOT)}:{line - end + text(file, 0).count(chr(10)) - 1}"


def main(build: Path) -> int:
    folder = (build / "units").resolve()
    folder.mkdir(parents=True, exist_ok=True)
    checked = units(build)
    database = []
    for name, (command, files) in checked.items():
        unit = folder / f"{name}.cpp"
        unit.write_text("".join(text(file, i) for i, file in enumerate(files)))
        database.append({"directory": str(folder), "file": str(unit), "command": f"{command} -c {unit}"})
    (folder / "compile_commands.json").write_text(json.dumps(database))
    # clang-tidy brings headers of its own, but not that of OpenMP: it gets the compiler's, after all others.
    openmp = subprocess.check_output([os.environ.get("CXX", "c++"), "-print-file-name=include/omp.h"], text=True)
    tidy = [str(ROOT / ".venv/bin/clang-tidy"), "-quiet", "-p", str(folder), f"--config-file={ROOT / '.clang-tidy'}"]
    tidy += ["-extra-arg=-idirafter", f"-extra-arg={Path(openmp).parent}"]
    tidy += [f"-extra-arg={word}" for word in ("-Xclang", "-analyzer-config", "-Xclang", f"max-nodes={NODES}")]

    def check(name: str) -> int:
        unit, files = folder / f"{name}.cpp", checked[name][1]
        done = subprocess.run([*tidy, str(unit)], capture_output=True, text=True)
        if done.returncode:
            print(re.sub(rf"{re.escape(str(unit))}:(\d+)", lambda m: place(files, int(m[1])), done.stdout), done.stderr)
        return done.returncode

    with ThreadPoolExecutor(JOBS) as pool:
        return max(pool.map(check, checked))


if __name__ == "__main__":
    sys.exit(main(Path(sys.argv[1])))
