"""The ends of a rod of cosseratbench as vertices of a strand.

A strand holds whole vertices, its root always. An end may need extra vertices outside of the rod:

free, pinned  At the start an edge without resistance to stretch and bend: the root that every strand has. The first
              element thereby is an edge with a director.
clamped       Short edges that are held with the end node: two at the start, as only the second has a director. A bend
              acts over half of each of its edges, so the clamp is at the node.
sliding       A short edge without resistance to stretch, aligned with a held edge that follows the node along the slide
              direction.

The factor of an edge is the mean of its vertices' factors: −1 + 2s and 1 give the edge the factor s.
"""

from __future__ import annotations

from dataclasses import dataclass, field

from cosseratbench.scenario import End, EndCondition, Rod  # pyright: ignore[reportMissingImports]

HELD = 1e-3  # length of a held edge, in elements
SLIDING = 0.1  # and of one that slides: no Newton iteration more than doubles an edge
RIGID = 1e4  # factor on the bending stiffness that aligns the sliding edge
SOFT = 1e-6  # factor on the area of the free root's edge, and on the stretch stiffness of what slides


@dataclass(frozen=True)
class Fitting:
    """The vertices of one end.

    extras:  distance of each extra vertex from the end node, outwards, in elements; all are held
    held:    whether the end node is held
    node:    factors on the material at the end node, by name of the variation
    first:   factors at the first extra vertex
    framed:  whether the director of the outermost edge is given
    """

    extras: tuple[float, ...] = ()
    held: bool = False
    node: dict[str, float] = field(default_factory=dict)
    first: dict[str, float] = field(default_factory=dict)
    framed: bool = False


def fitting(rod: Rod, end: End) -> Fitting:
    """How a rod ends; raises NotImplementedError for a start that slides."""
    motion = rod.motion(end)
    if motion is not None and motion.slides_along is not None:
        return _sliding(end)
    if rod.condition(end) is EndCondition.CLAMPED:
        return Fitting((HELD, 2 * HELD) if end is End.START else (HELD,), held=True, framed=True)
    held = rod.condition(end) is EndCondition.PINNED
    return _loose_root(held) if end is End.START else Fitting(held=held)


def _mean_with_one(factor: float) -> float:
    return 2.0 * factor - 1.0


def _loose_root(held: bool) -> Fitting:
    light = {"radius": _mean_with_one(SOFT**0.5), "stretch": _mean_with_one(SOFT)}
    # Without bending stiffness at the node its element has half of it in the mean, from which its twist comes.
    return Fitting((1.0,), held, {"bend": 0.0, "twist": _mean_with_one(2.0)}, light)


def _sliding(end: End) -> Fitting:
    if end is End.START:
        raise NotImplementedError("a start that slides")
    bend = 1.0 + SLIDING  # half an element resists bending at the node, and not half of the sliding edge
    node = {"bend": bend, "twist": _mean_with_one(2.0 / (1.0 + bend))}
    first = {"stretch": _mean_with_one(SOFT), "bend": RIGID}
    return Fitting((SLIDING, 2 * SLIDING), False, node, first, framed=True)
