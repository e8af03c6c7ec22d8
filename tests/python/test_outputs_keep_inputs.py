"""No output replaces what a command reads, whatever links lead there."""

from __future__ import annotations

import os

import pytest
from commands import edit, made, refused, run
from pxr import Usd, UsdGeom
from ringlet.data.reads import recorded, unrecorded

import ringlet
from ringlet import io


@pytest.fixture
def linked(copy, monkeypatch):
    """The small example with groom, cache and hairs; each file has a symbolic link s_NAME and a hard link h_NAME."""
    (copy / "skin.usda").write_bytes((copy / "head.usda").read_bytes())
    head = Usd.Stage.CreateNew(str(copy / "layered.usda"))  # the head is a sublayer here
    head.GetRootLayer().subLayerPaths.append("skin.usda")
    UsdGeom.SetStageMetersPerUnit(head, 0.01)
    head.Save()
    groom = made(copy)
    ringlet.write_simulation(
        ringlet.read_shot(copy / "small.shot.toml"),
        ringlet.read_groom(groom),
        groom,
        copy / "cache.usdc",
        checkpoints=copy / "part",
    )
    ringlet.write_hairs(groom, copy / "hair.usdc", cache=copy / "cache.usdc")
    for path in list(copy.glob("*.usd?")):
        path.with_name(f"s_{path.name}").symlink_to(path.name)
        os.link(path, path.with_name(f"h_{path.name}"))
    os.link(copy / "hair.usdc", copy / "hair.png")
    for kind in ("s", "h"):
        recipe = (copy / "small.recipe.toml").read_text()
        (copy / f"{kind}.recipe.toml").write_text(recipe.replace("head.usda", f"{kind}_head.usda"))
        (copy / f"{kind}_layered.recipe.toml").write_text(recipe.replace("head.usda", f"{kind}_layered.usda"))
    monkeypatch.chdir(copy)
    return copy


@pytest.mark.parametrize("kind", ["s", "h"])
@pytest.mark.parametrize(
    ("command", "target"),
    [
        ("groom {}.recipe.toml -o", "head.usda"),
        ("groom {}_layered.recipe.toml -o", "skin.usda"),
        ("groom {}_layered.recipe.toml -o", "{}_skin.usda"),
        ("sim small.shot.toml --groom {}_groom.usdc -o", "groom.usdc"),
        ("sim small.shot.toml --groom {}_groom.usdc -o", "head.usda"),
        ("sim small.shot.toml --groom groom.usdc -o", "{}_groom.usdc"),
        ("sim small.shot.toml --groom groom.usdc -o new.usdc --contacts", "{}_head.usda"),
        ("hair {}_groom.usdc --cache {}_cache.usdc -o", "cache.usdc"),
        ("hair groom.usdc --cache cache.usdc -o", "{}_groom.usdc"),
        ("hair {}_cache.usdc -o", "head.usda"),
        ("check {}_groom.usdc --fix -o", "groom.usdc"),
        ("check groom.usdc --fix -o", "{}_head.usda"),
        ("loft small.shot.toml --groom {}_groom.usdc --again -o", "groom.usdc"),
        ("picture h_hair.usdc --width 16 --height 16 --samples 1 -o", "hair.png"),
    ],
)
def test_an_input_is_not_replaced_through_a_link(linked, kind, command, target):
    shot = linked / "small.shot.toml"
    shot.write_text(shot.read_text() + "[contact]\n")
    before = {path: (path.read_bytes(), path.is_symlink()) for path in linked.iterdir() if path.is_file()}
    target = target.format(kind)
    refused(run(*command.format(kind, kind).split(), target), target, "choose another name")
    assert {path: (path.read_bytes(), path.is_symlink()) for path in linked.iterdir() if path.is_file()} == before


def test_outputs_of_one_command_may_follow_each_other(copy):
    with ringlet.recorded():
        groom = ringlet.read_groom(made(copy))
        for _ in range(2):  # what a command wrote is no input, even when it reads it again
            ringlet.write_groom(groom, copy / "again.usdc")
            groom = ringlet.read_groom(copy / "again.usdc")


def test_files_that_are_written_anew_may_be_read_first(copy):
    recipe = edit(copy / "small.recipe.toml", "ringlet = 2", 'ringlet = 2\nedits = "small.edits.toml"')
    lock = int(ringlet.build_groom(recipe).locks.ids[0])
    for value in ("6 mm", "8 mm"):
        assert run("edit", recipe, "--set", f"{lock}:curl.width={value}").exit_code == 0
    shot = edit(copy / "small.shot.toml", "preroll = 0", 'preroll = 0\n[rest]\nmode = "lofted"')
    for _ in range(2):  # the second takes over what has not changed
        assert run("loft", shot).exit_code == 0


def test_layers_of_a_stage_are_recorded_and_only_inside_of_blocks(linked):
    with recorded() as read:
        io.read_mesh("layered.usda")
        with unrecorded():
            io.read_mesh("head.usda")
    io.read_groom("groom.usdc")
    assert [name for name, _ in read.contents()] == ["layered.usda", "skin.usda"]
    assert read.input_at("s_skin.usda") and not read.input_at("head.usda") and not read.input_at("nothing.usda")


def test_a_wedge_does_not_replace_the_shot_or_what_it_names(copy, monkeypatch):
    monkeypatch.chdir(copy)
    task = copy / "out/as-it-is"
    task.mkdir(parents=True)
    for link in ("shot.toml", "cache.usdc"):
        target = "small.shot.toml" if link == "shot.toml" else "chair.usda"
        (copy / "chair.usda").write_bytes((copy / "head.usda").read_bytes())
        os.link(copy / target, task / link)
        shot = copy / "small.shot.toml"
        text = shot.read_text()
        shot.write_text(f'{text}[contact]\n[[collider]]\nfile = "chair.usda"\n')
        refused(run("wedge", "small.shot.toml", "-o", "out", "--here", "--no-picture"), link, "choose another name")
        assert (task / link).samefile(copy / target)
        (task / link).unlink()
        shot.write_text(text)


def test_a_folder_with_other_files_takes_no_checkpoints(copy):
    (copy / "cache.usdc.part").mkdir()
    note = copy / "cache.usdc.part/note.txt"
    note.write_text("mine")
    refused(run("sim", copy / "small.shot.toml", "-o", copy / "cache.usdc"), "note.txt, which is no checkpoint")
    assert note.read_text() == "mine"
