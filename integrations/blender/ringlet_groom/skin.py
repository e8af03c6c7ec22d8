"""Curves that follow the skin, by nodes of Blender that work without the extension.

Before it is simulated, each curve is bound to a triangle of vertices of the head. The nodes move its root with the
triangle, and turn the curve as the triangle turns; it keeps its shape. Vertices are those of the mesh itself: modifiers
that refine a surface leave them in front.

Then each curve, also one that plays a cache, is moved so that its root is on the skin that Blender shows: that of each
level of subdivision is another.
"""

from __future__ import annotations

import bpy
import numpy as np
from numpy.typing import NDArray

from . import curves, meshes

GROUP = MODIFIER = "Ringlet skin"  # the nodes, and the modifier that runs them
VERTICES = ("skin_a", "skin_b", "skin_c")  # attributes of curves: the triangle
PLACE = "skin_place"  # the root in the frame of the triangle: along both edges, and along the normal
UNPOSED = "skin_unposed"  # matrix that takes the rest pose to the frame of the root


def follow(thing: bpy.types.Object, head: bpy.types.Object, *, bound: bool = True) -> None:
    """Lets curves follow a head: those that are bound with their triangles, and others, which move already, only so
    that their roots are on it."""
    modifier = thing.modifiers.get(MODIFIER) or thing.modifiers.new(MODIFIER, "NODES")
    modifier.node_group = group = _group()
    sockets = {item.name: item.identifier for item in group.interface.items_tree}
    for name, value in (("Skin", head), ("Bound", bound)):
        if modifier.get(sockets[name]) != value:
            modifier[sockets[name]] = value
            thing.update_tag()


def leave(thing: bpy.types.Object) -> None:
    """Lets curves stay where they are."""
    if (modifier := thing.modifiers.get(MODIFIER)) is not None:
        thing.modifiers.remove(modifier)


def bind(data: bpy.types.Curves, faces: NDArray, head: bpy.types.Object, cage: meshes.Arrays, skin: NDArray) -> str:
    """Binds curves to the head they grow on. Returns a sentence where its modifiers number vertices anew.

    faces: of the roots, shape (curves,)
    cage:  the rest pose of the head, as of ``meshes.rest_arrays``
    skin:  its vertices in the rest pose where its modifiers place them, shape (n, 3)
    """
    renumbered = f"{head.name}: its modifiers number its vertices anew, so its hair does not follow it; apply them"
    if len(skin) < len(cage["points"]):
        return renumbered
    counts = curves.counts_of(data)
    points = np.empty(3 * counts.sum(), np.float32)
    data.attributes["position"].data.foreach_get("vector", points)
    roots = points.reshape(-1, 3)[np.cumsum(counts) - counts].astype(np.float64)
    triangles = nearest_triangles(faces, cage["counts"], cage["indices"], skin, roots)
    corners = skin[triangles]
    longest = np.linalg.norm(corners - np.roll(corners, 1, axis=1), axis=2).max(axis=1)
    if (np.linalg.norm(corners - cage["points"][triangles], axis=2).max(axis=1) > longest).any():
        return renumbered
    edges, turned = frames(corners)
    place = np.linalg.solve(edges, (roots - corners[:, 0])[:, :, None])[:, :, 0]
    unposed = np.zeros((len(roots), 4, 4))
    unposed[:, :3, :3] = turned.transpose(0, 2, 1)
    unposed[:, :3, 3] = -np.einsum("nji,nj->ni", turned, roots)
    unposed[:, 3, 3] = 1.0
    for name, values in zip(VERTICES, triangles.T, strict=True):
        curves.set_attribute(data, name, values.astype(np.int32), "CURVE")
    curves.set_attribute(data, PLACE, place.astype(np.float32), "CURVE")
    curves.set_attribute(data, UNPOSED, unposed.transpose(0, 2, 1).astype(np.float32), "CURVE")  # column by column
    return ""


def nearest_triangles(faces: NDArray, counts: NDArray, indices: NDArray, points: NDArray, roots: NDArray) -> NDArray:
    """Of the fan of triangles of each face, the one that a root lies in, or lies out of the least; shape (n, 3).

    faces:           row of the face of each root, shape (n,)
    counts, indices: of all faces
    """
    first = (np.cumsum(counts) - counts)[faces]
    best, found = np.full(len(faces), -np.inf), np.zeros((len(faces), 3), np.int64)
    for k in range(1, int(counts[faces].max(initial=2)) - 1):
        corner = np.minimum(k, counts[faces] - 2)
        triangles = np.stack([indices[first], indices[first + corner], indices[first + corner + 1]], axis=1)
        edges, _ = frames(points[triangles])
        across = np.linalg.solve(edges, (roots - points[triangles[:, 0]])[:, :, None])[:, :2, 0]
        inside = np.minimum(across.min(axis=1), 1.0 - across.sum(axis=1))
        better = inside > best
        best[better], found[better] = inside[better], triangles[better]
    return found


def frames(corners: NDArray) -> tuple[NDArray, NDArray]:
    """Frames of triangles, shape (n, 3, 3): both edges and a normal as long as the root of the parallelogram; and that
    frame as a rotation, with the first edge as x and the normal as z."""
    first, second = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
    normal = np.cross(first, second)
    area = np.maximum(np.linalg.norm(normal, axis=1, keepdims=True), 1e-30)
    x, z = first / np.maximum(np.linalg.norm(first, axis=1, keepdims=True), 1e-30), normal / area
    return np.stack([first, second, normal / np.sqrt(area)], axis=2), np.stack([x, np.cross(z, x), z], axis=2)


def _group() -> bpy.types.NodeTree:
    """The nodes, made once for a .blend."""
    found = next((one for one in bpy.data.node_groups if one.name == GROUP and not one.library), None)
    if found is not None:
        return found
    group = bpy.data.node_groups.new(GROUP, "GeometryNodeTree")
    group.is_modifier = True
    for name, way, kind in (
        ("Geometry", "INPUT", "NodeSocketGeometry"),
        ("Skin", "INPUT", "NodeSocketObject"),
        ("Bound", "INPUT", "NodeSocketBool"),
        ("Geometry", "OUTPUT", "NodeSocketGeometry"),
    ):
        group.interface.new_socket(name, in_out=way, socket_type=kind)

    def node(kind: str, *inputs: object, **settings: object) -> bpy.types.Node:
        """A node with its inputs: outputs of others, or values."""
        made = group.nodes.new(kind)
        for name, value in settings.items():
            setattr(made, name, value)
        for socket, given in zip([one for one in made.inputs if one.enabled], inputs, strict=False):
            if isinstance(given, bpy.types.NodeSocket):
                group.links.new(given, socket)
            elif given is not None:
                socket.default_value = given
        return made

    def out(made: bpy.types.Node) -> bpy.types.NodeSocket:
        return next(one for one in made.outputs if one.enabled)

    def vector(operation: str, *inputs: object) -> bpy.types.NodeSocket:
        return out(node("ShaderNodeVectorMath", *inputs, operation=operation))

    def scaled(one: bpy.types.NodeSocket, by: bpy.types.NodeSocket) -> bpy.types.NodeSocket:
        made = node("ShaderNodeVectorMath", one, operation="SCALE")
        group.links.new(by, made.inputs["Scale"])
        return out(made)

    def attribute(name: str, kind: str) -> bpy.types.Node:
        return node("GeometryNodeInputNamedAttribute", name, data_type=kind)

    given = group.nodes.new("NodeGroupInput")
    skin = node("GeometryNodeObjectInfo", given.outputs["Skin"], transform_space="RELATIVE").outputs["Geometry"]
    position = out(node("GeometryNodeInputPosition"))
    a, b, c = (
        out(node("GeometryNodeSampleIndex", skin, position, out(attribute(name, "INT")), data_type="FLOAT_VECTOR"))
        for name in VERTICES
    )
    first, second = vector("SUBTRACT", b, a), vector("SUBTRACT", c, a)
    cross = vector("CROSS_PRODUCT", first, second)
    area = out(node("ShaderNodeVectorMath", cross, operation="LENGTH"))
    upright = scaled(cross, out(node("ShaderNodeMath", area, -0.5, operation="POWER")))
    place = node("ShaderNodeSeparateXYZ", out(attribute(PLACE, "FLOAT_VECTOR"))).outputs
    along = vector("ADD", scaled(first, place[0]), scaled(second, place[1]))
    root = vector("ADD", a, vector("ADD", along, scaled(upright, place[2])))
    turned = node("FunctionNodeAxesToRotation", cross, first, primary_axis="Z", secondary_axis="X")
    posed = out(node("FunctionNodeCombineTransform", root, out(turned)))
    moved = out(node("FunctionNodeMatrixMultiply", posed, out(attribute(UNPOSED, "FLOAT4X4"))))
    of_curve = out(node("GeometryNodeFieldOnDomain", moved, domain="CURVE", data_type="FLOAT4X4"))
    there = out(node("FunctionNodeTransformPoint", position, of_curve))
    following = out(node("GeometryNodeSetPosition", given.outputs["Geometry"], given.outputs["Bound"], there))
    first_point = out(node("GeometryNodePointsOfCurve"))
    start = out(node("GeometryNodeFieldAtIndex", position, first_point, domain="POINT", data_type="FLOAT_VECTOR"))
    seen = out(node("GeometryNodeProximity", skin, None, start, target_element="FACES"))
    off = vector("SUBTRACT", seen, start)
    off_curve = out(node("GeometryNodeFieldOnDomain", off, domain="CURVE", data_type="FLOAT_VECTOR"))
    made = node("GeometryNodeSetPosition", following, None, None, off_curve)
    group.links.new(out(made), group.nodes.new("NodeGroupOutput").inputs["Geometry"])
    return group
