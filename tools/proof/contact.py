"""Judges the contact scenes and prints the table of the documents in Markdown.

python tools/proof/contact.py [wound_coils …] [--runs 8]
"""

from __future__ import annotations

import argparse
import itertools

import numpy as np
from contact_scenes import SCENES
from trial import judged_run


def print_spread(names, runs):
    """Prints the spread of perturbed runs: crossings, changed linking numbers and the largest stretch of each run."""
    for name, newton in itertools.product(names, (1, 5)):
        results = [judged_run(SCENES[name]().jittered(seed), newton) for seed in range(1, runs + 1)]
        crossings = sum(result.crossings for result in results)
        unlinked = sum(np.abs(result.links[1] - result.links[0]).max(initial=0.0) > 0.5 for result in results)
        stretches = " ".join(f"{stretch:.3g}" for stretch in sorted(result.stretch for result in results))
        print(f"{name}, newton {newton}: {crossings} crossings, {unlinked} times relinked; stretch {stretches}")


def main():
    """Prints a row for each of the named scenes, by default all, with one and with five Newton iterations."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("scenes", nargs="*", default=list(SCENES), help=", ".join(SCENES))
    parser.add_argument(
        "--runs",
        type=int,
        default=0,
        help="print the spread of N perturbed runs instead",
    )
    options = parser.parse_args()
    if unknown := set(options.scenes) - set(SCENES):
        parser.error(f"no scene {', '.join(sorted(unknown))}; choose from {', '.join(SCENES)}")
    if options.runs:
        return print_spread(options.scenes, options.runs)
    print("| scene | newton | crossings | linking | worst stretch | closest [mm] | limited | contacts |")
    print("|---|---|---|---|---|---|---|---|")
    for name in options.scenes:
        for newton in (1, 5):
            result = judged_run(SCENES[name](), newton)
            before, after = (" ".join(f"{abs(n):.0f}" for n in links if abs(n) > 0.5) for links in result.links)
            numbers = f"{result.stretch:.3g} | {1e3 * result.closest:.2g} | {result.violations} | {result.contacts}"
            finite = "" if result.finite else ", then NaN"
            linking = f"{before} → {after}" if before or after else "–"
            title = name.replace("_", " ")
            print(f"| {title} | {newton} | {result.crossings}{finite} | {linking} | {numbers} |")


if __name__ == "__main__":
    main()
