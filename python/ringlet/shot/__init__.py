"""Shots: the settings of a simulation, from a TOML file."""

from ringlet.shot.cloth import ClothMaterial, Pin, ShotCloth
from ringlet.shot.contact import Collider, Contact, Pair, ShotContact
from ringlet.shot.material import Material
from ringlet.shot.shot import Forces, Shot, parse_shot, read_shot, schema
from ringlet.shot.solver import ClothSolver, Solver

__all__ = [
    "ClothMaterial",
    "ClothSolver",
    "Collider",
    "Contact",
    "Forces",
    "Material",
    "Pair",
    "Pin",
    "Shot",
    "ShotCloth",
    "ShotContact",
    "Solver",
    "parse_shot",
    "read_shot",
    "schema",
]
