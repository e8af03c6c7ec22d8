"""The review page shows all grooms of a recipe, and changes the settings of the one that is chosen."""

from __future__ import annotations

import numpy as np
import pytest
from pages import page, serving
from test_several_grooms import SEVERAL

import ringlet
from ringlet.groom import grooms_of, lay_hairs, make_hairs


@pytest.fixture
def project(folder):
    (folder / "several.recipe.toml").write_text(SEVERAL)
    return folder


def test_all_grooms_are_shown_with_their_own_hairs_and_colors(project):
    with serving(project, "several.recipe.toml") as client, page(client) as one:
        document = one.receive("document")
        assert document["grooms"] == ["hair", "brows"] and document["groom"] == "hair"
        hairs, locks = one.receive("hairs"), one.receive("locks")
        assert len(locks["ids"]) == 38 and len(np.unique(locks["ids"])) == 38
        made = ringlet.build_groom(project / "several.recipe.toml")
        assert hairs["count"] == len(make_hairs(made).curves) == len(hairs["group"])
        assert len(hairs["profile"]) == 2 * hairs["points"]
        assert set(hairs["lock"][hairs["group"] == 1]) == set(range(8, 38))
        colors = one.latest("colors")
        lightness = colors["reflectance"].reshape(hairs["count"], -1).mean(axis=1)
        assert lightness[hairs["group"] == 1].max() < lightness[hairs["group"] == 0].mean()


def test_hairs_on_the_page_are_those_of_each_groom(project):
    made = ringlet.build_groom(project / "several.recipe.toml")
    shown = lay_hairs(made)
    layout = shown.deformation(made.scalp.points)
    for row, (name, one) in enumerate(grooms_of(made).items()):
        alone = make_hairs(one).curves
        own = shown.members[name].curves
        assert (own.ids == alone.ids).all()
        of = layout["group"] == row
        np.testing.assert_array_equal(layout["tip"][of], shown.members[name].deformation(made.scalp.points)["tip"])
    points = shown.deformed(made.locks.points, made.scalp.points)
    roots = points[shown.curves.offsets[:-1]]
    np.testing.assert_allclose(roots, make_hairs(made).curves.roots, atol=1e-5)


def test_the_chosen_groom_is_changed_and_no_other(project):
    with serving(project, "several.recipe.toml") as client, page(client) as one:
        before = one.receive("locks")
        one.receive("numbers")
        one.send(kind="choose", groom="brows")
        document = one.receive("document", groom="brows")
        assert document["values"]["locks"]["count"] == 30 and document["said"]["guides"]["count"] == 10
        one.receive("numbers")
        one.send(kind="set", changes=[[["guides", "length"], 2.0]], gesture=1)
        assert one.receive("document", dirty=True)["values"]["guides"]["length"]["value"] == pytest.approx(0.02)
        after = one.receive("locks", draft=False)
        kept = slice(0, 3 * before["offsets"][8])
        assert (after["points"][kept] == before["points"][kept]).all()
        assert np.abs(after["points"] - before["points"]).max() > 0.005
        one.receive("numbers")
        one.send(kind="arrange", action="add", at=0, to=0, op="smooth")
        assert [stage["name"] for stage in one.receive("document", dirty=True)["stages"]][:3] == [
            "guides",
            "locks",
            "smooth",
        ]
        one.receive("numbers")
        one.send(kind="save")
        one.receive("saved")
    read = ringlet.read_recipe(project / "several.recipe.toml")
    assert read.grooms["brows"].guides.length.value == pytest.approx(0.02)
    assert [operator.op for operator in read.grooms["brows"].shape] == ["smooth"] and not read.grooms["hair"].shape


def test_what_the_page_cannot_do_with_several_grooms_is_said(project):
    with serving(project, "several.recipe.toml") as client, page(client) as one:
        one.receive("numbers")
        one.send(kind="choose", groom="brow")
        assert "brow is not a groom of the recipe; did you mean 'brows'?" in one.receive_trouble()
        one.send(kind="unsculpt")
        assert "has several grooms" in one.receive_trouble()
