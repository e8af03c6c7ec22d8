"""An independent judge of motion without intersections: continuous collision detection by ipctk."""

import itertools

import ipctk
import numpy as np
from scipy.spatial.transform import Rotation


class Judge:
    """Tests all pairs of strands, cloths and bodies of a scene, except pairs of two prescribed elements."""

    def __init__(self, scene):
        curves = scene.strands.curves
        first = np.arange(len(curves.points) - 1)
        edges = np.c_[first, first + 1][~np.isin(first + 1, curves.offsets)]
        triangles, begin = np.zeros((0, 3), int), len(curves.points)
        prescribed = [scene.strands.held]
        for cloth in scene.cloths:
            triangles = np.concatenate([triangles, cloth.mesh.triangles + begin])
            begin += len(cloth.positions)
            prescribed.append(cloth.held)
        for body in scene.bodies:
            triangles = np.concatenate([triangles, body.triangles + begin])
            begin += len(body.points)
            prescribed.append(np.ones(len(body.points), bool))
        sides = np.concatenate([triangles[:, [0, 1]], triangles[:, [1, 2]], triangles[:, [2, 0]]])
        edges = np.concatenate([edges, np.unique(np.sort(sides, axis=1), axis=0)])
        self.mesh = ipctk.CollisionMesh(scene.positions, edges.astype(np.int32), triangles.astype(np.int32))
        self._strands, self._prescribed = scene.strands.curves, np.concatenate(prescribed)
        self.exclude(np.zeros(0, int))
        # Additive CCD reports an impact once the gap falls below a ten-thousandth of the initial gap.
        self.ccd = ipctk.AdditiveCCD(max_iterations=100_000, conservative_rescaling=0.9999)

    def exclude(self, vertices):
        """Excludes only these strand vertices and their neighbours from tests against bodies."""
        patches = np.arange(len(self._prescribed))  # prescribed vertices share one patch
        patches[self._prescribed] = len(patches)
        lock = np.searchsorted(self._strands.offsets, vertices, side="right")
        for step in (-1, 0, 1):
            beside = np.clip(vertices + step, 0, len(self._strands.points) - 1)
            patches[beside[np.searchsorted(self._strands.offsets, beside, side="right") == lock]] = len(patches)
        self.mesh.can_collide = ipctk.make_vertex_patches_filter(patches.astype(np.int32))

    def crossings(self, before, after):
        """Number of pairs that collide while vertices move linearly from ``before`` to ``after`` [m], shape (n, 3)."""
        # The tolerances of ipctk are absolute, so positions are centred and in millimetres.
        before, after = (1e3 * (x - x.mean(axis=0)) for x in (before, after))
        pairs = ipctk.Candidates()
        pairs.build(self.mesh, before, after)
        if pairs.is_step_collision_free(self.mesh, before, after, narrow_phase_ccd=self.ccd):
            return 0
        edges, faces = self.mesh.edges, self.mesh.faces
        return sum(
            pair.ccd(pair.dof(before, edges, faces), pair.dof(after, edges, faces), narrow_phase_ccd=self.ccd)[0]
            for pair in (*pairs.ee_candidates, *pairs.fv_candidates)
        )

    def crossings_of_step(self, before, path):
        """Number of pairs that collide on the moves of a step that began at ``before``, shape (n, 3) [m].

        Its recorded path begins where everything has moved rigidly, or that is judged as a move.
        """
        moves = path if is_rigid(before, path[0]) else [before, *path]
        return sum(self.crossings(*move) for move in itertools.pairwise(moves))


def is_rigid(before, after):
    """Whether all positions, shape (n, 3) [m], make one rigid motion."""
    before, after = (x - x.mean(axis=0) for x in (before, after))
    rotation, _ = Rotation.align_vectors(after, before)
    return np.abs(rotation.apply(before) - after).max() < 1e-9
