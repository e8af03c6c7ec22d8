"""USD files: grooms, caches, hairs, meshes and curves."""
