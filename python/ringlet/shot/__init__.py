"""Shots: strands that move with an animated scalp."""

from ringlet.shot.cache import Cache
from ringlet.shot.shot import Forces, Shot, parse_shot, read_shot, schema
from ringlet.shot.simulate import simulate
from ringlet.shot.strands import Material, Solver, Strands

__all__ = ["Cache", "Forces", "Material", "Shot", "Solver", "Strands", "parse_shot", "read_shot", "schema", "simulate"]
