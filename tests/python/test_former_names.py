"""Former names of settings: read in format 1, refused in format 2, and replaced by `ringlet upgrade`."""

from __future__ import annotations

import re
import tomllib
from pathlib import Path

import numpy as np
import pytest
from commands import edit, made, refused, run
from hypothesis import given
from hypothesis import strategies as st
from pxr import Sdf
from ringlet.data.former_names import RECIPE, RENAMES, FormerNames, present
from ringlet.data.random import Random
from ringlet.data.toml import to_toml
from ringlet.data.toml_keys import spans
from ringlet.data.upgrade import upgraded
from ringlet.groom.load import parse_edits
from shapes import ball
from small_example import write_example

import ringlet
from ringlet import UserError
from ringlet.groom import make_groom, make_hairs, parse_recipe


@pytest.fixture
def project(tmp_path) -> Path:
    return write_example(tmp_path)


ROOT = Path(__file__).parents[2]
LOCKS = "[guides]\ncount = 12\nlength = 6\n[locks]\ncount = 40\npoints = 24\nshape_points = 12\n"
ROWS = LOCKS.replace("points = 24", "points = 400") + "sections = { pattern = 'rows', size = 4, strands = 3 }\n"
NOISES = ("frizz", "noise", "scraggle")
LINE = "[curves.line]\npoints = [[1, 9, -6], [1, 9, 6]]\n"

# Recipes in which NAME stands for the former or the present name of a setting, by the place of the former one.
RECIPES = {
    "nail": LOCKS + "[[NAME]]\nfirm = 0.5\n",
    "pin.reach": LOCKS + "[[pin]]\nNAME = 2\n",
    "clean": LOCKS + "[NAME]\nmargin = 0.5\n",
    "pin.fade": LOCKS + "[[pin]]\nlength = 1\nNAME = 2\n",
    "guides.droop": LOCKS.replace("[locks]", "NAME = { value = 2, vary = 0.5 }\n[locks]"),
    "guides.zone.droop": LOCKS.replace("[locks]", "zone = [{ toward = [0, 0, 1], NAME = 3 }]\n[locks]"),
    "guides.part": LOCKS.replace("[locks]", "NAME = { falloff = 2 }\n[locks]"),
    "guides.part_line.line": LINE + LOCKS.replace("[locks]", "part_line = { NAME = 'line' }\n[locks]"),
    "guides.part_line.reach": LOCKS.replace("[locks]", "part_line.NAME = 2\n[locks]"),
    "locks.sections.partings": "[curves.line]\npoints = [[-9, 3, 0], [0, 9, 0], [9, 3, 0]]\n"
    + LOCKS
    + "[locks.sections]\npattern = 'drawn'\nNAME = 'line'\n",
    "shape.gather": LINE + LOCKS + "[[shape]]\nop = 'NAME'\ncurve = 'line'\n",
    "shape.loft": LOCKS + "[[shape]]\nop = 'NAME'\namount = { value = 0.5, vary = 0.5 }\n",
    "shape.tie.tie": LINE + LOCKS + "[[shape]]\nop = 'tie'\nNAME = 'line'\n",
    "shape.clump.amount": LOCKS + "[[shape]]\nop = 'clump'\nNAME = { value = 0.7, vary = 0.6 }\n",
    "shape.cornrow.droop": ROWS + "[[shape]]\nop = 'cornrow'\nwidth = 1\nNAME = { value = 4, vary = 0.5 }\n",
    "shape.part.parting": LOCKS + "[[shape]]\nop = 'part'\nNAME = { offset = 2 }\n",
    "shape.part.part_line.line": LINE + LOCKS + "[[shape]]\nop = 'part'\npart_line = { NAME = 'line' }\n",
    "shape.part.part_line.reach": LOCKS + "[[shape]]\nop = 'part'\npart_line = { NAME = 2 }\n",
    "shape.attract.reach": LINE + LOCKS + "[[shape]]\nop = 'attract'\ncurve = 'line'\nNAME = 6\n",
    **{
        f"shape.{op}.amount": LOCKS + f"[[shape]]\nop = '{op}'\nNAME = {{ value = 0.4, vary = 0.5 }}\nwavelength = 3\n"
        for op in NOISES
    },
    **{f"shape.{op}.size": LOCKS + f"[[shape]]\nop = '{op}'\nNAME = 3\n" for op in (*NOISES, "smooth")},
    "curl.phase_size": LOCKS + "[curl]\npreset = '3A'\nphase_spread = 1\nNAME = 5\n",
    "*.noise_size": LOCKS.replace("[locks]", "lift = { noise = 0.5, NAME = 5 }\n[locks]"),
    "guides.zone.spread": LOCKS.replace("[locks]", "zone = [{ toward = [0, 0, 1], lift = 0, NAME = 60 }]\n[locks]"),
    "shape.edges.gather": LOCKS + "[[shape]]\nop = 'edges'\nwithin = 9\nNAME = 0.9\n",
    **{
        f"shape.{op}.soft": LOCKS + f"[[shape]]\nop = '{op}'\nat = 2\nNAME = {{ value = 0.4, vary = 0.5 }}\n"
        for op in ("cut", "grow_to")
    },
    "locks.hairline.flat": LOCKS + "[locks.hairline]\nwidth = 3\nNAME = 0.8\n",
    "hairs.gather": LOCKS + "[hairs]\nNAME = 0.4\n",
    "shape.tie.spread": LOCKS + "[[shape]]\nop = 'tie'\ntoward = [0, 1, 0]\nNAME = { value = 4, vary = 0.5 }\n",
    "curl.phase_lock": LOCKS + "[curl]\npreset = '3A'\nNAME = { size = 3, cohesion = { value = 0.5, vary = 1 } }\n",
    **{
        f"hairs.{name}": LOCKS + f"[hairs]\nNAME = {{ value = {value}, vary = 0.5 }}\n"
        for name, value in {"radius": 0.3, "taper": 0.6, "flatness": 0.6, "stray_radius": 0.5}.items()
    },
    "hairs.spread": LOCKS + "[hairs]\nNAME = { value = 0.4, vary = 0.5 }\n",
    "hairs.families.amount": LOCKS + "[hairs.families]\nNAME = { value = 0.7, vary = 0.4 }\n",
    "hairs.families.size": LOCKS + "[hairs.families]\nNAME = { value = 0.05, vary = 0.4 }\n",
    "hairs.curl.alike": LOCKS + "[curl]\npreset = '3A'\n[hairs.families]\n[hairs.curl]\ndrift = 0.5\nNAME = 0.3\n",
    "hairs.coil.alike": LOCKS + "[hairs]\npoints = 400\n[hairs.families]\n[hairs.coil]\npitch = 2\nNAME = 0.3\n",
    "edit.move.reach": LOCKS + "[[edit]]\nlock = 1\nmove = [{ at = 0.5, by = [1, 0, 0], NAME = 0.3 }]\n",
    "curl.phase_alike": LOCKS + "[curl]\npreset = '3A'\nphase_spread = 1\nNAME = { value = 0.5, vary = 0.5 }\n",
    "*.mask.soft": LOCKS + "[[shape]]\nop = 'volume'\n[shape.mask]\nregion = 'scalp'\nNAME = 3\n",
}

SHOTS = {"contact.parting_speed": "[contact]\nNAME = 1e-3\n"}


def by(rename, name: str, version: int) -> str:
    return f"ringlet = {version}\n" + {**RECIPES, **SHOTS}[rename.place].replace("NAME", name)


def former(rename) -> str:
    return by(rename, rename.place.rpartition(".")[2], 1)


@pytest.mark.parametrize("rename", RECIPE, ids=lambda rename: rename.place)
def test_a_recipe_by_a_former_name_gives_the_same_groom_and_a_note(rename):
    with pytest.warns(FormerNames, match=re.escape(f"{rename.former} is now {rename.name}; ringlet upgrade")):
        old = parse_recipe(former(rename))
    new = parse_recipe(by(rename, rename.name, 2))
    assert old.model_dump() == new.model_dump()
    one, two = (make_groom(recipe, ball()) for recipe in (old, new))
    np.testing.assert_array_equal(one.locks.points, two.locks.points)
    np.testing.assert_array_equal(make_hairs(one).curves.points, make_hairs(two).curves.points)
    assert all(np.array_equal(one.locks.point[name], values) for name, values in two.locks.point.items())


@pytest.mark.parametrize("rename", RENAMES, ids=lambda rename: rename.place)
def test_a_former_name_is_replaced_in_the_text_alone(rename):
    text, found = upgraded("# Kept.\n" + former(rename) + "# The end, with 'NAME'.", "a.toml")
    assert tomllib.loads(text) == tomllib.loads(by(rename, rename.name, 2))
    assert text.startswith("# Kept.\nringlet = 2\n") and text.endswith("# The end, with 'NAME'.")
    assert [one.rename for one in found] == [rename]
    assert upgraded(text, "a.toml") == (text, [])


@pytest.mark.parametrize("rename", RENAMES, ids=lambda rename: rename.place)
def test_a_former_name_is_refused_in_format_2(rename):
    old = rename.place.rpartition(".")[2]
    with pytest.raises(UserError, match=rf"is a name of format 1, and {rename.name} that of format 2; rename it"):
        parse_recipe(by(rename, old, 2))


OPERATORS = ("shape.gather", "shape.loft")  # an entry has one of them


@pytest.mark.parametrize("rename", [one for one in RENAMES if one.place not in OPERATORS], ids=lambda one: one.place)
def test_a_setting_by_both_of_its_names_is_refused(rename):
    both = re.sub(r"^(.*NAME.*)$", "", by(rename, "NAME", 1), flags=re.MULTILINE)
    line = re.search(r"^(.*NAME.*)$", by(rename, "NAME", 1), re.MULTILINE)
    assert line is not None
    old = rename.place.rpartition(".")[2]
    if "{ NAME" in line[0] or ", NAME" in line[0]:
        inside = re.sub(r"NAME = ([^,}]+)", rf"{old} = \1, {rename.name} = \1", line[0])
        both = by(rename, "NAME", 1).replace(line[0], inside)
    elif line[0].startswith("["):
        rest = by(rename, "NAME", 1).partition(line[0])[2]
        both = by(rename, old, 1) + line[0].replace("NAME", rename.name) + rest
    else:
        both = by(rename, "NAME", 1).replace(line[0], "\n".join(line[0].replace("NAME", n) for n in (old, rename.name)))
    with pytest.raises(UserError, match=rf"has both {re.escape(rename.former)} and {rename.name}, which is its name"):
        parse_recipe(both)


TEXT = """\
# Curls that hang.  # not a 'key'
ringlet = 1 # version
name = "droop = 3 # not a setting"
clean.margin   =   "3 mm" # dotted

[curves.nail] # a name of its own
points = [[1, 9, -6], [1, 9, 6]]

[guides]	# a tab
"droop" = { value = 2, vary = 0.5, region = { droop = 3, soft = 4 } } # inline
zone = [
    { toward = [0, 0, 1], droop = 2 }, # droop
    { toward = [0, 1, 0], 'droop' = 3 },
]
part.reach = 4

[[nail]]
reach = 1

[nail.mask]
where = '''
x > 0'''
soft = 2 # cm

[[nail]]
mask = { soft = 1 }

[[shape]]
op = "clump"   # neighbours
amount = 0.5

[[shape]]
amount = 0.25
op = 'gather'
tie = "nail"

[[edit]]
lock = 3
set = { "clump.amount" = 0.1, "curl.phase_alike" = 1, "gather.off" = 3 }

[grooms.droop.clean]
margin = 1
[grooms.droop.guides]
droop = 1
"""


def test_an_upgrade_keeps_comments_order_and_names_that_users_chose():
    text, found = upgraded(TEXT, "a.recipe.toml")
    lines = dict(zip(text.splitlines(), TEXT.splitlines(), strict=True))
    assert {old: new for new, old in lines.items() if new != old} == {
        "ringlet = 1 # version": "ringlet = 2 # version",
        'clean.margin   =   "3 mm" # dotted': 'collide.margin   =   "3 mm" # dotted',
        '"droop" = { value = 2, vary = 0.5, region = { droop = 3, soft = 4 } } # inline': "gravity_bend = "
        "{ value = 2, vary = 0.5, region = { droop = 3, soft = 4 } } # inline",
        "    { toward = [0, 0, 1], droop = 2 }, # droop": "    { toward = [0, 0, 1], gravity_bend = 2 }, # droop",
        "    { toward = [0, 1, 0], 'droop' = 3 },": "    { toward = [0, 1, 0], gravity_bend = 3 },",
        "part.reach = 4": "part_line.falloff = 4",
        "[[nail]]": "[[pin]]",
        "reach = 1": "length = 1",
        "[nail.mask]": "[pin.mask]",
        "soft = 2 # cm": "falloff = 2 # cm",
        "mask = { soft = 1 }": "mask = { falloff = 1 }",
        "amount = 0.5": "tightness = 0.5",
        "op = 'gather'": 'op = "tie"',
        'tie = "nail"': 'curve = "nail"',
        'set = { "clump.amount" = 0.1, "curl.phase_alike" = 1, "gather.off" = 3 }': 'set = { "clump.tightness" = 0.1, '
        '"curl.phase_coherence" = 1, "tie.off" = 3 }',
        "[grooms.droop.clean]": "[grooms.droop.collide]",
        "droop = 1": "gravity_bend = 1",
    }
    assert ("shape", 1, "op") in [one.place for one in found]


def test_operators_of_a_variant_are_renamed_by_their_number():
    text = 'ringlet = 1\nextends = "a"\n[shape."clump 2"]\namount = 1\n[[shape.append]]\nop = "clump"\namount = 0\n'
    assert upgraded(text, "a")[0] == text.replace("ringlet = 1", "ringlet = 2").replace("amount", "tightness")


@pytest.mark.parametrize("file", sorted([*ROOT.glob("examples/*/*.toml"), *ROOT.glob("tests/fuzz/corpus/*/*.toml")]))
def test_every_key_and_every_value_of_a_text_is_found_where_it_is(file):
    check_spans(file.read_text())


plain = st.one_of(st.integers(), st.floats(allow_nan=False), st.text("a.\"'\\\n#[]{},= é", max_size=6), st.booleans())
names = st.text("ab.\"' #é-", min_size=1, max_size=4)
tables = st.dictionaries(
    names,
    st.recursive(plain, lambda inner: st.lists(inner, max_size=3) | st.dictionaries(names, inner, max_size=3)),
    max_size=4,
)


@given(tables)
def test_keys_and_values_of_any_table_are_found(data):
    check_spans(to_toml(data))


def check_spans(text: str) -> None:
    data = tomllib.loads(text)
    values = {}
    for place, value, start, end in spans(text):
        if value:
            values[place] = tomllib.loads(f"x = {text[start:end]}")["x"]
        else:
            assert tomllib.loads(f"{text[start:end]} = 1") == {place[-1]: 1}
    expected = {}
    left = [((), data)]
    while left:
        place, value = left.pop()
        rows = value.items() if isinstance(value, dict) else enumerate(value) if isinstance(value, list) else None
        if rows is None:
            expected[place] = value
        left += [((*place, key), one) for key, one in rows or ()]
    assert values == expected


def test_a_renamed_setting_keeps_its_random_numbers():
    ids = np.arange(9)
    pairs = (
        ("cornrow 2/gravity_bend", "cornrow 2/droop"),
        ("pin[1]/mask", "pin[1]/mask"),
        ("volume 2/amount", "loft 2/amount"),
    )
    for new, old in pairs:
        np.testing.assert_array_equal(Random(3, new).uniform(ids), Random(3, old).uniform(ids))
    assert not np.array_equal(Random(3, "tie/curve").uniform(ids), Random(3, "tie/off").uniform(ids))


def test_edits_of_a_lock_are_read_by_former_names():
    with pytest.warns(FormerNames, match="clump.amount is now tightness"):
        edits = parse_edits('ringlet = 1\n[[edit]]\nlock = 3\nset = { "clump 2.amount" = 1 }\n', Path("a.edits.toml"))
    assert edits["edit"] == [{"lock": 3, "set": {"clump 2.tightness": 1}}]


# Commands


def test_a_command_reads_former_names_and_notes_them_once(project):
    recipe = edit(project / "small.recipe.toml", "ringlet = 2", "ringlet = 1")
    edit(recipe, "length = 5", "length = 5\ndroop = 3")
    result = run("groom", recipe, "-o", project / "groom.usdc")
    assert result.exit_code == 0
    notes = [line for line in result.stderr.splitlines() if line.startswith("note: ")]
    assert notes == ["note: small.recipe.toml: guides.droop is now gravity_bend; ringlet upgrade rewrites the file"]


def test_upgrade_says_what_it_changes_and_writes_it(project):
    recipe = edit(project / "small.recipe.toml", "ringlet = 2", "ringlet = 1")
    edit(recipe, "length = 5", "length = 5\ndroop = 3 # down")
    before = recipe.read_bytes()
    result = run("upgrade", recipe, "--check")
    assert result.exit_code == 1 and result.stdout == f"{recipe}: guides.droop is now gravity_bend\n"
    assert recipe.read_bytes() == before
    assert run("upgrade", recipe).exit_code == 0
    assert recipe.read_text() == before.decode().replace("ringlet = 1", "ringlet = 2").replace("droop", "gravity_bend")
    assert run("upgrade", recipe, "--check").exit_code == 0
    assert run("groom", recipe, "-o", project / "groom.usdc").stderr.count("note: ") == 0


def test_upgrade_keeps_the_line_ends_of_a_file(project):
    recipe = project / "small.recipe.toml"
    recipe.write_bytes(recipe.read_bytes().replace(b"ringlet = 2", b"ringlet = 1").replace(b"\n", b"\r\n"))
    assert run("upgrade", recipe).exit_code == 0
    assert recipe.read_bytes().count(b"\r\n") == recipe.read_bytes().count(b"\n") > 10


def test_upgrade_refuses_all_files_where_one_is_wrong(project):
    recipe = edit(project / "small.recipe.toml", "ringlet = 2", "ringlet = 1")
    edit(project / "small.shot.toml", "ringlet = 2", "ringlet = 9")
    before = recipe.read_bytes()
    refused(run("upgrade", recipe, project / "small.shot.toml"), "small.shot.toml", "ringlet is 9", "update it")
    assert recipe.read_bytes() == before


def test_the_former_command_is_read_with_a_note(project):
    result = run("picture", project / "none.usdc")
    assert "note: ringlet picture is now ringlet render" in result.stderr
    refused(result, "none.usdc")


# Stored files


def test_a_stored_groom_is_read_by_former_names(project):
    edit(project / "small.recipe.toml", "per_lock = 3", "per_lock = 3\nmask = { falloff = 3 }\n[[pin]]")
    layer = Sdf.Layer.FindOrOpen(str(made(project)))
    locks = layer.GetPrimAtPath("/groom/locks")
    held = np.array(locks.attributes["primvars:ringlet:pin"].default)
    locks.attributes["primvars:ringlet:pin"].name = "primvars:ringlet:nail"
    hairs = layer.GetAttributeAtPath("/groom.ringlet:hairs")
    hairs.default = hairs.default.replace("falloff", "soft")
    layer.Save()
    groom = ringlet.read_groom(project / "groom.usdc")
    np.testing.assert_array_equal(groom.locks.point["pin"], held)
    assert groom.hairs["mask"]["falloff"] == 0.03 and "soft" not in groom.hairs["mask"]


# Documents

PAGES = [file for file in sorted(ROOT.glob("docs/**/*.md")) if file.name not in ("former_names.md", "hardening.md")]
PAGES = [file for file in PAGES if file.parent.name not in ("decisions", "_generated")]


def test_no_page_says_a_former_name():
    blocks = 0
    for page in PAGES:
        text = page.read_text()
        for block in re.findall(r"^```toml\n(.*?)^```", text, re.DOTALL | re.MULTILINE):
            try:
                data = tomllib.loads(block)
            except tomllib.TOMLDecodeError as error:
                raise AssertionError(f"{page.name}: {error}\n{block}") from error
            found = present(data, page.name)[1]
            assert not found and data.get("ringlet", 2) == 2, (page.name, found)
            blocks += 1
        said = [rename.former for rename in RENAMES if "." in rename.former and f"`{rename.former}`" in text]
        assert not said, (page.name, said)
    assert blocks > 20
