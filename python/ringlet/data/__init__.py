"""Plain data and small helpers that every package may use: curves, meshes, grooms, caches, files, settings, errors."""

from ringlet.data import limits as limits
