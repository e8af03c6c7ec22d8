"""The light rigs of pictures, as the live picture draws them: four round lamps at most, and even surroundings."""

from __future__ import annotations

from functools import lru_cache
from math import pi
from pathlib import Path

from ringlet.data.errors import UserError
from ringlet.picture import rigs, studio
from ringlet.viewer.project import Project
from ringlet.viewer.protocol import Lamp, Rig
from ringlet.viewer.show.surroundings import FAR, lamps_and_sky

# The sun and the sky of ``rigs``, measured with white plates in Mitsuba. The strength is the irradiance of a plate that
# faces the sun; the radiance of an even sky is the mean irradiance of six plates along the axes, over π.
SUN_SIZE, SUN_STRENGTH, SKY = 0.0093, (11.63, 9.50, 6.90), (0.281, 0.420, 0.637)
PLACES = ("*", "lights/*")  # of HDRIs in the folder of a project
MOST_FILES, MOST_BYTES = 12, 200_000_000  # of them


def live_rigs() -> dict[str, Rig]:
    """The rigs by the names that pictures have for them."""
    boxes = [
        Lamp(azimuth=one.azimuth, elevation=one.elevation, size=one.size, strength=one.strength)
        for one in studio.LIGHTS.values()
    ]
    window = Lamp(
        azimuth=rigs.WINDOW_PLACE[0],
        elevation=rigs.WINDOW_PLACE[1],
        size=2.0 * (rigs.WINDOW_SIZE[0] * rigs.WINDOW_SIZE[1] / pi) ** 0.5 / rigs.WINDOW_DISTANCE,  # as large a disk
        strength=rigs.WINDOW_STRENGTH,
        distance=rigs.WINDOW_DISTANCE,
    )
    sun = Lamp(
        azimuth=rigs.SUN_PLACE[0], elevation=rigs.SUN_PLACE[1], size=SUN_SIZE, strength=SUN_STRENGTH, distance=FAR
    )
    return {
        rigs.STUDIO: Rig(label="Studio", with_camera=True, ambient=studio.AMBIENT, lamps=boxes),
        rigs.WINDOW: Rig(label="Window", with_camera=False, ambient=rigs.ROOM, lamps=[window]),
        rigs.SUN: Rig(label="Sun", with_camera=False, ambient=SKY, lamps=[sun]),
    }


def live_rigs_of(project: Project) -> tuple[dict[str, Rig], list[str]]:
    """The rigs, and those of the HDRIs of a project by their paths in its folder; what is wrong with others of them.

    Pictures of another shape than latitude and longitude, such as renders, are left out.
    """
    found, wrong = live_rigs(), []
    names = project.files(*(f"{place}{suffix}" for place in PLACES for suffix in rigs.SUFFIXES))
    for name in names[:MOST_FILES]:
        try:
            if rig := _surroundings(file := project.inside(name, "light"), file.stat().st_mtime_ns):
                found[name] = rig
        except (UserError, OSError) as error:
            wrong.append(str(error))
    return found, wrong


@lru_cache(maxsize=2 * MOST_FILES)
def _surroundings(file: Path, time: int) -> Rig | None:
    """The rig of an HDRI; None for another picture. time: of its last change, so that it is read again [ns]"""
    if file.stat().st_size > MOST_BYTES:
        raise UserError(f"{file.name}: has over {MOST_BYTES / 1e6:g} MB; make the picture smaller")
    radiance = rigs.read_surroundings(file)
    if radiance.shape[1] != 2 * radiance.shape[0]:
        return None
    lamps, sky = lamps_and_sky(radiance)
    return Rig(label=file.stem.replace("_", " "), with_camera=False, ambient=sky, lamps=lamps)


def light_file(name: str, project: Project) -> str:
    """A light as pictures have it: the name of a rig, or the path of an HDRI. Raises UserError for any other."""
    light = name if name in rigs.RIGS else str(project.inside(name, "light"))
    rigs.check_rig(light)
    return light
