"""Alembic archives: curves with Unreal's groom attributes, and polygon meshes, with their motion.

Needs ``alembic3d`` (``pip install 'ringlet[alembic]'``). An archive stores neither its unit nor its up-axis. Faces of
Alembic are clockwise, seen from outside.
"""

from ringlet.io.alembic.read import open_alembic, read_alembic_curves
from ringlet.io.alembic.write import SCHEMA, holds, write_alembic

__all__ = ["SCHEMA", "holds", "open_alembic", "read_alembic_curves", "write_alembic"]
