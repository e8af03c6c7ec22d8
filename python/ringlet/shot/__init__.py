"""Shots: strands that move with an animated scalp."""

from ringlet.data.cache import Cache, CachedCloth, Told, Touches
from ringlet.shot.checkpoint import Checkpoints, frames_between, holding
from ringlet.shot.cloth import Cloth, ClothMaterial, ClothSolver
from ringlet.shot.collider import Collider, Obstacle, ShotContact
from ringlet.shot.equilibrium import equilibrium
from ringlet.shot.garment import Garment, Pin, ShotCloth
from ringlet.shot.loft import Loft, loft, with_sag
from ringlet.shot.scene import Body, Contact, Scene
from ringlet.shot.shot import Forces, Shot, parse_shot, read_shot, schema
from ringlet.shot.simulate import KeptTouches, Motion, made_of, play, played, simulate
from ringlet.shot.stale import check, keep, made_from, preload, refresh
from ringlet.shot.strands import Material, Solver, Strands

__all__ = [
    "Body",
    "Cache",
    "CachedCloth",
    "Checkpoints",
    "Cloth",
    "ClothMaterial",
    "ClothSolver",
    "Collider",
    "Contact",
    "Forces",
    "Garment",
    "KeptTouches",
    "Loft",
    "Material",
    "Motion",
    "Obstacle",
    "Pin",
    "Scene",
    "Shot",
    "ShotCloth",
    "ShotContact",
    "Solver",
    "Strands",
    "Told",
    "Touches",
    "check",
    "equilibrium",
    "frames_between",
    "holding",
    "keep",
    "loft",
    "made_from",
    "made_of",
    "parse_shot",
    "play",
    "played",
    "preload",
    "read_shot",
    "refresh",
    "schema",
    "simulate",
    "with_sag",
]
