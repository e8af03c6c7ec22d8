"""The groom: builds guides, locks and render hairs from a recipe and a scalp mesh."""

from ringlet.data.groom import Groom
from ringlet.deform import AnyHairs, Hairs, JoinedHairs
from ringlet.groom.check import Allowed, check_groom
from ringlet.groom.color import hair_colors
from ringlet.groom.density import hair_count, hairs_per_cm2
from ringlet.groom.edits_file import add_points, add_settings, release, restored_on_error, row_of
from ringlet.groom.fix import fix_groom
from ringlet.groom.folds import folded_braids
from ringlet.groom.hair_measures import hair_cover, hair_measures, lock_thickness
from ringlet.groom.hair_settings import HairSettings
from ringlet.groom.hairs import HairMemory
from ringlet.groom.joined_hairs import lay_hairs, make_hairs
from ringlet.groom.presets import PRESETS
from ringlet.groom.rebind import rebind
from ringlet.groom.recipe import Recipe, parse_recipe, read_recipe, schema
from ringlet.groom.several import grooms_of, join_grooms, recipe_of_lock, recipes_of
from ringlet.groom.stack import make_groom
from ringlet.groom.stages import Memory

__all__ = [
    "PRESETS",
    "Allowed",
    "AnyHairs",
    "Groom",
    "HairMemory",
    "HairSettings",
    "Hairs",
    "JoinedHairs",
    "Memory",
    "Recipe",
    "add_points",
    "add_settings",
    "check_groom",
    "fix_groom",
    "folded_braids",
    "grooms_of",
    "hair_colors",
    "hair_count",
    "hair_cover",
    "hair_measures",
    "hairs_per_cm2",
    "join_grooms",
    "lay_hairs",
    "lock_thickness",
    "make_groom",
    "make_hairs",
    "parse_recipe",
    "read_recipe",
    "rebind",
    "recipe_of_lock",
    "recipes_of",
    "release",
    "restored_on_error",
    "row_of",
    "schema",
]
