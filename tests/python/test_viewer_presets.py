"""Presets in the review: tried without a trace, taken as one undo step, mixed, and kept as files."""

from __future__ import annotations

import base64
import io
import tomllib
from pathlib import Path

import numpy as np
import pytest
from pages import page, serving
from PIL import Image
from ringlet.data.lengths import UNITS
from ringlet.data.quantities import along
from ringlet.data.share import share
from ringlet.viewer.files.mixing import mix, stated
from ringlet.viewer.files.presets import LOOK, looks

from ringlet.groom import Recipe, parse_recipe, read_recipe

PRESET = """# Wide curls. A second sentence.
ringlet = 2

[curl]
width = 2.0
pitch = 2.5
"""


def test_a_tried_preset_leaves_no_trace_and_a_taken_one_is_one_undo_step(folder: Path):
    (folder / "wide.preset.toml").write_text(PRESET)
    before_text = (folder / "small.recipe.toml").read_text()
    with serving(folder) as client, page(client) as one:
        first = one.receive("locks", draft=False)["points"]
        one.receive("numbers")
        one.send(kind="list_presets")
        own = one.receive("presets")["presets"][0]
        assert (own["title"], own["about"], own["whole"]) == ("wide", "Wide curls.", False)
        one.send(kind="try", name="wide.preset.toml")
        tried = one.receive("locks", draft=True)["points"]
        assert np.abs(tried - first).max() > 0.003
        one.send(kind="try")
        assert np.allclose(one.receive("locks", draft=False)["points"], first)
        assert not one.latest("document")["undo"] and one.latest("document")["text"] == before_text
        for part in (0.25, 0.75, 0.5):
            one.send(kind="take", name="wide.preset.toml", part=part, gesture=7)
            document = one.receive("document")
        assert tomllib.loads(document["text"])["curl"] == {"width": 1.5, "pitch": 2.0}
        one.send(kind="undo")
        document = one.receive("document")
        assert document["text"] == before_text and not document["undo"]
        one.send(kind="take", name="wide.preset.toml", gesture=8)
        assert tomllib.loads(one.receive("document")["text"])["curl"] == {"width": 2.0, "pitch": 2.5}
    assert (folder / "small.recipe.toml").read_text() == before_text


def test_a_mix_after_another_edit_starts_from_that_edit(folder: Path):
    (folder / "wide.preset.toml").write_text(PRESET)
    with serving(folder) as client, page(client) as one:
        one.receive("numbers")
        one.send(kind="take", name="wide.preset.toml", gesture=7)
        one.receive("document", dirty=True)
        one.send(kind="set", changes=[[["locks", "points"], 48]], gesture=8)
        one.receive("document")
        one.send(kind="take", name="wide.preset.toml", part=1.0, gesture=7)
        assert tomllib.loads(one.receive("document")["text"])["locks"]["points"] == 48


def test_settings_are_kept_as_a_preset_with_its_picture(folder: Path):
    picture = io.BytesIO()
    Image.new("RGB", (8, 9)).save(picture, "JPEG")
    url = "data:image/jpeg;base64," + base64.b64encode(picture.getvalue()).decode()
    with serving(folder) as client, page(client) as one:
        one.receive("numbers")
        one.send(kind="keep", name="mine", tables=["curl"], picture=url)
        kept = one.receive("presets")["presets"][0]
        assert kept["name"] == "mine.preset.toml" and kept["picture"] == url
        assert tomllib.loads((folder / "mine.preset.toml").read_text()) == {
            "ringlet": 2,
            "curl": {"width": 1.0, "pitch": 1.5},
        }
        one.send(kind="keep", name="mine", tables=["curl"])
        assert "is there already" in one.receive_trouble()
        one.send(kind="keep", name="../mine", tables=["curl"])
        assert "without a folder" in one.receive_trouble()
        one.send(kind="keep", name="other", tables=["curl"], picture="data:text/html,<p>")
        assert "no JPEG" in one.receive_trouble() and not (folder / "other.preset.toml").exists()
        (folder / "bad.preset.toml").write_text("ringlet = 2\n[scalp]\nregion = 'nape'\n")
        one.send(kind="try", name="bad.preset.toml")
        assert one.receive_trouble().startswith("bad.preset.toml: scalp is not a table of a preset")


def test_whole_looks_replace_all_tables_of_a_recipe_and_of_one_that_extends_another(folder: Path):
    assert len(looks()) > 20 and all(look.about for look in looks())
    (folder / "variant.recipe.toml").write_text(
        'ringlet = 2\nextends = "small.recipe.toml"\n[curl]\nwidth = 0.7 # own\n'
    )
    look = next(one for one in looks() if one.name == "looks/two_strand_twists")
    wanted = read_recipe(look.file)
    for file in ("small.recipe.toml", "variant.recipe.toml"):
        with serving(folder, file) as client, page(client) as one:
            one.receive("numbers")
            one.send(kind="take", name=look.name, gesture=1)
            text = one.receive("document")["text"]
        taken = parse_recipe(text, folder / file)
        assert taken.scalp.file == "head.usda" or taken.scalp_file == folder / "head.usda"
        for name in LOOK:
            assert getattr(taken, name) == getattr(wanted, name), (file, name)


def test_numbers_and_ramps_interpolate_and_operators_fade():
    a, b = (read_recipe(share("examples") / name) for name in ("child/curls.recipe.toml", "types/3A.recipe.toml"))
    assert a.curl and b.curl
    half = mix(a, b, 0.5, LOOK)
    assert half.curl and half.curl.width.value == pytest.approx(0.5 * (a.curl.width.value + b.curl.width.value))
    ends = [np.array(one.curl.width.ramp) for one in (a, b)]
    at_ends = np.unique(np.concatenate([end[:, 0] for end in ends]))
    mean = np.mean([along(one.curl.width.ramp, at_ends) for one in (a, b)], axis=0)
    assert np.allclose(along(half.curl.width.ramp, at_ends), mean)
    assert half.locks.count == round(0.5 * (a.locks.count + b.locks.count))
    alone = [one.op for one in a.shape if one.op not in {other.op for other in b.shape}]
    quarter = mix(a, b, 0.25, LOOK)
    assert alone and all(one.blend == 0.75 for one in quarter.shape if one.op in alone)


def test_stated_settings_are_read_back_as_they_were():
    for file in sorted((share("examples") / "looks").glob("*.recipe.toml")):
        recipe = read_recipe(file)
        if recipe.grooms:
            continue
        tables = {name: value for name in LOOK if (value := getattr(recipe, name)) is not None}
        said = {
            name: [stated(one, "cm") for one in value] if isinstance(value, list) else stated(value, "cm")
            for name, value in tables.items()
        }
        back = Recipe.model_validate({"ringlet": 2, **said}, context={"unit": UNITS["cm"]})
        for name in LOOK:
            _assert_alike(_dumped(getattr(back, name)), _dumped(getattr(recipe, name)), f"{file.name} {name}")


def _dumped(value):
    return [one.model_dump() for one in value] if isinstance(value, list) else value and value.model_dump()


def _assert_alike(a, b, where):
    if isinstance(a, dict):
        for name in a.keys() - {"preset"}:
            _assert_alike(a[name], b[name], f"{where}.{name}")
    elif isinstance(a, list | tuple):
        for one, other in zip(a, b, strict=True):
            _assert_alike(one, other, where)
    else:
        assert a == (pytest.approx(b, rel=1e-4) if isinstance(b, float) else b), where
