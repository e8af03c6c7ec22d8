"""The example head: a closed mesh with a scalp, and a plausible motion."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray
from pxr import Usd, UsdGeom, UsdValidation
from ringlet.io import problems, read_mesh
from scipy.sparse import csr_matrix
from scipy.sparse.csgraph import connected_components
from scipy.spatial import cKDTree

CHILD = Path(__file__).parents[2] / "examples" / "child"
HEAD = CHILD / "head.usdc"
FRAMES = np.arange(1.0, 49.0)


@dataclass
class Surface:
    """A mesh in the units of the file [cm]: rest (n, 3), triangles (m, 3), clip (48, n, 3), regions, uv (m, 3, 2)."""

    rest: NDArray
    triangles: NDArray
    clip: NDArray
    regions: dict[str, NDArray]
    uv: NDArray | None

    def vertices(self, region: str) -> NDArray:
        return np.unique(self.triangles[self.regions[region]])


def read(stage: Usd.Stage, path: str) -> Surface:
    mesh = UsdGeom.Mesh(stage.GetPrimAtPath(path))

    def world(time: Usd.TimeCode) -> NDArray:
        matrix = np.array(UsdGeom.Xformable(mesh).ComputeLocalToWorldTransform(time))
        return np.array(mesh.GetPointsAttr().Get(time), np.float64) @ matrix[:3, :3] + matrix[3, :3]

    st = UsdGeom.PrimvarsAPI(mesh).GetPrimvar("st")
    return Surface(
        rest=world(Usd.TimeCode.Default()),
        triangles=np.array(mesh.GetFaceVertexIndicesAttr().Get()).reshape(-1, 3),
        clip=np.stack([world(Usd.TimeCode(frame)) for frame in FRAMES]),
        regions={
            s.GetPrim().GetName(): np.array(s.GetIndicesAttr().Get()) for s in UsdGeom.Subset.GetAllGeomSubsets(mesh)
        },
        uv=np.array(st.ComputeFlattened()).reshape(-1, 3, 2) if st else None,
    )


@pytest.fixture(scope="module")
def stage() -> Usd.Stage:
    return Usd.Stage.Open(str(HEAD))


@pytest.fixture(scope="module")
def skin(stage: Usd.Stage) -> Surface:
    return read(stage, "/child/skin")


@pytest.fixture(scope="module")
def shirt(stage: Usd.Stage) -> Surface:
    return read(stage, "/child/shirt")


def half_edges(triangles: NDArray) -> NDArray:
    return np.stack([triangles, np.roll(triangles, -1, axis=1)], axis=-1).reshape(-1, 2)


def pieces(triangles: NDArray) -> int:
    used, local = np.unique(triangles, return_inverse=True)
    ends = half_edges(local.reshape(-1, 3)).T
    return connected_components(csr_matrix((np.ones(ends.shape[1]), ends), shape=(len(used),) * 2), directed=False)[0]


def doubled_normals(points: NDArray, triangles: NDArray) -> NDArray:
    a, b, c = (points[triangles[:, k]] for k in range(3))
    return np.cross(b - a, c - a)


def euler_number(triangles: NDArray) -> int:
    edges = np.unique(np.sort(half_edges(triangles), axis=1), axis=0)
    return len(np.unique(triangles)) - len(edges) + len(triangles)


@pytest.mark.parametrize("name", ["skin", "shirt"])
def test_a_body_is_one_closed_surface_without_handles(name: str, request: pytest.FixtureRequest) -> None:
    triangles = request.getfixturevalue(name).triangles
    halves = half_edges(triangles)
    there, back = np.unique(halves, axis=0), np.unique(halves[:, ::-1], axis=0)
    assert len(there) == len(halves), "an edge is used twice in the same direction"
    assert np.array_equal(there, back), "an edge has a triangle on one side only"
    assert pieces(triangles) == 1
    assert euler_number(triangles) == 2


@pytest.mark.parametrize("name", ["skin", "shirt"])
def test_triangles_are_neither_slivers_nor_inverted(name: str, request: pytest.FixtureRequest) -> None:
    body = request.getfixturevalue(name)
    corners = body.rest[body.triangles]
    ahead, behind = np.roll(corners, -1, axis=1) - corners, np.roll(corners, 1, axis=1) - corners
    cosine = (ahead * behind).sum(-1) / (np.linalg.norm(ahead, axis=-1) * np.linalg.norm(behind, axis=-1))
    assert np.degrees(np.arccos(cosine.max())) > 20.0
    volume = (corners[:, 0] * doubled_normals(body.rest, body.triangles)).sum() / 6.0
    assert volume > 0.0


def test_scalp_faces_away_from_the_middle_of_the_head(skin: Surface) -> None:
    scalp = skin.triangles[skin.regions["scalp"]]
    middle = skin.rest[np.unique(scalp)].mean(axis=0)
    outward = skin.rest[scalp].mean(axis=1) - middle
    assert ((doubled_normals(skin.rest, scalp) * outward).sum(1) > 0.0).all()


def test_scalp_is_one_patch_without_holes_and_covers_what_hair_covers(skin: Surface) -> None:
    scalp = skin.triangles[skin.regions["scalp"]]
    assert pieces(scalp) == 1
    assert euler_number(scalp) == 1
    where = {name: set(skin.vertices(name)) for name in skin.regions}
    x, y, z = skin.rest.T
    assert np.argmax(y) in where["scalp"], "the crown"
    assert np.argmin(np.where(y > y.max() - 10.0, z, 0.0)) in where["scalp"], "the back of the head"
    assert np.argmax(z) in where["face"], "the tip of the nose"
    assert np.argmax(np.where(y > y.max() - 14.0, x, 0.0)) in where["ear_left"], "the rim of the left ear"
    assert np.argmin(np.where(y > y.max() - 14.0, x, 0.0)) in where["ear_right"], "the rim of the right ear"


def test_regions_partition_the_skin(skin: Surface) -> None:
    together = np.concatenate(list(skin.regions.values()))
    assert np.array_equal(np.sort(together), np.arange(len(skin.triangles)))


def test_scalp_is_the_same_left_and_right(skin: Surface) -> None:
    scalp = skin.triangles[skin.regions["scalp"]]
    area = 0.5 * np.linalg.norm(doubled_normals(skin.rest, scalp), axis=1)
    side = skin.rest[scalp, 0].mean(axis=1) > 0.0
    assert area[side].sum() == pytest.approx(area[~side].sum(), rel=0.02)
    points = skin.rest[np.unique(scalp)]
    edge = np.sqrt(area.max() * 4.0 / np.sqrt(3.0))
    assert cKDTree(points).query(points * [-1.0, 1.0, 1.0])[0].max() < 1.2 * edge


def test_texture_coordinates_are_injective(skin: Surface) -> None:
    assert skin.uv is not None
    a, b, c = (skin.uv[:, k] for k in range(3))
    signed = (b - a)[:, 0] * (c - a)[:, 1] - (b - a)[:, 1] * (c - a)[:, 0]
    assert (signed > 0.0).all(), "a triangle is inverted or degenerate in the texture"
    covering = np.zeros(600, int)
    for k, spot in enumerate(np.random.default_rng(1).random((len(covering), 2))):
        sides = [
            (q - p)[:, 0] * (spot - p)[:, 1] - (q - p)[:, 1] * (spot - p)[:, 0] for p, q in ((a, b), (b, c), (c, a))
        ]
        covering[k] = (np.min(sides, axis=0) > 0.0).sum()
    assert covering.max() == 1
    assert covering.mean() > 0.3, "the texture is mostly empty"


def test_scalp_keeps_its_areas_in_the_texture(skin: Surface) -> None:
    """The ratio of areas is within a factor of two of its median, so painted densities hold on the head."""
    assert skin.uv is not None
    chosen = skin.regions["scalp"]
    a, b, c = (skin.uv[chosen, k] for k in range(3))
    flat = (b - a)[:, 0] * (c - a)[:, 1] - (b - a)[:, 1] * (c - a)[:, 0]
    ratio = flat / np.linalg.norm(doubled_normals(skin.rest, skin.triangles[chosen]), axis=1)
    ratio /= np.median(ratio)
    assert np.percentile(ratio, 1) > 0.5
    assert np.percentile(ratio, 99) < 2.0


def test_head_has_the_size_of_a_child_in_the_unit_of_the_file(stage: Usd.Stage, skin: Surface) -> None:
    assert UsdGeom.GetStageMetersPerUnit(stage) == pytest.approx(0.01)
    assert UsdGeom.GetStageUpAxis(stage) == UsdGeom.Tokens.y
    face = skin.rest[skin.vertices("face")]
    assert 0.18 < 0.01 * (skin.rest[:, 1].max() - face[:, 1].min()) < 0.22
    assert np.ptp(skin.rest[skin.vertices("scalp"), 0]) == pytest.approx(15.0, abs=1.5)


def test_clip_starts_and_ends_at_rest(stage: Usd.Stage, skin: Surface) -> None:
    assert stage.GetTimeCodesPerSecond() == 24.0
    assert (stage.GetStartTimeCode(), stage.GetEndTimeCode()) == (1.0, 48.0)
    for frame in (0, 1, 47):
        assert np.allclose(skin.clip[frame], skin.rest, atol=1e-4)


def test_head_nods_turns_and_hops(skin: Surface) -> None:
    nose, nape = np.argmax(skin.rest[:, 2]), skin.vertices("scalp")[np.argmin(skin.rest[skin.vertices("scalp"), 2])]
    ahead = skin.clip[:, nose] - skin.clip[:, nape]
    pitch = np.degrees(np.arctan2(ahead[:, 1], np.hypot(ahead[:, 0], ahead[:, 2])))
    yaw = np.degrees(np.arctan2(ahead[:, 0], ahead[:, 2]))
    assert np.ptp(pitch[1:16]) > 15.0
    assert 35.0 < np.abs(yaw[16:33]).max() < 60.0
    assert 8.0 < (skin.clip[33:, :, 1].min(axis=1) - skin.rest[:, 1].min()).max() < 14.0


def test_only_gravity_acts_in_the_air(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.syspath_prepend(str(CHILD))
    import motion

    frames = np.linspace(30.0, 48.0, 1000)
    flying = motion.HEIGHT(frames) > 0.01
    acceleration = motion.HEIGHT.derivative(2)(frames[flying]) * motion.FPS**2
    assert flying.any()
    assert acceleration == pytest.approx(-981.0)


def test_scalp_moves_as_a_rigid_body(skin: Surface) -> None:
    edges = np.unique(np.sort(half_edges(skin.triangles[skin.regions["scalp"]]), axis=1), axis=0)
    rest = np.linalg.norm(skin.rest[edges[:, 0]] - skin.rest[edges[:, 1]], axis=1)
    lengths = np.linalg.norm(skin.clip[:, edges[:, 0]] - skin.clip[:, edges[:, 1]], axis=-1)
    assert np.abs(lengths / rest - 1.0).max() < 1e-4
    assert np.abs(np.diff(skin.clip, axis=0)).max() > 1.0, "the clip does not move"


def test_chin_keeps_clear_of_neck_and_shirt(skin: Surface, shirt: Surface) -> None:
    face = skin.vertices("face")
    chin = face[skin.rest[face, 1] < skin.rest[face, 1].min() + 2.0]
    low = np.flatnonzero(skin.rest[:, 1] < skin.rest[face, 1].min() - 3.0)
    for posed, cloth in zip(skin.clip, shirt.clip, strict=True):
        assert cKDTree(np.concatenate([posed[low], cloth])).query(posed[chin])[0].min() > 1.0


@pytest.mark.parametrize("feature", ["eye_left/eyeball", "eye_right/iris", "brow_left", "lash_right"])
def test_features_of_the_face_move_with_the_head(feature: str, stage: Usd.Stage, skin: Surface) -> None:
    moved = read(stage, f"/child/{feature}").clip.mean(axis=1)
    nose = skin.clip[:, np.argmax(skin.rest[:, 2])]
    distance = np.linalg.norm(moved - nose, axis=1)
    assert np.abs(distance - distance[0]).max() < 0.5  # the eyes rotate a little in the head


def test_extents_contain_the_points_of_every_frame(stage: Usd.Stage) -> None:
    for prim in stage.Traverse():
        if mesh := UsdGeom.Mesh(prim):
            for time in (Usd.TimeCode.Default(), *map(Usd.TimeCode, FRAMES)):
                low, high = np.array(mesh.GetExtentAttr().Get(time))
                points = np.array(mesh.GetPointsAttr().Get(time))
                assert (points >= low).all(), (prim.GetPath(), time)
                assert (points <= high).all(), (prim.GetPath(), time)


def test_file_is_small_valid_usd_with_a_scalp(stage: Usd.Stage) -> None:
    validators = UsdValidation.ValidationRegistry().GetOrLoadAllValidators()
    errors = UsdValidation.ValidationContext(validators).Validate(stage)
    assert [error.GetErrorAsString() for error in errors] == [] == problems(HEAD)
    assert len(read_mesh(HEAD).region("scalp")) > 100
    assert stage.GetDefaultPrim().GetPath() == "/child"
    assert HEAD.stat().st_size < 5e6
