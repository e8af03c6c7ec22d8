"""Guides: density, direction, symmetry and files of drawn guides."""

import struct

import numpy as np
import pytest
from PIL import Image
from pxr import Sdf, UsdGeom, Vt
from ringlet.data.texture import Texture
from shapes import ball, sheet
from small_example import write_head

import ringlet
from ringlet import Curves, UserError, io
from ringlet.groom import make_groom, parse_recipe


def groom(text, scalp=None, **options):
    return make_groom(parse_recipe(f"ringlet = 2\n[collide]\nmargin = 0\n{text}"), scalp or ball(), **options)


def painted(name="thick", mesh=None):
    """The ball with a map of 1 on the right and 0.25 on the left."""
    mesh = mesh or ball()
    mesh.maps[name] = np.where(mesh.points[mesh.triangles].mean(axis=1, keepdims=True)[:, :, 0] > 0.0, 1.0, 0.25)
    mesh.maps[name] = np.broadcast_to(mesh.maps[name], mesh.triangles.shape).copy()
    return mesh


@pytest.mark.parametrize("kind", ["guides", "locks"])
def test_a_painted_density_sets_the_spacing_and_keeps_the_count(kind):
    other = "[locks]\npoints = 10" if kind == "guides" else "[guides]\ncount = 20"
    curves = getattr(groom(f"[{kind}]\ncount = 400\ndensity = 'thick'\n{other}", painted()), kind)
    right = curves.roots[:, 0] > 0.0
    assert len(curves) == 400
    assert right.sum() / (~right).sum() == pytest.approx(4.0, rel=0.15)
    gaps = np.linalg.norm(curves.roots[:, None] - curves.roots[None], axis=2) + np.eye(400)
    nearest = gaps.min(axis=1)
    assert nearest[right].min() > 0.4 * np.median(nearest[right])  # the spacing is bounded below
    assert np.median(nearest[~right]) == pytest.approx(2.0 * np.median(nearest[right]), rel=0.2)


def test_guides_follow_the_flow_where_there_is_no_whorl():
    text = "[guides]\ncount = 40\nlift = 0\ngravity_bend = 0\nwhorl = false\nflow = [1, 0, 0]\n"
    guides = groom(text, sheet()).guides
    direction = guides.points[guides.offsets[1:] - 1] - guides.roots
    np.testing.assert_allclose(direction, [[0.08, 0.0, 0.0]] * 40, atol=1e-9)


@pytest.mark.parametrize(
    "text", ["whorl = false\nflow = [0, -1, 0]\nlift = 0\ngravity_bend = 0", "lift = 1\ngravity_bend = 2\npoints = 10"]
)
def test_guides_have_their_length_where_a_direction_vanishes(text):
    guides = groom(f"[guides]\ncount = 40\nlength = 6\n{text}\n", sheet()).guides
    np.testing.assert_allclose(guides.lengths(), 0.06)
    assert np.linalg.norm(np.diff(guides.points.reshape(40, -1, 3), axis=1), axis=2).min() > 1e-3


@pytest.mark.parametrize("kind", ["guides", "locks"])
@pytest.mark.parametrize("source", ["primvar", "texture"])
def test_a_small_painted_spot_keeps_the_count(kind, source):
    mesh = sheet(20)
    spot = np.linalg.norm(mesh.points[mesh.triangles] - [0.03, 0.0, 0.03], axis=2) < 0.006
    if source == "primvar":
        mesh.maps["spot"] = spot.astype(float)
    else:
        mesh.uv = (mesh.points[mesh.triangles][:, :, [0, 2]] + 0.1) / 0.2
        values = np.zeros((100, 100))
        values[34:37, 64:67] = 1.0
        mesh.textures["spot"] = Texture.from_values(values)
    other = "[locks]\npoints = 10" if kind == "guides" else "[guides]\ncount = 20"
    curves = getattr(groom(f"[{kind}]\ncount = 400\ndensity = 'spot'\n{other}", mesh), kind)
    assert len(curves) == 400 and len(np.unique(curves.roots, axis=0)) == 400
    assert np.linalg.norm(curves.roots - [0.03, 0.0, 0.03], axis=1).max() < 0.02


def test_coincident_points_of_a_guide_change_nothing():
    line = np.linspace(0, 0.05, 4)[:, None] * [0.0, 1.0, 0.0]
    text = "[guides]\nfile = 'g.usda'\n[locks]\npoints = 12\n"
    plain, doubled = (
        groom(text, sheet(), drawn_guides=Curves.from_list([one, one + [0.02, 0, 0]])).locks.points
        for one in (line, line[[0, 0, 1, 2, 2, 2, 3, 3]])
    )
    np.testing.assert_array_equal(doubled, plain)


def test_zero_density_grows_nothing_and_is_refused_everywhere():
    mesh = painted()
    mesh.maps["thick"][mesh.maps["thick"] < 0.5] = 0.0
    guides = groom("[guides]\ncount = 100\ndensity = 'thick'", mesh).guides
    assert len(guides) == 100 and guides.roots[:, 0].min() > -1e-9
    mesh.maps["thick"][:] = 0.0
    with pytest.raises(UserError, match=r"guides.density 'thick' is 0 all over ball"):
        groom("[guides]\ncount = 100\ndensity = 'thick'", mesh)


def test_a_painted_density_keeps_the_other_guides_when_one_is_removed():
    more, fewer = (groom(f"[guides]\ncount = {n}\ndensity = 'thick'", painted()).guides for n in (301, 300))
    assert set(fewer.ids) < set(more.ids)


def test_lengths_are_painted_by_primvar_and_by_texture():
    mesh = ball()
    mesh.maps["long"] = np.where(mesh.points[mesh.triangles][:, :, 0] > 0.0, 1.0, 0.5)
    guides = groom("[guides]\ncount = 80\nlength = { value = 6, map = 'long' }", mesh).guides
    assert np.allclose(guides.lengths()[guides.roots[:, 0] > 0.02], 0.06)
    assert np.allclose(guides.lengths()[guides.roots[:, 0] < -0.02], 0.03)

    flat = sheet()  # u along x, v along z; the texture is black at v = 0 and white at v = 1
    flat.uv = (flat.points[flat.triangles][:, :, [0, 2]] + 0.1) / 0.2
    flat.textures["long"] = Texture.from_values(np.linspace(1.0, 0.0, 200)[:, None].repeat(3, axis=1))
    guides = groom("[guides]\ncount = 80\nlength = { value = 6, map = 'long' }", flat).guides
    inside = np.abs(guides.roots[:, 2]) < 0.09
    expected = 0.06 * (guides.roots[:, 2] + 0.1) / 0.2
    np.testing.assert_allclose(guides.lengths()[inside], expected[inside], atol=4e-4)
    flat.uv = None
    with pytest.raises(UserError, match=r"guides.length.map is 'long', a picture, but sheet has no texture coord"):
        groom("[guides]\ncount = 80\nlength = { value = 6, map = 'long' }", flat)


def test_painted_directions_replace_the_flow_where_they_are_nonzero():
    mesh = sheet()
    right = mesh.points[mesh.triangles].mean(axis=1)[:, 0] > 0.0
    mesh.vectors["comb"] = np.where(right[:, None, None], [0.0, 0.0, 2.0], 0.0) * np.ones((1, 3, 1))
    plain = "[guides]\ncount = 60\nlift = 0\ngravity_bend = 0\nwhorl = [0, 1, 0]\n"
    free, combed = groom(plain, mesh).guides, groom(plain + "direction = 'comb'", mesh).guides
    lean = lambda g: (g.points.reshape(60, -1, 3)[:, -1] - g.roots) / g.lengths()[:, None]  # noqa: E731
    on_right = combed.roots[:, 0] > 0.0
    np.testing.assert_allclose(lean(combed)[on_right], np.broadcast_to([0, 0, 1.0], (on_right.sum(), 3)), atol=1e-9)
    np.testing.assert_allclose(lean(combed)[~on_right], lean(free)[~on_right])
    with pytest.raises(UserError, match=r"guides.direction is 'combe', which sheet has no directions for; did you"):
        groom(plain + "direction = 'combe'", mesh)


def test_a_zone_may_be_a_region_and_needs_a_place():
    mesh = ball()
    mesh.regions["front"] = np.flatnonzero(mesh.points[mesh.triangles].mean(axis=1)[:, 2] > 0.0).astype(np.int32)
    text = "[guides]\ncount = 60\nlength = 6\nzone = [{ mask = { region = 'front' }, length = 0.5 }]"
    guides = groom(text, mesh).guides
    assert np.allclose(guides.lengths()[guides.roots[:, 2] > 0.02], 0.03)
    assert np.allclose(guides.lengths()[guides.roots[:, 2] < -0.02], 0.06)
    with pytest.raises(UserError, match=r"guides.zone\[0\] does not say where it is"):
        groom("[guides]\nzone = [{ length = 0.5 }]")


def test_a_zone_fades_over_its_falloff():
    text = "[guides]\ncount = 300\nlength = 6\nzone = [{ toward = [0, 0, 1], angle = 60, length = 0.5, %s }]"
    soft, hard, between = (groom(text % f).guides for f in ("falloff = 60", "falloff = 0", "falloff = 20"))
    assert np.array_equal(soft.lengths(), groom(text.replace(", %s", "")).guides.lengths())
    outward = soft.roots / np.linalg.norm(soft.roots, axis=1, keepdims=True)
    angle = np.degrees(np.arccos(outward[:, 2]))
    near = np.abs(angle - 60.0) < 1.0  # the middle of the scalp is near that of the ball
    np.testing.assert_allclose(hard.lengths()[~near], np.where(angle < 60.0, 0.03, 0.06)[~near], rtol=1e-6)
    np.testing.assert_allclose(between.lengths()[angle < 39.0], 0.03, rtol=1e-6)
    fades = (angle > 43.0) & (angle < 57.0)
    assert ((between.lengths()[fades] > 0.03) & (between.lengths()[fades] < 0.06)).all()
    for wrong in ("toward = [0, 0, 1], angle = 10, falloff = 20", "mask = 0.5, falloff = 20"):
        with pytest.raises(UserError, match=r"guides.zone\[0\] has a falloff that its cone has no room for"):
            groom(f"[guides]\nzone = [{{ length = 0.5, {wrong} }}]")


def test_guides_turn_away_from_a_drawn_part_line():
    line = "[curves.parting]\npoints = [[3, 0, -9], [3, 0, 9]]\n"
    text = "[guides]\ncount = 200\nlift = 0.2\ngravity_bend = 0\nwhorl = [0, 0, 1]\npart_line = { curve = 'parting' }\n"
    guides = groom(text + line, sheet()).guides
    side = guides.roots[:, 0] - 0.03
    near = (np.abs(side) < 0.015) & (np.abs(guides.roots[:, 2]) < 0.08)
    lean = (guides.points.reshape(200, -1, 3)[:, -1] - guides.roots)[near, 0]
    assert near.sum() > 10 and (lean * np.sign(side[near]) > 0.02).all()


def test_mirrored_guides_are_symmetric_and_named_after_their_originals():
    guides = groom("[guides]\ncount = 200\nmirror = {}").guides
    original, image = guides.take(guides.ids >= 0), guides.take(guides.ids < 0)
    assert len(image) > 60 and original.roots[:, 0].min() > -0.002
    for k in range(0, len(image), 9):
        source = original[int(np.flatnonzero(original.ids == -1 - image.ids[k])[0])]
        np.testing.assert_allclose(image[k], source * [-1, 1, 1], atol=2e-4)  # the facets of the ball are not mirrored
    assert np.isin(image.curve["root_triangle"], ball().regions["scalp"]).any()


def test_mirroring_keeps_guides_on_the_plane_once_and_refuses_an_empty_side():
    lines = Curves.from_list([np.array([[x, 0, 0], [x, 0.03, 0.01], [x, 0.06, 0]]) for x in (0.0, 0.04, -0.07)])
    drawn = "[guides]\nfile = 'g.obj'\nmirror = {}"
    guides = groom(drawn, sheet(), drawn_guides=lines).guides
    assert sorted(guides.ids.tolist()) == [-2, 0, 1]
    np.testing.assert_allclose(sorted(guides.roots[:, 0]), [-0.04, 0.0, 0.04], atol=1e-9)
    with pytest.raises(UserError, match=r"guides.mirror: there is no guide on the side that is kept; turn 'across'"):
        groom(drawn, sheet(), drawn_guides=lines.take(np.array([2])))


def test_guides_are_resampled_by_their_length():
    long = np.stack([np.zeros(9), np.linspace(0.0, 0.1, 9), np.zeros(9)], axis=1)
    lines = Curves.from_list([long, 0.3 * long + [0.05, 0, 0]])
    guides = groom("[guides]\nfile = 'g.obj'\nsegment = 1", sheet(), drawn_guides=lines).guides
    assert guides.counts.tolist() == [11, 4]
    np.testing.assert_allclose(guides[0][:, 1], np.linspace(0, 0.1, 11), atol=1e-6)
    np.testing.assert_allclose(guides.lengths(), [0.1, 0.03])


# From files


def curve_of(points):
    """Points in the space of the files: centimetres, Z up."""
    return np.round(np.asarray(points) * 100.0, 6)[:, [0, 2, 1]] * (1, -1, 1)


def write_usd(path, lines, kind, basis, wrap):
    from usd_scenes import new_stage

    stage = new_stage(path, unit=0.01, axis="Z")
    curves = UsdGeom.BasisCurves.Define(stage, "/hair")
    curves.CreateTypeAttr(kind)
    curves.CreateBasisAttr(basis)
    curves.CreateWrapAttr(wrap)
    curves.CreateCurveVertexCountsAttr([len(line) for line in lines])
    curves.CreatePointsAttr(Vt.Vec3fArray.FromNumpy(np.concatenate([curve_of(line) for line in lines]).astype("f4")))
    stage.Save()


def write_obj(path, lines):
    text, first = "", 1
    for line in lines:
        text += "".join(f"v {x} {y} {z}\n" for x, y, z in curve_of(line))
        text += "l " + " ".join(str(first + k) for k in range(len(line))) + "\n"
        first += len(line)
    path.write_text(text)


def write_hair(path, lines):
    count = sum(map(len, lines))
    header = struct.pack("<4sIIIIff3f88s", b"HAIR", len(lines), count, 0b11, 0, 0.01, 0.0, 0.1, 0.1, 0.1, b"")
    segments = np.array([len(line) - 1 for line in lines], "<u2").tobytes()
    path.write_bytes(header + segments + np.concatenate([curve_of(line) for line in lines]).astype("<f4").tobytes())


def lines_on_the_ball():
    """Four straight guides of 7 points on top of the ball, along its normals."""
    up = np.array([[0.02, 0.09, 0.0], [-0.03, 0.085, 0.01], [0.01, 0.085, -0.03], [0.0, 0.09, 0.02]])
    roots = 0.09 * up / np.linalg.norm(up, axis=1, keepdims=True)
    return [root + np.linspace(0, 0.05, 7)[:, None] * root / 0.09 for root in roots]


@pytest.mark.parametrize(
    ("suffix", "kind", "basis", "wrap"),
    [
        ("usda", "linear", "bezier", "nonperiodic"),
        ("usdc", "cubic", "bezier", "nonperiodic"),
        ("usda", "cubic", "bspline", "pinned"),
        ("usda", "cubic", "catmullRom", "pinned"),
        ("obj", "", "", ""),
        ("hair", "", "", ""),
    ],
)
def test_drawn_guides_of_every_format_have_the_same_positions(tmp_path, suffix, kind, basis, wrap):
    lines, path = lines_on_the_ball(), tmp_path / f"drawn.{suffix}"
    write_head(tmp_path / "head.usda")
    if suffix.startswith("usd"):
        write_usd(path, lines, kind, basis, wrap)
    else:
        (write_obj if suffix == "obj" else write_hair)(path, lines)
    space = "" if suffix.startswith("usd") else "unit = 'cm'\nup = 'Z'"
    (tmp_path / "a.toml").write_text(
        f"ringlet = 2\n[scalp]\nfile = 'head.usda'\n[guides]\nfile = '{path.name}'\n{space}\n[locks]\npoints = 30\n"
    )
    made = ringlet.build_groom(tmp_path / "a.toml")
    np.testing.assert_allclose(made.guides.roots, [line[0] for line in lines], atol=2e-6)
    np.testing.assert_allclose(made.guides.lengths(), 0.05, atol=2e-6)
    assert len(made.locks) == 4


def test_periodic_guides_are_refused(tmp_path):
    write_head(tmp_path / "head.usda")
    write_usd(tmp_path / "ring.usda", lines_on_the_ball(), "cubic", "bspline", "periodic")
    (tmp_path / "a.toml").write_text("ringlet = 2\n[scalp]\nfile = 'head.usda'\n[guides]\nfile = 'ring.usda'\n")
    with pytest.raises(UserError, match="wrap is periodic; must be nonperiodic or pinned"):
        ringlet.build_groom(tmp_path / "a.toml")


def test_an_obj_scalp_has_the_unit_of_the_recipe(tmp_path):
    mesh = ball()
    points = "".join(f"v {x} {y} {z}\n" for x, y, z in curve_of(mesh.points))
    faces = "".join(f"f {a + 1} {b + 1} {c + 1}\n" for a, b, c in mesh.triangles)
    (tmp_path / "head.obj").write_text(points + faces)
    (tmp_path / "a.toml").write_text(
        "ringlet = 2\n[scalp]\nfile = 'head.obj'\nunit = 'cm'\nup = 'Z'\n[guides]\ncount = 8\n[locks]\ncount = 9\n"
    )
    made = ringlet.build_groom(tmp_path / "a.toml")
    np.testing.assert_allclose(made.scalp.points, mesh.points, atol=1e-7)
    assert (made.space.meters_per_unit, made.space.up_axis) == (0.01, "Z")
    ringlet.write_groom(made, tmp_path / "groom.usdc")
    again = ringlet.read_groom(tmp_path / "groom.usdc")
    np.testing.assert_allclose(again.locks.points, made.locks.points, atol=1e-6)


def test_a_texture_restricts_hair_on_an_obj_without_groups(tmp_path):
    mesh = ball()
    low, size = mesh.points.min(axis=0), np.ptp(mesh.points, axis=0)
    points = "".join(f"v {x} {y} {z}\n" for x, y, z in 100 * mesh.points)
    texture = "".join(f"vt {u} {v}\n" for u, v, _ in (mesh.points - low) / size)  # a projection from the front
    faces = "".join(f"f {a}/{a} {b}/{b} {c}/{c}\n" for a, b, c in mesh.triangles + 1)
    (tmp_path / "head.obj").write_text(points + texture + faces)
    white = np.zeros((100, 100), np.uint8)
    white[:25] = 255  # the upper quarter
    Image.fromarray(white).save(tmp_path / "hair.png")
    recipe = tmp_path / "a.toml"
    recipe.write_text(
        "ringlet = 2\n[scalp]\nfile = 'head.obj'\nunit = 'cm'\n[maps]\nhair = 'hair.png'\n"
        "[guides]\ncount = 20\ndensity = 'hair'\n[locks]\ncount = 60\ndensity = 'hair'\n"
    )
    made = ringlet.build_groom(recipe)
    assert len(made.guides) == 20 and len(made.locks) == 60
    heights = np.concatenate([made.guides.roots, made.locks.roots])[:, 1]
    edge = low[1] + 0.75 * size[1]
    assert heights.min() > edge - 0.01 * size[1] and heights.min() < edge + 0.1 * size[1]
    recipe.write_text(recipe.read_text().replace("unit = 'cm'", "unit = 'cm'\nregion = 'scalp'"))
    with pytest.raises(UserError, match=r"head.obj has no region 'scalp'.*leave it out, and paint guides.density"):
        ringlet.build_groom(recipe)
    recipe.write_text(recipe.read_text().replace("region = 'scalp'", ""))
    (tmp_path / "head.obj").write_text(points + "".join(f"f {a} {b} {c}\n" for a, b, c in mesh.triangles + 1))
    with pytest.raises(UserError, match=r"guides.density is 'hair', .* head.obj has no texture coordinates"):
        ringlet.build_groom(recipe)


def test_painted_directions_of_a_usd_mesh_turn_with_it(tmp_path):
    from pxr import Usd

    write_head(tmp_path / "head.usda", up="Z")
    stage = Usd.Stage.Open(str(tmp_path / "head.usda"))
    mesh = stage.GetPrimAtPath("/ball/skin")
    count = len(UsdGeom.Mesh(mesh).GetPointsAttr().Get())
    directions = Vt.Vec3fArray.FromNumpy(np.tile(np.float32([0, 0, 1]), (count, 1)))
    UsdGeom.PrimvarsAPI(mesh).CreatePrimvar("comb", Sdf.ValueTypeNames.Vector3fArray, "vertex").Set(directions)
    stage.Save()
    vectors = io.read_mesh(tmp_path / "head.usda").vectors["comb"]
    np.testing.assert_allclose(vectors, np.broadcast_to([0.0, 1.0, 0.0], vectors.shape), atol=1e-6)


def test_textures_and_helper_curves_are_read_from_files_beside_the_recipe(tmp_path):
    write_head(tmp_path / "head.usda")
    Image.fromarray(np.uint8([[0, 255], [102, 51]])).save(tmp_path / "short.png")
    write_obj(tmp_path / "line.obj", [lines_on_the_ball()[0]])
    (tmp_path / "a.toml").write_text(
        "ringlet = 2\n[scalp]\nfile = 'head.usda'\n[maps]\nshort = 'short.png'\n"
        "[curves.line]\nfile = 'line.obj'\nunit = 'cm'\nup = 'Z'\n[guides]\ncount = 6\n[locks]\ncount = 40\n"
        "[[shape]]\nop = 'attract'\ncurve = 'line'\namount = 1\n"
    )
    made = ringlet.build_groom(tmp_path / "a.toml")
    np.testing.assert_allclose(made.scalp.textures["short"].at(*np.indices((2, 2))), [[0, 1], [0.4, 0.2]])
    line = lines_on_the_ball()[0]
    roots, tips = made.locks.points[made.locks.offsets[:-1]], made.locks.points[made.locks.offsets[1:] - 1]
    beside = np.linalg.norm(roots - line[0], axis=1) < 0.05  # others are guided around the ball
    assert beside.sum() >= 2
    np.testing.assert_allclose(tips[beside], np.broadcast_to(line[-1], tips[beside].shape), atol=1e-4)
    (tmp_path / "short.png").write_text("no picture")
    with pytest.raises(UserError, match=r"short.png: is not a picture that can be read"):
        ringlet.build_groom(tmp_path / "a.toml")
