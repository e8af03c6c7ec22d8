"""The Blender extension: what of it needs no Blender, and its work in Blender as its buttons do it."""

from __future__ import annotations

import importlib
import sys
import types
import zipfile
from pathlib import Path

import blender
import numpy as np
import pytest
from ringlet.data.names import file_name, folded
from ringlet.data.pigment import absorption
from similar_names import SIMILAR
from wheels import NEEDED, wheel_of_needed, wheel_of_ringlet

import ringlet

needs_blender = pytest.mark.skipif(not blender.PYTHON.exists(), reason=blender.MISSING)
edited_text = blender.load(blender.EXTENSION / "edited_text.py")


@pytest.fixture(scope="module")
def extension(tmp_path_factory) -> Path:
    return blender.build_extension(tmp_path_factory.mktemp("extension"))


@pytest.fixture(scope="module")
def schema(extension):
    """The module ``schema`` of the built extension."""
    with zipfile.ZipFile(extension) as file:
        file.extractall(extension.parent / "ringlet_groom")
    return blender.load(extension.parent / "ringlet_groom/schema.py")


@pytest.fixture(scope="module")
def folders(extension):
    """The module ``folders`` of the built extension."""
    with zipfile.ZipFile(extension) as file:
        file.extractall(extension.parent / "ringlet_groom")
    package = types.ModuleType("ringlet_groom")  # without its own module, which needs Blender
    package.__path__ = [str(extension.parent / "ringlet_groom")]
    sys.modules["ringlet_groom"] = package
    return importlib.import_module("ringlet_groom.folders")


@pytest.fixture
def act(extension, tmp_path):
    """Works in Blender with the extension installed; ``ringlet`` is on the PATH."""
    folder = tmp_path / "work"
    folder.mkdir()
    ringlet_folder = str(Path(sys.executable).parent)

    def acted(action: str) -> dict:
        return blender.run(
            "in_blender_extension.py",
            tmp_path / "found.json",
            extension,
            action,
            folder,
            PATH=ringlet_folder,
            OMP_NUM_THREADS="1",
            BLENDER_USER_RESOURCES=str(tmp_path / "user"),
        )

    return acted


def test_of_several_changes_of_a_setting_the_last_stays():
    changes = ""
    for value in (1.0, 1.1, 1.2):
        changes = edited_text.with_change(changes, {"set": ["curl", "width", "value"], "value": value})
    changes = edited_text.with_change(changes, {"set": ["seed"], "value": 4})
    assert edited_text.pending(changes, ("curl", "width", "value")) == 1.2
    assert len(edited_text.json.loads(changes)) == 2
    assert edited_text.pending(changes, ("curl", "pitch", "value")) is edited_text.MISSING


def test_changes_before_a_move_of_operators_keep_their_rows():
    changes = edited_text.with_change("", {"set": ["shape", 0, "amount"], "value": 1})
    changes = edited_text.with_change(changes, {"move": "shape", "at": 0, "to": 1})
    changes = edited_text.with_change(changes, {"set": ["shape", 0, "amount"], "value": 2})
    assert len(edited_text.json.loads(changes)) == 3
    assert edited_text.pending(changes, ("shape", 0, "amount")) == 2
    assert edited_text.pending(changes, ("shape", 1, "amount")) is edited_text.MISSING


def test_every_value_of_a_recipe_is_a_setting_with_its_bounds(schema):
    settings = {one.place: one for one in schema.sections("recipe")["curl"][1]}
    width = settings["width", "value"]
    assert (width.kind, width.unit, width.least, width.most) == ("number", "m", 0.0, 0.2)
    assert settings["width", "ramp"].of == ("width", "value")
    assert settings["preset",].choices[:3] == ("", "1", "2A")
    numbers = [name for name, one in ringlet.schema()["recipe"]["$defs"]["Curl"]["properties"].items() if "unit" in one]
    places = {place[0] for place in settings}
    assert set(numbers) <= places
    assert {"braid", "clump", "frizz", "tie"} <= schema.operators().keys()
    assert [one for one in schema.operators()["clump"][1] if one.place == ("tightness", "value")]


def test_every_table_of_a_shot_is_a_section_but_lists(schema):
    shot = ringlet.schema()["shot"]
    lists = {name for name, entry in shot["properties"].items() if entry.get("type") == "array"}
    tables = {name for name, entry in shot["properties"].items() if "$ref" in str(entry)} - lists
    assert set(schema.SECTIONS["shot"]) == tables
    settings = {one.place: one for one in schema.sections("shot")["motion"][1]}
    assert settings["bounce", "value"].default is None and settings["bounce", "of_hair"].kind == "boolean"
    assert settings["weight", "ramp"].of == ("weight", "value")


def test_the_pigments_of_cycles_absorb_as_those_of_ringlet():
    """Absorption of Cycles for concentrations of eumelanin and pheomelanin, from its source."""
    source = (blender.EXTENSION / "material.py").read_text().replace("import bpy\n", "").split("def with_pigments")[0]
    module: dict = {}
    exec(source, module)
    melanin, redness = np.array([0.1, 0.5, 0.9, 0.99]), np.array([0.0, 0.3, 0.9, 0.1])
    ours, red = module["cycles_melanin"](melanin, redness)
    amount = -np.log(1.0 - ours.astype(np.float64))[:, None]
    dark, reddish = amount * (1.0 - red[:, None]), amount * red[:, None]
    cycles = dark * [0.506, 0.841, 1.653] + reddish * [0.343, 0.733, 1.924]
    np.testing.assert_allclose(cycles, absorption(melanin, redness), rtol=5e-3)


def test_each_text_keeps_its_stem_and_the_number_that_blender_adds():
    names = ["Kim.recipe.toml", "Kim.recipe.toml.001", "Kim.shot.toml", "Kim.toml", "Kim"]
    assert [edited_text.stem_of(name) for name in names] == ["Kim", "Kim.001", "Kim", "Kim", "Kim"]


@pytest.mark.parametrize("one, other", SIMILAR)
def test_heads_of_similar_names_have_folders_of_their_own(folders, one, other):
    ids = [folders.new_id(one), folders.new_id(other), folders.earlier_id(one), folders.earlier_id(other)]
    assert len({folded(id) for id in ids}) == 4
    assert all(id.isascii() and len(id) < 64 and file_name(id) == id for id in ids)
    assert folders.earlier_id(one) == ids[2]


def test_a_copy_of_a_head_is_distinguished_from_the_head(folders):
    def wrong(*claims, known=None, elsewhere=()):
        return folders.wrong_ids([folders.Claim(*one) for one in claims], known or {}, elsewhere)

    assert wrong((7, "a", False), (9, "b", False)) == []
    assert wrong((9, "a", False), (7, "a", False)) == [0]  # the later one
    assert wrong((9, "a", True), (7, "a", False)) == [1]  # as read from a file: the curves are below the first
    assert wrong((9, "a", False), (7, "a", True), known={9: "a"}) == [1]  # in this session the first had it
    assert wrong((7, "a", True), (9, "a", False), known={7: "a", 9: "b"}) == [1]  # undo took back its own
    assert wrong((7, "a", True), elsewhere={"a"}) == [0]  # an override of a head of a library
    assert wrong((7, "", False), (9, "", False)) == []


def test_the_folder_of_a_head_is_found_once_under_its_earlier_name_and_next_to_another_blend(folders, tmp_path):
    def project(stem, name, blend=True):
        (tmp_path / f"{stem}.ringlet" / name).mkdir(parents=True)
        (tmp_path / f"{stem}.ringlet" / name / "cache.usdc").write_text(stem)
        if blend:
            (tmp_path / f"{stem}.blend").touch()

    project("old", "Kim")
    place = tmp_path / "old.ringlet/Kim-1"
    for _ in range(2):
        folders.find(place, "Kim")
        assert (place / "cache.usdc").read_text() == "old" and not (place.parent / "Kim").exists()
    (place / "cache.usdc.part").mkdir()
    copied = tmp_path / "version.ringlet/Kim-1"
    folders.find(copied)  # the .blend is there still
    assert [file.name for file in copied.iterdir()] == ["cache.usdc"] and (place / "cache.usdc").exists()
    (tmp_path / "old.blend").unlink()
    renamed = tmp_path / "new.ringlet/Kim-1"
    (tmp_path / "version.blend").touch()
    folders.find(renamed)  # the .blend of the folder "old" is gone
    assert (renamed / "cache.usdc").read_text() == "old" and not place.parent.exists()
    folders.find(tmp_path / "new.ringlet/Bo-2", "Bo")
    assert not (tmp_path / "new.ringlet/Bo-2").exists()
    copy = tmp_path / "new.ringlet/Kim-3"
    (renamed / "notes").write_text("kept")
    folders.copy(renamed, copy, folders.SIMULATED)
    assert [file.name for file in copy.iterdir()] == ["notes"]


@needs_blender
def test_a_groom_from_scratch_follows_a_slider_undo_and_redo(act):
    found = act("slider")
    assert found["message"] == "" and found["counts"]["locks"] == 24
    assert found["curves"] == [14, 24, found["counts"]["hairs"]]
    assert found["surface"] == "Kim" and found["material"] == "MELANIN"
    red, green, blue, opaque = found["viewport"]
    assert 0.3 > red > green > blue > 0.0 and opaque == 1.0 and found["subdivisions"] == 3
    assert found["all hairs"] == 24 * 8  # the fraction of the panel counts, though it was set during a groom
    assert found["roots"] < 0.005 and found["lowest root"] > -0.01  # on the facets of the vertex group
    assert found["length"] == pytest.approx(0.05) and found["after"] > found["before"] + 0.03
    assert "length = 10" in found["text"] and "# a cap of curls" in found["text"] and found["changes"] == ""
    assert found["undone"] == pytest.approx(found["before"], abs=1e-6)
    assert found["undone length"] == pytest.approx(0.05)
    assert found["redone"] == pytest.approx(found["after"], abs=1e-6) and not found["asked again"]
    assert "curl.width is 50 m; must be at most 0.2 m" in found["refused"]
    assert found["kept"] == pytest.approx(found["after"], abs=1e-6) and found["mended"] == ""
    assert found["dye"][0] == pytest.approx([1.0, 128 / 255, 0.0]) and '"#ff8000"' in found["dye"][1]
    assert found["dyed"] == "COLOR"
    assert "Kim: its modifiers number its vertices anew" in found["renumbered"]


@needs_blender
def test_a_groom_is_there_after_save_and_reload_and_without_the_extension(act):
    found = act("stored")
    assert found["after"] == pytest.approx(found["before"], abs=1e-6) and found["length"] == pytest.approx(0.1)
    assert found["slider"] < found["before"] - 0.03
    assert not found["property"]
    assert found["left"]["Kim locks"] == 24 and found["left"]["Kim guides"] == 14
    assert "length = 5" in found["recipe"][0]


@needs_blender
def test_a_shot_is_canceled_resumed_played_and_baked(act):
    found = act("shot")
    assert "Save the .blend first" in found["unsaved"] or "save it first" in found["unsaved"]
    assert found["stage"] == "Simulating" and found["left"] > 0
    assert found["canceled"] == "" and found["message"] == "" and found["baked"] == ""
    for name in ("lock_motion", "hair_motion"):
        np.testing.assert_allclose(found[name], [0.03, 0, 0], atol=1e-4)
    assert found["cleared"] == [0, False]


@needs_blender
def test_cloth_of_a_collection_is_simulated_and_plays_in_the_blend(act):
    found = act("cloth")
    assert found["message"] == "" and found["copies"] == ["Silk sheet simulated"]
    for start, end in found["runs"]:
        np.testing.assert_allclose(start[0], 0.26, atol=1e-3)  # raised by its modifier
        np.testing.assert_allclose(end[0], start[0], atol=2e-3)
        fall = np.subtract(start[1], end[1])
        assert fall.min() > 0.02 and fall.max() < 1.5 * 0.5 * 9.81 * (3 / 24) ** 2  # of a free edge: a hinged plate
    np.testing.assert_allclose(found["runs"][1], found["runs"][0], atol=1e-5)
    np.testing.assert_allclose(found["opened"], found["runs"][1][1][1], atol=1e-6)
    assert found["hidden"] == [True, True] and found["vertices"][0] > found["vertices"][1]
    assert found["cleared"] == [0, 0] and found["shown"] == [True, True]
    assert found["meshes"] == ["Kim", "Silk sheet"]


@needs_blender
def test_locks_grow_where_an_image_is_painted(act):
    found = act("images")
    assert found["left"][0] >= 390 and found["right"][1] >= 390  # pixels on both sides of the edge are mixed
    thick, thin = found["both"]
    assert thick + thin == 400 and 2.5 < thick / thin < 6
    assert found["message"] == "" and found["dirty"] and found["file"] == ""
    assert "Nowhere: has no pixels" in found["refused"] and found["mended"]


@needs_blender
def test_heads_of_similar_names_and_copies_of_heads_are_grooms_of_their_own(act):
    found = act("heads")
    assert max(found["alike"]) < 1e-4 and found["lengths"] == pytest.approx([0.06, 0.09])
    assert found["renamed"] == ["", True] and found["materials"] == ["Bo.1 hair", "Bo_1 hair"]
    for copy in found["copies"]:
        assert max(copy["off"]) < 1e-4 and copy["lengths"] == pytest.approx([0.07, 0.03])
        assert copy["shared"] == [] and not copy["data"] and not copy["material"] and copy["message"] == ""
        assert "head.usdc" in copy["folder"]
        assert copy["undone"]  # undo leaves a copy its id
    assert found["texts"] == ["Bo.1.recipe.toml", "Bo_1.recipe.toml"]


@needs_blender
def test_a_simulated_head_plays_where_its_project_moves_and_says_what_is_missing(act):
    found = act("moved")
    assert found["baked"] == "" and all(path.startswith("//scene.ringlet/Kim-") for path in found["paths"])
    assert found["moved"] < 1e-4 and found["still"] < 1e-4
    assert "is missing; put it back" in found["missing"] and found["back"] == ["", pytest.approx(0.0, abs=1e-4)]
    assert found["saved as"] == ["version 2.ringlet"] * 2 and found["renamed"]
    assert found["folders"] == ["final.blend", "final.ringlet"]


@needs_blender
def test_a_linked_head_is_left_alone_and_its_override_has_hair_of_its_own(act):
    found = act("linked")
    assert found["heads"] == 0 and "kim.blend; change its hair there, or make a library override" in found["refused"]
    assert max(found["motion"], found["opened"]) < 1e-4 and found["length"] == pytest.approx(0.06)
    assert found["text"] and found["folder"] == "scene.ringlet"
    assert found["curves"] == ["Kim guides", "Kim hairs", "Kim locks", "Kim locks simulated"]


@needs_blender
def test_hair_of_two_rigged_characters_is_on_their_skin_before_and_after_it_is_simulated(act):
    found = act("production")
    assert found["names"] == ["Bo", "Kim"] and set(found["messages"]) == {""}
    for name in found["names"]:
        onto_skin, shape = found["rest"][name]
        assert onto_skin < 5e-4 and shape < 1e-6, found  # at rest the groom is as Ringlet made it
        for off_skin, from_finest in (*found["still"][name], *found["moving"][name]):
            assert off_skin < 1e-6 and from_finest < 3e-3, found  # the cage is 2.2 mm outside
    assert found["frame"] == 3.25  # reading the scene leaves the frame


@needs_blender
def test_heads_of_an_extension_without_ids_keep_their_frames(act):
    found = act("earlier")
    assert found["ids"][0] == found["ids"][1] and len(set(found["ids"][0])) == 3
    assert found["motion"] < 1e-4 and found["paths"] == [f"//scene.ringlet/{found['ids'][0][0]}/cache.usdc"]
    assert "Shared the folder Bo_1 with Bo_1" in found["note"] and "Kim" not in found["folders"]


@needs_blender
def test_a_killed_process_is_started_again_and_a_missing_one_is_a_line(act):
    found = act("killed")
    assert found["another"] and found["message"] == "" and found["size"] > 0.17
    assert "not installed" in found["missing"]


@needs_blender
def test_ringlet_is_installed_from_a_folder_of_wheels(act, tmp_path):
    folder = tmp_path / "work"
    (folder / "needed").mkdir()
    wheel_of_ringlet(folder)
    wheel_of_needed(folder / "needed")
    (folder / "python").write_text(sys.executable)
    found = act("install")
    assert "nowhere.whl: there is no such file" in found["no file"] and "Online access is off" in found["offline"]
    assert found["alone"][0].startswith("Installing Ringlet failed") and NEEDED in found["alone"][0]
    assert found["alone"][1:] == [False, None]
    assert found["together"][:2] == ["done", True]
    assert found["message"] == "" and found["locks"] == 24
    assert found["session"] == [ringlet.__version__, ""]
    module, place = found["where"]
    assert Path(module).is_relative_to(place)


@needs_blender
def test_sculpted_guides_maps_operators_and_variants(act):
    found = act("guides")
    assert found["sculpted"] > found["before"] + 0.015 and found["message"] == ""
    assert found["sculpting"]
    assert "guides.usdc" not in found["text"]  # the panel says where guides come from
    assert found["grown"] == pytest.approx(found["before"], abs=1e-6)
    assert found["operators"] == ["frizz"] and found["removed"] == []
    assert found["magnitude"] == pytest.approx(0.004) and found["map"] == ""
    variant = ringlet.read_groom(found["written"], variant="Kim")
    assert len(variant.locks) == 24
