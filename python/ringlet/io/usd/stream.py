"""Writing points frame by frame, without holding the frames in memory."""

from __future__ import annotations

from contextlib import ExitStack
from pathlib import Path
from types import TracebackType

from numpy.typing import NDArray
from pxr import Sdf, Usd, UsdGeom

from ringlet.data.stage import StageSpace
from ringlet.io.usd.curves import set_points
from ringlet.io.usd.groom import choose_variant, groom_prim
from ringlet.io.usd.stage import check_target, new_stage, reading, refuse_itself, writing

FLUSH = 64e6  # bytes of points held in memory before they go to the file


class StreamWriter:
    """A layer over another file that grows frame by frame, and is put in its place when the block ends well."""

    def __init__(self, path: Path | str, under: Path | str, space: StageSpace, variant: str | None = None) -> None:
        check_target(path, under)
        self.path, self.under, self.space, self.variant = Path(path), Path(under), space, variant
        self._frames: list[float] = []
        self._held = 0

    def begin(self) -> Usd.Stage:
        """Opens the file beside ``path`` and gives its stage, over a groom that is fit for it."""
        with reading(self.under) as source:
            groom_prim(source)
            if source.space != self.space:
                raise ValueError(f"{self.under}: has {source.space}; must be {self.space}")
            for layer in source.stage.GetUsedLayers():  # the groom under a cache, the head, cloths
                refuse_itself(self.path, layer.realPath, "file")
        with ExitStack() as opened:
            self._stage = new_stage(opened.enter_context(writing(self.path)), self.space, over=self.under)
            if self.variant is not None:
                choose_variant(self._stage, self.variant)
            self._opened = opened.pop_all()
        return self._stage

    @property
    def layer(self) -> Sdf.Layer:
        """The layer that is written."""
        return self._stage.GetRootLayer()

    def put(self, curves: UsdGeom.BasisCurves, frame: float | None, points: NDArray) -> None:
        """Sets the points [m] of curves at a frame; at rest for None."""
        set_points(curves, points, self.space, Usd.TimeCode.Default() if frame is None else Usd.TimeCode(float(frame)))
        self.grown(frame, points.size * 4)

    def grown(self, frame: float | None, size: int) -> None:
        """Notes that something was set at a frame, of so many bytes."""
        if frame is not None:
            self._frames.append(float(frame))
        self._held += size
        # A binary layer lets go of what it has saved; a text layer would be written anew each time.
        if self._held > FLUSH and self.path.suffix != ".usda":
            self.layer.Save()
            self._held = 0

    def finish(self) -> None:
        """What is to be written last."""

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        if error is not None:
            self._opened.__exit__(kind, error, trace)
            return
        with self._opened:
            if self._frames:
                self._stage.SetStartTimeCode(min(self._frames))
                self._stage.SetEndTimeCode(max(self._frames))
            self.finish()
            self.layer.Save()
