"""Operators of styles on the page: added, changed, undone and redone, with the same recipe and groom each time."""

from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from pages import Page, page, serving

STRANDS = "[locks.sections]\nsize = 9\nstrands = 3\n"
ROWS = "[locks.sections]\npattern = 'rows'\nsize = 9\nstrands = 3\n"
LOOSE = ""
STYLES: dict[str, tuple[str, list[Any]]] = {
    "braid": (STRANDS, ["end", "bead"]),
    "twist": (STRANDS, ["width", 1.4]),
    "cornrow": (ROWS, ["band", "2 mm"]),
    "loc": (STRANDS, ["radius", {"value": 0.5, "ramp": [[0, 1], [1, 0.5]]}]),
    "knot": (STRANDS, ["windings", 2]),
    "tie": (LOOSE, ["band", {"value": 0.4}]),
    "cut": (LOOSE, ["at", 6]),
    "grow_to": (LOOSE, ["spread", 1]),
    "edges": (LOOSE, ["within", 5]),
    "hairline": (LOOSE, ["laid", 1]),
}


def with_styles(folder: Path, sections: str) -> Path:
    recipe = folder / "small.recipe.toml"
    text = (
        recipe.read_text()
        .replace("length = 5", "length = 8" if sections else "length = 14")
        .replace("points = 40", "points = 160")
    )
    text = text.replace("count = 8\n", "count = 80\n" if not sections else "")
    curl, hairs = text.index("[curl]"), text.index("[hairs]")
    recipe.write_text(text[:curl] + sections + text[hairs:])
    return recipe


def state(one: Page, before: dict[str, Any] | None = None) -> dict[str, Any]:
    """What a page shows: the recipe's text, and the bytes of locks, hairs and bodies, after what it showed before."""
    known = len(one.received)
    document = one.receive("document")
    locks = one.receive("locks", side="a", draft=False)
    one.receive("numbers", revision=document["revision"], draft=False)
    bodies = {m["index"]: m["points"].tobytes() for m in one.received[known:] if m["kind"] == "body"}
    shown = before["bodies"] if before and not bodies else bodies
    return {"text": document["text"], "locks": arrays(locks), "hairs": arrays(one.latest("hairs")), "bodies": shown}


def arrays(message: dict[str, Any]) -> dict[str, bytes]:
    return {name: value.tobytes() for name, value in message.items() if isinstance(value, np.ndarray)}


@pytest.mark.parametrize("style", STYLES)
def test_a_style_is_added_changed_undone_and_redone_to_the_same_bytes(style: str, folder: Path):
    sections, (setting, value) = STYLES[style]
    with_styles(folder, sections)
    with serving(folder) as client, page(client) as one:
        shown = [state(one)]
        if style == "hairline":
            one.send(kind="set", changes=[[["locks", "hairline", "width"], 3]], gesture=1)
        else:
            one.send(kind="arrange", action="add", at=0, op=style)
        shown.append(state(one, shown[-1]))
        place = ["locks", "hairline", setting] if style == "hairline" else ["shape", 0, setting]
        one.send(kind="set", changes=[[place, value]], gesture=2)
        shown.append(state(one, shown[-1]))
        assert all(a["text"] != b["text"] and a != {**b, "text": a["text"]} for a, b in pairwise(shown))
        now = shown[-1]
        for step, expected in (("undo", 1), ("undo", 0), ("redo", 1), ("redo", 2)):
            one.send(kind=step)
            now = state(one, now)
            for name, content in shown[expected].items():
                assert now[name] == content, f"{name} after {step}"
