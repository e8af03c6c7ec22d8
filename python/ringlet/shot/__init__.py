"""Shots: strands that move with an animated scalp."""

from ringlet.shot.cache import Cache
from ringlet.shot.cloth import Cloth, ClothMaterial, ClothSolver
from ringlet.shot.loft import Loft, loft
from ringlet.shot.shot import Forces, Shot, parse_shot, read_shot, schema
from ringlet.shot.simulate import simulate
from ringlet.shot.stale import check, keep, made_from, refresh
from ringlet.shot.strands import Material, Solver, Strands

__all__ = [
    "Cache",
    "Cloth",
    "ClothMaterial",
    "ClothSolver",
    "Forces",
    "Loft",
    "Material",
    "Shot",
    "Solver",
    "Strands",
    "check",
    "keep",
    "loft",
    "made_from",
    "parse_shot",
    "read_shot",
    "refresh",
    "schema",
    "simulate",
]
