"""An archive that is open for reading: values at a frame, in world space and metres."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ringlet.data.errors import UserError
from ringlet.data.stage import StageSpace
from ringlet.io.space import check_points, to_metres

FOREVER = 1e9  # seconds
NEAR = 1e-3  # of a frame: a sample so near to one is at it


class Archive:
    """Values of schemas, which are what an archive calls the data of an object.

    space:  unit and up-axis of the archive
    fps:    frames per second, which time codes count
    names:  of the objects, by the identity of their schemas
    unread: receives a sentence for each thing that is not read
    """

    def __init__(self, library: SimpleNamespace, path: Path, space: StageSpace) -> None:
        self.library, self.path, self.space, self.fps = library, path, space, space.fps
        self.names, self.unread = dict[int, str](), list[str]()

    def name(self, schema: Any) -> str:
        """Name of the object of a schema."""
        return self.names[id(schema)]

    def where(self, schema: Any) -> str:
        """File and object, for messages."""
        return f"{self.path} {self.name(schema)}"

    def frame(self, seconds: float) -> float:
        """The time code of a sample, which is a whole frame where it is within a thousandth of one."""
        frame = seconds * self.fps
        return float(round(frame)) if abs(frame - round(frame)) < NEAR else round(frame, 6)

    def first(self) -> Any:
        """Selects the first sample; the library takes a whole number for seconds, too."""
        return self.library.abc.ISampleSelector(-FOREVER)

    def between(self, timed: Any, frame: float | None, value: Callable[[Any], NDArray]) -> NDArray[np.float64]:
        """A value at a frame, linear between its samples, held beyond the ends; the first sample for None."""
        if frame is None or timed.getNumSamples() < 2:
            return value(timed.getValue(self.first()))
        sampling, count, seconds = timed.getTimeSampling(), timed.getNumSamples(), float(frame) / self.fps
        rows = sampling.getFloorIndex(seconds, count), sampling.getCeilIndex(seconds, count)
        times = [self.frame(sampling.getSampleTime(k)) for k in rows]
        weight = 0.0 if times[1] <= times[0] else float(np.clip((frame - times[0]) / (times[1] - times[0]), 0.0, 1.0))
        wanted = [(k, w) for k, w in zip(rows, (1.0 - weight, weight), strict=True) if w > 1e-6]
        selector = self.library.abc.ISampleSelector
        found = [w * value(timed.getValue(selector(sampling.getSampleTime(k)))) for k, w in wanted]
        if any(one.shape != found[0].shape for one in found):
            raise UserError(
                f"{self.path}: the number of points changes at frame {frame:g}; export it with one topology"
            )
        return np.sum(found, axis=0)

    def placed(self, schema: Any, above: list[Any], frame: float | None) -> NDArray[np.float64]:
        """Positions in world space [m], shape (n, 3); ``above`` are the transforms over the object."""
        points = self.between(schema, frame, lambda at: np.array(at.getPositions(), np.float64).reshape(-1, 3))
        check_points(points, self.where(schema))
        return self.in_world(points, above, frame)

    def in_world(self, points: NDArray[np.float64], above: list[Any], frame: float | None) -> NDArray[np.float64]:
        """Positions of a shape in world space [m], shape (n, 3)."""
        for xform in reversed(above):
            matrix = self.between(xform, frame, lambda at: np.array(at.getMatrix(), np.float64).reshape(4, 4))
            points = points @ matrix[:3, :3] + matrix[3, :3]
        return to_metres(points, self.space)

    def values(self, parameter: Any) -> NDArray:
        """The values of a parameter in its first sample."""
        values = parameter.getExpandedValue(self.first()).getVals()
        try:
            return np.array(memoryview(values))
        except TypeError:
            return np.array([tuple(value) if hasattr(value, "__len__") else value for value in values])

    def parameters(self, schema: Any) -> set[str]:
        """Names of the arbitrary parameters and user properties of a schema."""
        found = [one for one in (schema.getArbGeomParams(), schema.getUserProperties()) if one.valid()]
        return {one.getPropertyHeader(k).getName() for one in found for k in range(one.getNumProperties())}
