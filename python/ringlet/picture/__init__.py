"""Pictures: path-traced stills, contact sheets of clips, and comparisons of shapes."""

from ringlet.data.pigment import HAIR_COLORS
from ringlet.picture.beads import beads
from ringlet.picture.bodies import PosedBody
from ringlet.picture.camera import VIEWS
from ringlet.picture.compare import compare
from ringlet.picture.motion import Pose
from ringlet.picture.movie import Movie, Shot, check_output, film, still_standpoint, turned_standpoints
from ringlet.picture.places import write_places
from ringlet.picture.sheet import sheet
from ringlet.picture.still import growing, still

__all__ = [
    "HAIR_COLORS",
    "VIEWS",
    "Movie",
    "Pose",
    "PosedBody",
    "Shot",
    "beads",
    "check_output",
    "compare",
    "film",
    "growing",
    "sheet",
    "still",
    "still_standpoint",
    "turned_standpoints",
    "write_places",
]
