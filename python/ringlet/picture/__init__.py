"""Pictures: path-traced stills, contact sheets of clips, and comparisons of shapes."""

from ringlet.data.pigment import HAIR_COLORS
from ringlet.picture.beads import beads
from ringlet.picture.bodies import PosedBody, material_of
from ringlet.picture.camera import VIEWS
from ringlet.picture.compare import compare
from ringlet.picture.places import write_places
from ringlet.picture.sheet import sheet
from ringlet.picture.still import still

__all__ = ["HAIR_COLORS", "VIEWS", "PosedBody", "beads", "compare", "material_of", "sheet", "still", "write_places"]
