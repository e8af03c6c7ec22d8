"""Files in and out: USD."""

from ringlet.io.usd.cache import CacheWriter, cache_groom_path, read_cache, write_cache
from ringlet.io.usd.check import problems
from ringlet.io.usd.curves import read_curves
from ringlet.io.usd.groom import read_groom, write_groom
from ringlet.io.usd.hairs import HairWriter, read_hairs, read_stage
from ringlet.io.usd.mesh import Body, read_bodies, read_clip, read_mesh
from ringlet.io.usd.stage import read_space

__all__ = [
    "Body",
    "CacheWriter",
    "HairWriter",
    "cache_groom_path",
    "problems",
    "read_bodies",
    "read_cache",
    "read_clip",
    "read_curves",
    "read_groom",
    "read_hairs",
    "read_mesh",
    "read_space",
    "read_stage",
    "write_cache",
    "write_groom",
]
