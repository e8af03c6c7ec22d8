"""Reads and writes USD, Alembic, .hair, TressFX .tfx and polylines of OBJ; reads meshes from OBJ."""

from ringlet.io.formats import format_of, open_scene, write_scene
from ringlet.io.read import read_clip, read_curves, read_head, read_mesh, read_space
from ringlet.io.texture import read_texture
from ringlet.io.unreal import for_unreal
from ringlet.io.usd.cache import CacheFile, CacheWriter, cache_groom_path, is_cache, open_cache, read_cache, write_cache
from ringlet.io.usd.camera import camera_paths, read_camera
from ringlet.io.usd.check import problems
from ringlet.io.usd.deformable import Rod, write_deformable_scene
from ringlet.io.usd.groom import as_written, is_groom, read_groom, write_groom
from ringlet.io.usd.hairs import HairWriter, groom_names, read_hair_frames, read_hairs, read_stage
from ringlet.io.usd.head import head_path, write_head
from ringlet.io.usd.head_clip import write_head_clip
from ringlet.io.usd.host_meshes import PolygonMesh, write_polygon_meshes
from ringlet.io.usd.mesh import Body, read_bodies, read_body, read_meshes, surface_paths, unread_surfaces
from ringlet.io.usd.offsets import read_offsets, write_offsets
from ringlet.io.usd.on_demand import (
    OnDemandWriter,
    has_hairs_on_demand,
    layer_under_on_demand,
    read_on_demand,
)
from ringlet.io.usd.rest import read_rest, write_rest
from ringlet.io.usd.stage import SUFFIXES as USD_SUFFIXES
from ringlet.io.usd.stage import check_target
from ringlet.io.usd.touches import heat, read_touches, start_marks, write_touches

__all__ = [
    "USD_SUFFIXES",
    "Body",
    "CacheFile",
    "CacheWriter",
    "HairWriter",
    "OnDemandWriter",
    "PolygonMesh",
    "Rod",
    "as_written",
    "cache_groom_path",
    "camera_paths",
    "check_target",
    "for_unreal",
    "format_of",
    "groom_names",
    "has_hairs_on_demand",
    "head_path",
    "heat",
    "is_cache",
    "is_groom",
    "layer_under_on_demand",
    "open_cache",
    "open_scene",
    "problems",
    "read_bodies",
    "read_body",
    "read_cache",
    "read_camera",
    "read_clip",
    "read_curves",
    "read_groom",
    "read_hair_frames",
    "read_hairs",
    "read_head",
    "read_mesh",
    "read_meshes",
    "read_offsets",
    "read_on_demand",
    "read_rest",
    "read_space",
    "read_stage",
    "read_texture",
    "read_touches",
    "start_marks",
    "surface_paths",
    "unread_surfaces",
    "write_cache",
    "write_deformable_scene",
    "write_groom",
    "write_head",
    "write_head_clip",
    "write_offsets",
    "write_polygon_meshes",
    "write_rest",
    "write_scene",
    "write_touches",
]
