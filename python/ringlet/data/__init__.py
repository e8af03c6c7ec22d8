"""Plain data and small helpers that every package may use: curves, meshes, grooms, caches, files, settings, errors."""
