"""Share pages: one file that holds the look and loads nothing."""

from __future__ import annotations

import base64
import gzip
import json
import re
import struct
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from pages import page, serving
from PIL import Image
from ringlet.data.errors import UserError
from ringlet.viewer.keep.share_page import look_messages, make_page
from ringlet.viewer.wire import split

import ringlet


def held(text: str) -> dict[str, dict[str, Any]]:
    """Messages in a page, by kind; of bodies, the last."""
    (packed,) = re.findall(r'id="look">([^<]+)<', text)
    data, found = gzip.decompress(base64.b64decode(packed)), {}
    while data:
        (size,) = struct.unpack_from("<I", data)
        header, arrays = split(data[4 : 4 + size])
        found[header["kind"]] = {**header, **arrays}
        data = data[4 + size :]
    return found


def about(text: str) -> dict[str, Any]:
    """What a page knows of its look."""
    return json.loads(re.findall(r'id="about">([^<]+)<', text)[0])


def test_a_share_page_holds_the_look_and_loads_nothing(folder: Path, tmp_path: Path):
    output = tmp_path / "look.html"
    made = ringlet.share(folder / "small.recipe.toml", output)
    text = output.read_text()
    look = held(text)
    assert look["hairs"]["count"] == made["hairs"] == made["of"] > 0
    assert len(look["locks"]["ids"]) == 8 and len(look["body"]["points"]) > 0
    assert "default-src 'none'" in text and about(text)["snapshots"] == about(text)["notes"] == []
    assert not re.findall(r"""<(?:script|link|img|iframe)[^>]+(?:src|href)=""", text)


def test_a_page_that_is_too_large_has_fewer_wider_hairs_of_all_locks(folder: Path):
    recipe = folder / "small.recipe.toml"
    recipe.write_text(recipe.read_text().replace("per_lock = 3", "per_lock = 300"))
    retained = look_messages(recipe)
    whole = make_page(retained, "a <b>.recipe.toml", {})
    most = len(whole.text) - 40_000
    small = make_page(retained, "a", {}, most=most)
    assert 0 < small.hairs < whole.hairs == small.of and len(small.text) <= most
    few, all_ = held(small.text)["hairs"], held(whole.text)["hairs"]
    assert few["count"] == small.hairs == len(few["lock"]) and len(few["root"]) == 3 * small.hairs
    assert set(few["lock"].tolist()) == set(all_["lock"].tolist())
    widened = few["width"] / all_["width"][: small.hairs]
    assert np.allclose(widened, min(2.0, whole.hairs / small.hairs))
    assert "<b>" not in whole.text.split("</title>")[0]
    assert about(small.text)["hairs"] == small.hairs
    with pytest.raises(UserError, match="does not fit"):
        make_page(retained, "a", {}, most=1000)


def test_a_share_page_has_the_snapshots_and_the_open_notes_of_the_review(folder: Path, tmp_path: Path):
    kept = folder / "small.review"
    look = (
        'camera = [0.0, 0.0, 1.0, 0.0, 0.0, 0.0]\nlight = ""\ncolor = ""\noverlay = ""\nfile = "recipe"\nplace = []\n'
    )
    for name, text in {
        "snapshots/1": 'note = "wider"\nauthor = "Ann"\ntime = "2026-01-02T03:04:05+00:00"\n',
        "notes/1": 'text = "too <dark>"\nauthor = "Bo"\n',
        "notes/2": 'text = "done"\nresolved = true\n',
    }.items():
        (kept / name).parent.mkdir(parents=True, exist_ok=True)
        (kept / f"{name}.toml").write_text(f"ringlet = 2\n{text}[look]\n{look}\nlocks = []\n")
    Image.new("RGB", (4, 4)).save(kept / "snapshots/1.png")
    ringlet.share(folder / "small.recipe.toml", tmp_path / "look.html")
    found = about((tmp_path / "look.html").read_text())
    (snapshot,), (note,) = found["snapshots"], found["notes"]
    assert (snapshot["author"], snapshot["text"]) == ("Ann", "wider")
    assert snapshot["picture"].startswith("data:image/png;base64,")
    assert (note["text"], note["camera"]) == ("too <dark>", [0, 0, 1, 0, 0, 0])


def test_a_page_of_the_review_asks_for_a_share_page(folder: Path):
    view = {"camera": [0.0, 0.0, 1.0, 0.0, 0.0, 0.0], "light": "studio", "color": "", "theme": "light"}
    with serving(folder) as client, page(client, "one") as one, page(client, "two") as two:
        one.receive("numbers", draft=False)
        two.send(kind="share", **view)  # also one that does not edit
        made = two.receive("share_page")
        assert made["name"] == "small.html"
        text = made["text"].tobytes().decode()
        assert about(text)["view"] == view


@pytest.mark.parametrize(
    "name, output, words",
    [("small.recipe.toml", "look.png", "ends with .html"), ("none.toml", "a.html", "no such file")],
)
def test_what_cannot_be_shared_is_refused(folder: Path, tmp_path: Path, name: str, output: str, words: str):
    with pytest.raises(UserError, match=words):
        ringlet.share(folder / name, tmp_path / output)
    assert not (tmp_path / output).exists()
