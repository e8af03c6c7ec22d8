"""Renders in place: path-traced pictures of the displayed groom, from the camera of a page."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace

import numpy as np

from ringlet.api.hairs import build_hairs
from ringlet.data.camera import Camera
from ringlet.data.curves import Curves
from ringlet.data.errors import UserError
from ringlet.data.picture import PictureSettings
from ringlet.picture import Pose, PosedBody
from ringlet.picture.camera import SENSOR
from ringlet.viewer import protocol
from ringlet.viewer.project import Project
from ringlet.viewer.publisher import SendQueue
from ringlet.viewer.show.display_groom import DisplayGroom, shuffled_order
from ringlet.viewer.show.lights import light_file
from ringlet.viewer.show.render_process import RenderProcess, RenderStep
from ringlet.viewer.show.scene import VisibleMesh
from ringlet.viewer.show.viewport import Viewport
from ringlet.viewer.wire import pack, trouble

BOUNCES = 32  # light hair needs them
FEW = 0.05  # of the hairs, in the first picture


class Rendering:
    """The renders of a session: one of each page at most. Methods run on the session's thread.

    A spare process has loaded the path tracer before it is asked for, once a page has rendered.
    """

    def __init__(self, project: Project) -> None:
        self._project = project
        self._running: dict[SendQueue, RenderProcess] = {}
        self._spare: RenderProcess | None = None

    def render(self, message: protocol.Render, viewport: Viewport, page: SendQueue) -> None:
        """Begins a render for a page in place of its last one; raises UserError before the groom is made."""
        self.cancel(page)
        if viewport.display is None:
            raise UserError("render: the groom is still being made; wait until it is shown")
        settings = PictureSettings(
            width=message.width,
            height=message.height,
            samples=message.samples,
            color=message.color or None,
            light=light_file(message.light, self._project),
            light_turn=message.light_turn,
            bounces=BOUNCES,
        )
        camera, poses = camera_of(message, viewport.origin), poses_of(viewport.display, viewport.bodies)
        process, self._spare = self._spare or RenderProcess(), None
        self._running[page] = process

        def send(step: RenderStep) -> None:
            if self._running.get(page) is process:
                page.put("rendered", _answer(message, step))

        process.run(poses, camera, settings, send)
        self._spare = RenderProcess()

    def cancel(self, page: SendQueue) -> None:
        """Ends the render of a page, if there is one."""
        if process := self._running.pop(page, None):
            process.cancel()
        page.discard("rendered")

    def stop(self) -> None:
        """Ends all processes."""
        for page in list(self._running):
            self.cancel(page)
        if self._spare is not None:
            self._spare.cancel()


def camera_of(message: protocol.Render, origin: np.ndarray) -> Camera:
    """Camera of a page; its picture is as high as the sensor. origin: of its positions [m]."""
    place, target = (origin + np.array(message.camera[i : i + 3]) for i in (0, 3))
    backward = place - target
    distance = float(np.linalg.norm(backward))
    if distance < 1e-6:
        raise UserError("render: the camera is where it looks at; move it")
    backward = backward / distance
    right = np.cross([0.0, 1.0, 0.0], backward)
    if np.linalg.norm(right) < 1e-6:
        raise UserError("render: the camera looks straight down or up; turn it")
    right = right / np.linalg.norm(right)
    slope = 0.5 * SENSOR / message.focal_length
    slopes = (slope * message.width / message.height, slope)
    axes = np.stack([right, np.cross(backward, right), backward])
    return Camera(place, axes, distance, slopes, focal_length=1e-3 * message.focal_length)


def poses_of(display: DisplayGroom, bodies: Sequence[VisibleMesh]) -> Iterator[Pose]:
    """What is seen: bodies at rest, and hairs of a groom with their colors, few that stand for all and then all."""
    posed = [PosedBody(body.mesh, body.mesh.points) for body in bodies]
    for fraction in (FEW, 1.0):
        if display.hairs is None:
            yield Pose(posed, fewer(display.groom.locks, fraction))
        else:
            hairs = build_hairs(display.groom, fraction=fraction, wider=True).curves
            yield Pose(posed, replace(hairs, points=np.asarray(hairs.points)))


def fewer(curves: Curves, fraction: float) -> Curves:
    """A fraction of curves, as much wider."""
    if fraction == 1.0 or not len(curves):
        return curves
    rows = np.sort(shuffled_order(len(curves))[: max(1, round(fraction * len(curves)))])
    few = curves.take(rows)
    widths = {name: values * (len(curves) / len(few)) for name, values in few.point.items() if name == "width"}
    return replace(few, point={**few.point, **widths})


def _answer(message: protocol.Render, step: RenderStep) -> bytes:
    """Message with a step of a render, or with its error."""
    if step.error:
        return trouble(step.error)
    return pack(
        protocol.Rendered(number=message.number, samples=step.samples, of=message.samples),
        png=np.frombuffer(step.png, np.uint8),
    )
