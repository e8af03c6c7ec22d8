"""The share page: one HTML file with a look to turn, without a server and without the network."""

from __future__ import annotations

import base64
import gzip
import html
import json
import struct
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ringlet.data.errors import UserError
from ringlet.data.files import replacing
from ringlet.data.reads import unrecorded
from ringlet.groom import read_recipe
from ringlet.viewer.keep.share_review import review_of
from ringlet.viewer.project import Project
from ringlet.viewer.protocol import Rig
from ringlet.viewer.publisher import Publisher
from ringlet.viewer.show import display_colors
from ringlet.viewer.show.display_groom import GroomEvaluator
from ringlet.viewer.show.lights import live_rigs, live_rigs_of
from ringlet.viewer.show.scene import USD, read_scene
from ringlet.viewer.show.viewport import Viewport
from ringlet.viewer.wire import join, split

STATIC = Path(__file__).parents[1] / "static" / "share"
MOST = 15_000_000  # largest size of a page [bytes]
MARGIN = 0.97  # on the number of hairs that fit, whose data are not all equally small when compressed
WIDEST = 2.0  # largest factor on the width of hairs that stand for others
SHARED = ("body/", "a/hairs", "a/colors", "a/locks")  # subjects of the messages that a page holds

# Arrays of the hairs that have entries for each of them.
EACH = {
    *("lock", "group", "offset", "tip", "join", "flat", "taper", "other", "share", "frizz", "root", "width"),
    *("slip", "escape", "relax", "family", "coil", "phase", "reflectance"),
}

# A page loads nothing: it holds all that it shows.
POLICY = "default-src 'none'; script-src 'unsafe-inline'; style-src 'unsafe-inline'; img-src data: blob:"


@dataclass(frozen=True)
class SharePage:
    """A page that was made. hairs: number of its hairs, of the ``of`` of the look."""

    text: str
    hairs: int
    of: int


@unrecorded()
def share(file: Path | str, output: Path | str, *, view: Mapping[str, Any] | None = None) -> dict[str, int]:
    """Writes a page that shows a recipe, or the hair of a USD file, from all sides.

    view: how the look is first seen: ``camera`` (position and target [m], six numbers), ``light``, ``color``, ``theme``

    Returns the numbers of hairs of the page and of the look. A page of more than 15 MB has fewer, wider hairs. Raises
    UserError for a file that cannot be read, and for an output that is not HTML.
    """
    file, output = Path(file), Path(output)
    if output.suffix != ".html":
        raise UserError(f"{output}: is no page; give a name that ends with .html")
    if not file.is_file():
        raise UserError(f"{file}: there is no such file; give a recipe or a USD file with hair")
    file = file.resolve()
    project = Project(file.parent)
    page = make_page(look_messages(file), file.name, view or {}, review_of(file, project), live_rigs_of(project)[0])
    with replacing(output) as aside:
        aside.write_text(page.text, encoding="utf-8")
    return {"hairs": page.hairs, "of": page.of}


def look_messages(file: Path) -> dict[str, bytes]:
    """Messages of the review with the look of a file."""
    publisher = Publisher()
    viewport = Viewport(publisher)
    if file.suffix in USD:
        bodies, display = read_scene(file)
        viewport.stage(display, bodies)
    else:
        evaluator = GroomEvaluator(Project(Path(file.anchor)))
        viewport.show(evaluator.groom(read_recipe(file), draft=False, check_abort=lambda: None), "a")
    return publisher.retained()


def make_page(
    retained: Mapping[str, bytes],
    name: str,
    view: Mapping[str, Any],
    review: Mapping[str, Any] | None = None,
    rigs: Mapping[str, Rig] | None = None,
    most: int = MOST,
) -> SharePage:
    """The page of a look.

    retained: messages of the review, by subject
    name:     name of its file
    view:     how it is first seen
    review:   ``snapshots`` and ``notes`` that the page shows
    rigs:     lights that it offers; by default those without files
    most:     largest size [bytes]

    Raises UserError for a look that does not fit.
    """
    messages = {subject: data for subject, data in retained.items() if subject.startswith(SHARED)}
    if "a/hairs" not in messages:
        raise UserError("share: the groom is still being made; wait until it is shown")
    of = split(messages["a/hairs"])[0]["count"]

    lights = {light: rig.model_dump() for light, rig in (rigs or live_rigs()).items()}

    def page(kept: int) -> SharePage:
        shown = messages if kept == of else {each: _first_hairs(data, of, kept) for each, data in messages.items()}
        facts = {"view": dict(view), "hairs": kept, "of": of, "rigs": lights, **(review or {})}
        return SharePage(_page(list(shown.values()), name, facts), kept, of)

    made = page(of)
    if len(made.text) > most:
        without = len(page(1).text)  # of all but the hairs
        made = page(max(1, int(MARGIN * of * (most - without) / (len(made.text) - without))))
    if len(made.text) > most:
        raise UserError(f"share: {name} does not fit into {most / 1e6:g} MB; share fewer locks, or a coarser head")
    return made


def _first_hairs(data: bytes, of: int, kept: int) -> bytes:
    """A message with the first hairs, which cover all locks evenly, and are wider by as much as fits."""
    header, arrays = split(data)
    if header["kind"] not in ("hairs", "colors"):
        return data
    cut: dict[str, NDArray] = {
        name: values[: len(values) // of * kept] if name in EACH else values for name, values in arrays.items()
    }
    if header["kind"] == "hairs":
        header["count"] = kept
        cut["width"] = cut["width"] * np.float32(min(WIDEST, of / kept))
    return join(header, cut)


def _page(messages: list[bytes], name: str, known: dict[str, Any]) -> str:
    data = b"".join(struct.pack("<I", len(message)) + message for message in messages)
    about = {
        "name": name.split(".")[0],
        "file": name,
        "colors": display_colors.named(),
        **known,
    }
    script, style = (_built(f"share.{kind}") for kind in ("js", "css"))
    script = script.replace("</script", "<\\/script")
    facts = json.dumps(about).replace("<", "\\u003c")
    look = base64.b64encode(gzip.compress(data, 9, mtime=0)).decode()
    title = html.escape(name.split(".")[0])
    return f"""<!doctype html>
<html lang="en" data-theme="dark">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<meta http-equiv="Content-Security-Policy" content="{POLICY}">
<title>{title}</title>
<style>{style}</style>
</head>
<body>
<noscript>This page shows {title} with JavaScript.</noscript>
<div id="app"></div>
<script type="application/json" id="about">{facts}</script>
<script type="text/plain" id="look">{look}</script>
<script>{script}</script>
</body>
</html>
"""


def _built(name: str) -> str:
    try:
        return (STATIC / name).read_text(encoding="utf-8")
    except OSError:
        raise UserError(f"{STATIC}: the page was not built; build it with: make build") from None
