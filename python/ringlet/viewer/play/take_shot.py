"""A take of live hair as a shot: files with the motion of its head, its recipe and its material."""

from __future__ import annotations

import os
from dataclasses import dataclass
from pathlib import Path
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ringlet import io
from ringlet.data.errors import UserError
from ringlet.data.files import replacing
from ringlet.data.mesh import Mesh
from ringlet.data.rigid import rotation_matrix, rotation_vector
from ringlet.data.settings import FORMAT
from ringlet.data.smooth_step import smooth_step
from ringlet.data.surfaces import material_of
from ringlet.data.toml import toml_key
from ringlet.viewer.files.document import set_value
from ringlet.viewer.files.open_files import Files
from ringlet.viewer.show.live_take import LEAD, LiveTake

Array = NDArray[np.float64]

FIRST = 1  # frame at which a take begins in its shot
AT_REST = 1e-3  # farthest turn [rad] and shift [m] of a head that is as groomed
NECK, RADIUS, SHOULDER = (
    0.045,
    0.045,
    12.0,
)  # it bends over a height, less high beyond its radius [m]; web/src/view/body.ts
NEW = f"""ringlet = {FORMAT}
groom = ""
frames = [1, 2]
preroll = 0

[contact]
"""  # of a take in the material by default


@dataclass(frozen=True)
class HeadClip:
    """The motion of a head in frames, about its neck.

    first: number of the first frame; before ``FIRST`` the head comes from rest, so that the hair is in motion then
    turns: rotation vectors [rad], shape (frames, 3)
    shifts: of all of the body [m], shape (frames, 3)
    pivot: where the neck turns [m], shape (3,)
    """

    first: int
    turns: Array
    shifts: Array
    pivot: Array

    @classmethod
    def of(cls, take: LiveTake) -> HeadClip:
        """The motion of a take; its start from rest is recorded, or blended in over the time that is."""
        steps = np.arange(take.steps[-1] + 1)
        poses = np.concatenate([_poses(take.heads), take.trunks], axis=1)
        taken = np.stack([np.interp(steps, take.steps, of) for of in poses.T], axis=1)
        before = np.concatenate([_poses(take.before[:, :12]), take.before[:, 12:]], axis=1)
        before = before[-round(LEAD * float(take.fps)) :]
        resting = np.flatnonzero((np.abs(before) < AT_REST).all(axis=1))
        if len(resting):
            before = before[resting[-1] :]
        else:
            before = before * smooth_step(np.arange(len(before)) / max(len(before), 1))[:, None]
        if (np.abs(taken[0]) < AT_REST).all():
            before = before[:0]
        all_poses = np.concatenate([before, taken])
        return cls(FIRST - len(before), all_poses[:, :3], all_poses[:, 3:], take.pivot + take.origin)

    @property
    def frames(self) -> tuple[int, int]:
        """First and last frame."""
        return self.first, self.first + len(self.turns) - 1

    def follow(self, mesh: Mesh, rest: Array, frame: int) -> Array:
        """Points of a mesh of the head's file in a frame: the neck bends, and cloth goes with the body."""
        turn, shift = rotation_matrix(self.turns[frame - self.first]), self.shifts[frame - self.first]
        share = np.zeros((len(rest), 1)) if material_of(mesh.name) == "cloth" else _share_of_head(rest - self.pivot)
        return rest + shift + share * ((rest - self.pivot) @ turn.T - (rest - self.pivot))


class TakeShot(NamedTuple):
    """Files of a shot that was made of a take, and the text of its recipe."""

    shot: Path
    recipe: Path
    head: Path
    text: str

    def remove(self) -> None:
        """Removes the files."""
        for path in (self.shot, self.recipe, self.head):
            path.unlink(missing_ok=True)


def write_take_shot(files: Files, take: LiveTake, shot: str, name: str) -> TakeShot:
    """Writes the shot of a take with its head and its recipe, next to the open file.

    shot: text of the shot that moved the take; empty for the material by default
    name: of the new files; empty for one that is not there yet

    Raises UserError for files that are there already, and for a head without a USD file.
    """
    folder = files.file.parent
    if not name:
        stem = f"{files.recipe.path.name.removesuffix('.toml').removesuffix('.recipe')}_take"
        names = [stem, *(f"{stem}_{k}" for k in range(2, 1000))]
        name = next(one for one in names if not any(path.exists() for path in _paths(folder, one)))
    files.project.new_file(name, ".shot.toml")
    head, recipe, path_of_shot = _paths(folder, name)[:3]
    for path in _paths(folder, name):
        if path.exists():
            raise UserError(f"take: {path.name} is there already; give another name")
    scalp = files.chosen_recipe.scalp_file
    if scalp is None or scalp.suffix.lower() == ".obj":
        raise UserError(f"take: {scalp} cannot be animated; make the head a USD file, and keep a take again")
    clip = HeadClip.of(take)
    made = TakeShot(path_of_shot, recipe, head, _recipe_text(files, recipe, head.name, name))
    try:
        io.write_head_clip(scalp, head, clip.frames, clip.follow)
        files.parse(made.text, recipe)
        _write(recipe, made.text)
        _write(made.shot, _shot_text(files, clip, take, shot, recipe, name))
    except UserError:
        made.remove()
        raise
    return made


def _paths(folder: Path, name: str) -> list[Path]:
    return [folder / f"{name}{suffix}" for suffix in (".head.usdc", ".recipe.toml", ".shot.toml", ".review")]


def _recipe_text(files: Files, path: Path, head: str, name: str) -> str:
    """A recipe that is the open one, on a head that moves otherwise."""
    base = files.recipe.path
    lines = [f"# {name}: {base.name} on a head that moves as in a take of live hair.", f"ringlet = {FORMAT}"]
    lines.append(f'extends = "{os.path.relpath(base, path.parent)}"')
    for groom in files.recipe.model.grooms or [""]:
        table = f"grooms.{toml_key(groom)}.scalp" if groom else "scalp"
        lines += ["", f"[{table}]", f'file = "{head}"']
    return "\n".join([*lines, ""])


def _shot_text(files: Files, clip: HeadClip, take: LiveTake, text: str, recipe: Path, name: str) -> str:
    """The shot that moved a take, in the motion of its head. What moves with another clip is left out."""
    text = f"# {name}: a take of live hair, whose first frame is {FIRST}. SI units.\n{text or NEW}"
    for setting in ("cloth", "collider"):
        text = set_value(text, [setting], None)
    values = {"name": name, "groom": recipe.name, "frames": list(clip.frames), "preroll": 0}
    for setting, value in values.items():
        text = set_value(text, [setting], value)
    before = files.parse_shot(text)
    if before.contact is not None and before.contact.pair:
        text = set_value(text, ["contact", "pair"], None)
    wind = [round(float(one), 2) for one in take.wind]
    if np.abs(np.array(wind) - before.forces.wind).max() > 0.05:
        text = set_value(text, ["forces", "wind"], wind)
    rest = files.shot.rest_file if files.mode == "shot" else None
    if before.rest.mode != "none" and before.rest.file is None and rest is not None:
        text = set_value(text, ["rest", "file"], os.path.relpath(rest, files.file.parent))
    files.parse_shot(text)
    return text


def _write(path: Path, text: str) -> None:
    with replacing(path) as aside:
        aside.write_text(text, encoding="utf-8")


def _poses(heads: Array) -> Array:
    """Rotation vectors of motions, the rows of 3 × 4 matrices, shape (n, 3)."""
    return np.array([rotation_vector(head.reshape(3, 4)[:, :3]) for head in heads]).reshape(-1, 3)


def _share_of_head(places: Array) -> Array:
    """How far skin goes with the head, from its place about the joint of the neck [m], shape (n, 1)."""
    beyond = np.maximum(0.0, np.hypot(places[:, 0], places[:, 2]) / RADIUS - 1.0)
    t = np.clip(1.0 + places[:, 1] / NECK * (1.0 + SHOULDER * beyond), 0.0, 1.0)
    return smooth_step(np.where(places[:, 1] >= 0.0, 1.0, t))[:, None]
