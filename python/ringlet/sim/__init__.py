"""The simulation of a shot: strands, cloth and bodies in motion and in contact, frame by frame."""

from ringlet.sim.checkpoint import Checkpoints, discard, frames_between, left_inputs, locked_folder
from ringlet.sim.cloth import Cloth
from ringlet.sim.garment import Garment
from ringlet.sim.motion import Motion
from ringlet.sim.obstacle import Body, Obstacle
from ringlet.sim.run_inputs import changed_input, run_inputs
from ringlet.sim.scene import Scene
from ringlet.sim.shot_strands import with_words
from ringlet.sim.simulate import Frame, StoredTouches, check_frames, play, replay, simulate
from ringlet.sim.strands import Strands
from ringlet.sim.work import heavy_work

__all__ = [
    "Body",
    "Checkpoints",
    "Cloth",
    "Frame",
    "Garment",
    "Motion",
    "Obstacle",
    "Scene",
    "StoredTouches",
    "Strands",
    "changed_input",
    "check_frames",
    "discard",
    "frames_between",
    "heavy_work",
    "left_inputs",
    "locked_folder",
    "play",
    "replay",
    "run_inputs",
    "simulate",
    "with_words",
]
