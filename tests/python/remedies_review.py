"""Rows of the tests of advice: what a review, a host, a wedge and a picture refuse."""

from __future__ import annotations

import io
import shutil
import socket
import sys
from collections.abc import Callable
from contextlib import ExitStack
from pathlib import Path
from typing import Any
from unittest.mock import Mock, patch

import numpy as np
import test_viewer_snapshots as snapshots
from distributed import LocalCluster
from PIL import Image
from pxr import Usd, UsdGeom
from remedies import (
    BOB,
    BY_HAND,
    EDITS,
    RECIPE,
    SAVE,
    SHOT,
    WEDGE,
    WIDER,
    Act,
    Advice,
    added,
    asked,
    changed,
    in_order,
    line,
    shown,
    staged,
    wrote,
)
from ringlet.data.toml import to_toml
from ringlet.farm import cluster, task
from ringlet.farm.grid import choose, make_tasks
from ringlet.host.link import Message
from ringlet.host.requests import WriteCurves
from ringlet.host.scene_files import write_curves
from ringlet.host.server import Server
from ringlet.picture import engine, oidn, sheet
from ringlet.picture.bodies import PosedBody
from ringlet.picture.motion import Pose
from ringlet.picture.still import check_denoiser, subject
from ringlet.report import Picture, figure
from ringlet.viewer import protocol, run
from ringlet.viewer.files.journal import Journal
from ringlet.viewer.keep import share_page
from ringlet.viewer.keep.notes import Stored
from ringlet.viewer.play.frame_cache import FrameCache, WatchedFile
from ringlet.viewer.project import Project
from ringlet.viewer.protocol import File
from ringlet.viewer.session import Session
from ringlet.viewer.show import lights, rendering
from ringlet.viewer.show.scene import open_frames, read_scene
from shapes import ball
from test_viewer_painting import unwrap

import ringlet
from ringlet import Curves


def patched(act: Act, *patches: Callable[[], Any]) -> Act:
    """An act under patches."""

    def under() -> None:
        with ExitStack() as stack:
            for one in patches:
                stack.enter_context(one())
            act()

    return under


QUICK = "--width 16 --samples 1"
GIVEN = WriteCurves(id=1, do="write_curves", folder=Path(), file="a.usdc")
FLAT = {"counts": np.array([2]), "points": np.array(BOB)}


def wedge(values: int) -> Act:
    """Makes the tasks of a wedge with a square of values."""
    choices = [choose("solver.newton", list(range(1, values + 1))), choose("preroll", list(range(values)))]
    return lambda: make_tasks(Path(SHOT), choices, Path("w"))


def scheduled() -> None:
    """A wedge on a scheduler that was started."""
    started = LocalCluster(n_workers=0, processes=False, dashboard_address="127.0.0.1:0")
    with started, cluster._client(started.scheduler_address, None, 0):
        pass


def serve(*ids: int) -> Act:
    """Requests to a server; the first of them stays in progress."""

    def act() -> None:
        server = Server(io.BytesIO(), io.BytesIO())
        server._workers = Mock(), Mock()
        for id in ids:
            server._take(Message({"id": id, "do": "hello"}, {}))

    return act


def light(*pixels: bytes, size: int = 0) -> Act:
    """Reads an HDRI; its pixels have red, green, blue and an exponent. size: of the file, in bytes more."""
    content = f"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n{'# ' + size * 'x'}\n\n-Y 1 +X {len(pixels)}\n".encode()
    file = Path("light.hdr")
    return in_order(wrote("light.hdr", content + b"".join(pixels)), lambda: lights._surroundings(file.absolute(), size))


def add_lens(prim: Usd.Prim) -> None:
    """Adds a camera with a shifted lens."""
    made = UsdGeom.Camera.Define(prim.GetStage(), "/lens")
    made.CreateHorizontalApertureOffsetAttr(2.0)
    made.CreateFStopAttr(2.8)
    made.CreateFocusDistanceAttr(50.0)
    UsdGeom.XformCommonAPI(made).SetTranslate((0, 0, 60))


LENS = f"render other.usdc -o a.png --camera /lens {QUICK}"
FARM = [
    Advice("{} is not installed; install it with: pip install 'ringlet[{}]'",
        patched(line(f"check {RECIPE} --picture a.png"), lambda: patch.dict(sys.modules, matplotlib=None)),
        line(f"check {RECIPE} --picture a.png")),
    Advice("wedge: dask.distributed is not installed",
        patched(line(f"wedge {SHOT} -o w --set solver.newton=1"), lambda: patch.dict(sys.modules, distributed=None)),
        line(f"{WEDGE} --set solver.newton=1")),
    Advice("ended while it started ({}): it was killed, or memory ran out; ask for fewer --workers",
        lambda: cluster._local_cluster(Mock(side_effect=RuntimeError("a worker died")), 2),
        lambda: cluster._local_cluster(Mock(), 1)),
    Advice("no scheduler answers at {} ({}); start one with: dask scheduler",
        patched(line(f"wedge {SHOT} -o w --set solver.newton=1 --scheduler tcp://127.0.0.1:9"),
        lambda: patch.object(cluster, "PATIENCE", "50ms")), scheduled),
    Advice("names no setting, or no value for it; give a setting and its values", lambda: choose("solver.newton", ""),
        lambda: choose("solver.newton", "1,2")),
    Advice("wedge: these are {} combinations; must be at most {}", wedge(101), wedge(2)),
    Advice("wedge: {} is given twice; give all its values at once", lambda: make_tasks(Path(SHOT), [choose("preroll",
        "1"), choose("prer", "2")], Path("w")), lambda: make_tasks(Path(SHOT), [choose("preroll", "1,2")], Path("w"))),
    Advice("is damaged; remove it and run the wedge again", in_order(line(f"{WEDGE} --set solver.newton=1"),
        wrote("w/solver.newton=1/places.npy", ""), line(f"wedge {SHOT} -o w --compare")),
        in_order(lambda: Path("w/solver.newton=1/places.npy").unlink(), line(f"{WEDGE} --set solver.newton=1"))),
    Advice("is not among those simulated, {}; choose another with --frame",
        lambda: task._numbers_of_motion(Path(), ringlet.read_groom("groom.usdc"), Path("cache.usdc"), 9),
        line(f"{WEDGE} --frame 4 --set solver.newton=1")),
]  # fmt: skip
HOST = [
    Advice("curves: points have the shape {}; must be (n, 3), with one list of counts", lambda: write_curves(GIVEN,
        {**FLAT, "points": np.zeros(6)}), lambda: write_curves(GIVEN, FLAT)),
    Advice("ids for {} curves; must be as many", lambda: write_curves(GIVEN, {**FLAT, "ids": np.array([1, 2])}),
        lambda: write_curves(GIVEN, {**FLAT, "ids": np.array([1])})),
    Advice("request: array {} is missing; it must be given", lambda: write_curves(GIVEN, {}),
        lambda: write_curves(GIVEN, FLAT)),
    Advice("is that of a request in progress; give another", serve(1, 1), serve(1, 2)),
]  # fmt: skip
NONE, ONE = Curves.from_list([]), Curves.from_list([BOB])
BALL = ball()
PICTURES = [
    Advice("posed points have shape {}; must be {}", lambda: PosedBody(BALL, BALL.points[1:]),
        lambda: PosedBody(BALL, BALL.points)),
    Advice("{}: point {} is {}; must be finite", lambda: PosedBody(BALL, BALL.points * np.nan),
        lambda: PosedBody(BALL, BALL.points)),
    Advice("picture: engine is llvm, which needs LLVM {} or newer", patched(line(
        f"render hair.usdc -o a.png {QUICK} --engine llvm"), lambda: patch.object(engine, "llvm_version", lambda: 15)),
        line(f"render hair.usdc -o a.png {QUICK} --engine scalar")),
    Advice("points at one frame, {} at the next; leave out the shutter", lambda: Pose([], ONE).towards(Pose([], NONE),
        0.5), line(f"render hair.usdc -o a.png {QUICK}")),
    Advice("is no frame that Ringlet made; give another folder, or move it away",
        in_order(lambda: Path("frames").mkdir(), wrote("frames/0001.png", "x"),
        line(f"movie hair.usdc -o frames --frames 1:1 {QUICK}")),
        in_order(lambda: Path("frames/0001.png").unlink(), line(f"movie hair.usdc -o frames --frames 1:1 {QUICK}"))),
    Advice("has both an aperture offset and depth of field; set --f-stop to 0", staged("hair.usdc", "/", add_lens,
        LENS), line(f"{LENS} --f-stop 0")),
    Advice("has light that is negative or no number, or none at all; export it again", light(bytes(4), bytes(4)),
        light(b"\x80\x80\x80\x80", b"\x80\x80\x80\x80")),
    Advice("{}: has over {} MB; make the picture smaller", patched(light(b"\x80\x80\x80\x80", size=9000),
        lambda: patch.object(lights, "MOST_BYTES", 8000)), patched(light(b"\x80\x80\x80\x80", size=7000),
        lambda: patch.object(lights, "MOST_BYTES", 8000))),
    Advice("sheet: there are no frames; give at least one", lambda: sheet([], Path("a.png")),
        lambda: sheet([(1.0, [], ONE)], Path("a.png"), tile=(16, 16), samples=1)),
    Advice("columns of {} × {} pixels; each must be at least 1", lambda: sheet([(1.0, [], ONE)], Path("a.png"),
        columns=0), lambda: sheet([(1.0, [], ONE)], Path("a.png"), columns=1, tile=(16, 16), samples=1)),
    Advice("the denoiser oidn needs pyoidn; install it with", patched(line(
        f"render hair.usdc -o a.png {QUICK} --denoiser oidn"), lambda: patch.object(oidn, "available",
        lambda: False)), patched(lambda: check_denoiser("oidn"), lambda: patch.object(oidn, "available",
        lambda: True))),
    Advice("picture: there are neither hairs nor bodies; give at least one of them",
        lambda: subject(Pose([], NONE)), lambda: subject(Pose([], ONE))),
    Advice("cannot be read as a picture ({}); make it again or leave it out", in_order(wrote("a.png", "no"),
        lambda: figure(Picture(path="a.png", caption=""))), in_order(line(f"render hair.usdc -o a.png {QUICK}"),
        lambda: figure(Picture(path="a.png", caption="")))),
]  # fmt: skip


def moving(second: int) -> Act:
    """Reads the second frame of a file with two hairs; second: number of points of the other one there."""

    def act() -> None:
        file, stage = Path("moving.usda"), Usd.Stage.CreateInMemory()
        stage.SetDefaultPrim(stage.DefinePrim("/hair", "BasisCurves"))
        curves = UsdGeom.BasisCurves(stage.GetPrimAtPath("/hair"))
        curves.CreateTypeAttr("linear")
        for frame, last in ((1, 3), (2, second)):
            curves.CreateCurveVertexCountsAttr().Set([3, last], frame)
            curves.CreatePointsAttr().Set([(frame, 0.1 * y, y) for y in range(3 + last)], frame)
        stage.GetRootLayer().Export(str(file))
        with open_frames(file, read_scene(file)[1]) as (_, read):
            read(2.0)

    return act


def page(most: int = 15_000_000) -> Act:
    """Makes the share page of a recipe, with no script."""

    def act() -> None:
        Path("share").mkdir(exist_ok=True)
        for name in ("share.js", "share.css"):
            wrote(f"share/{name}", "")()
        with patch.object(share_page, "STATIC", Path("share")):
            share_page.make_page(share_page.look_messages(Path(RECIPE).resolve()), RECIPE, {}, most=most)

    return act


def viewed(file: str) -> Act:
    """Serves a file, for no time."""
    server = patch("uvicorn.Server.run", lambda self, sockets: [one.close() for one in sockets])
    return patched(lambda: run.view(file, browser=False, port=0), lambda: server)


def listen(host: str, port: int | None) -> Act:
    return lambda: run._listen(host, port).close()


def taken_port() -> None:
    with socket.create_server(("127.0.0.1", 0)) as taken:
        listen("127.0.0.1", taken.getsockname()[1])()


def two_pages(*, ask: bool) -> None:
    """Another page than the one that leads saves. ask: once it has asked for the lead, and got it"""
    session = Session(Path(RECIPE).resolve(), Project(Path.cwd()))
    first, second = session.join("one", leads=True), session.join("two")
    if ask:
        session.handle(second, protocol.Lead())
        session.handle(first, protocol.Hand(over=True))
    session.handle(second, SAVE)


def seen(*steps: protocol.FromPage | Callable[[Session], object], **more: Any) -> Act:
    """As ``asked``, when a groom is shown."""
    return asked(*steps, groomed=True, **more)


def put(name: str, value: Any, file: File = "recipe") -> protocol.Set:
    return protocol.Set(file=file, changes=[([*name.split(".")], value)], gesture=1)


def meets(change: Act) -> Callable[[Session], None]:
    """Changes the file of a recipe, and a review hears of it."""

    def step(session: Session) -> None:
        change()
        session.files.meet_disk("recipe")

    return step


def waited(session: Session) -> None:
    """Waits until a run is done."""
    thread = session._playback._simulation._thread
    assert thread is not None
    thread.join(9.0)


def merge(*mine: str) -> protocol.Resolve:
    return protocol.Resolve(choice="merge", mine=list(mine), theirs=["curl.pitch"])


def drawn(*points: tuple[float, float, float], place: str = "guides.part_line.curve") -> protocol.Draw:
    return protocol.Draw(place=[*place.split(".")], points=list(points), gesture=1)


def paint(place: str = "guides.length.map") -> protocol.Paint:
    return protocol.Paint(
        place=[*place.split(".")], tool="add", at=(0, 0.09, 0), by=(0.01, 0, 0), radius=0.05, gesture=1
    )


def camera(*place: float) -> Act:
    message = protocol.Render(number=1, camera=[*place, 0.0, 0.0, 0.0], width=16, height=16)
    return lambda: rendering.camera_of(message, np.zeros(3))


def entry(name: str, text: str) -> Act:
    """Writes a file of the review folder."""
    file = Path("small.review") / name
    return in_order(lambda: file.parent.mkdir(parents=True, exist_ok=True), wrote(str(file), text))


def reference(suffix: str) -> Act:
    return in_order(entry("references/a.toml", f"suffix = '{suffix}'"), entry("references/a.png", "x"),
        asked(lambda session: session._review.references.picture("a")))  # fmt: skip


def snapshot(picture: str) -> protocol.TakeSnapshot:
    return protocol.TakeSnapshot(look=LOOK, picture=picture)


def full() -> None:
    cache = FrameCache()
    cache._file.close()
    with Path("/dev/full").open("wb", buffering=0) as cache._file:
        cache.add(1.0, b"frame")


def journal(text: str) -> Act:
    """Reads a journal; what cannot be read is set aside."""
    return in_order(wrote(".a.toml.unsaved", text), lambda: Journal(Path("a.toml")).read())


LOCK = 19000000
OUT, BACK = protocol.Isolate(locks=[LOCK]), protocol.Isolate(locks=[LOCK], out=False)
DRAG = protocol.Drag(lock=LOCK, point=5, to=(0.0, 0.1, 0.0), gesture=1)
SCULPT = protocol.Sculpt(tool="comb", at=(0, 0.1, 0), by=(0.01, 0, 0), radius=0.05, gesture=1)
LOOK: Any = snapshots.LOOK
LOOKED = to_toml({"look": {name: value for name, value in LOOK.items() if value is not None}})
FRIZZ = '[[shape]]\nop = "frizz"\n'
FIRST = protocol.Arrange(action="add", at=0, op="frizz")
VARIANT = wrote("b.recipe.toml", f'ringlet = 2\nextends = "{RECIPE}"\n')
SEVERAL = wrote("all.recipe.toml", f'ringlet = 2\n[grooms.a]\nextends = "{RECIPE}"\n')
AGAINST = protocol.Against(name="cache.usdc")
START = protocol.Play(action="start")
UP = drawn((0, 0.09, 0), (0, 0.12, 0), place="guides.drawn")
LINE = drawn((0, 0.09, 0), (0.03, 0.09, 0))
UNWRAP: Act = lambda: unwrap(Path())  # noqa: E731
GREY: Act = lambda: Image.new("L", (8, 8)).save("grey.png")  # noqa: E731
TAIL = '[curves.tail]\nfile = "tail.obj"\nunit = "cm"\n'
PART = '[guides.part_line]\ncurve = "tail"\n'
TAKE = protocol.Take(name="b.preset.toml", gesture=1)
PRESET = "ringlet = 2\n[curl]\nwidth = 3\npitch = 2\n"
BY_HAND_AGAIN = changed(RECIPE, ("pitch = 1.9", "pitch = 2.1"))
REVIEW = [
    Advice("{}: {} differs; choose one of both values", asked(WIDER, meets(BY_HAND), merge()),
        asked(put("curl.width", 1.8), meets(BY_HAND_AGAIN), merge("curl.width"))),
    Advice("{}: cannot be read ({}); name a file that is there", in_order(lambda: shutil.move("head.usda", "kept"),
        seen()), in_order(lambda: shutil.move("kept", "head.usda"), seen())),
    Advice("is not written as tables [[{}]]; edit it in the file", in_order(changed(RECIPE, ("ringlet = 2",
        'ringlet = 2\nshape = [{ op = "frizz" }]')), asked(FIRST)), in_order(changed(RECIPE,
        ('shape = [{ op = "frizz" }]', "")), added(RECIPE, FRIZZ), asked(FIRST))),
    Advice("{}: {} changes take over {} s; make fewer at a time", patched(asked(protocol.Set(changes=[(["curl",
        "width"], 2), (["curl", "pitch"], 2)], gesture=1)), lambda: patch("ringlet.viewer.files.document.MOST_SECONDS",
        0.0)),
        asked(put("curl.width", 2), put("curl.pitch", 2))),
    Advice("{}: {} has {} operators; there is none at {}", asked(protocol.Arrange(action="remove", at=3)),
        asked(FIRST, protocol.Arrange(action="remove", at=0))),
    Advice("cannot be read ({}); name a picture that is there", in_order(UNWRAP, GREY, added(RECIPE,
        '[maps]\nm = "grey.png"\n'), changed(RECIPE, ("length = 5", 'length = { value = 5, map = "m" }')),
        seen(paint(), before_last=lambda: Path("grey.png").unlink())), in_order(GREY, seen(paint()))),
    Advice("cannot be set ({}); edit it in the file", in_order(added(RECIPE, FRIZZ),
        asked(protocol.Set(changes=[(["shape", 1, "magnitude"], 1)], gesture=1))), in_order(added(RECIPE, FRIZZ),
        asked(protocol.Set(changes=[(["shape", 1, "magnitude"], 1)], gesture=1)))),
    Advice("draw: the stroke has no length; draw a line over the scalp", seen(drawn((0, 0.09, 0), (0, 0.09, 0))),
        seen(LINE)),
    Advice("is that of a file; choose none for a new one", in_order(wrote("tail.obj", "v 0 9 0\nv 0 9 3\nl 1 2\n"),
        added(RECIPE, TAIL + PART), seen(LINE)), seen(put("guides.part_line", None), LINE)),
    Advice("draw: the guide begins {} mm off the scalp; begin it where the hair grows", seen(drawn((0, 0.2, 0), (0, 0.3,
        0), place="guides.drawn")), seen(UP)),
    Advice("message: {} must be the first of a page", asked(protocol.Hello(version=1, client="one")), asked(SAVE)),
    Advice("holds no recipe to edit; open a recipe or a shot that names one", asked(FIRST, file="hair.usdc"),
        in_order(asked(FIRST), asked(FIRST, file=SHOT))),
    Advice("has several grooms; locks and guides are edited by hand in the recipe of one: open it", in_order(SEVERAL,
        seen(SCULPT, file="all.recipe.toml")), seen(protocol.Open(name=RECIPE), shown, SCULPT,
        file="all.recipe.toml")),
    Advice("cannot be kept there ({}); make room, or name another folder by the variable TMPDIR", full,
        lambda: FrameCache().add(1.0, b"frame")),
    Advice("holds unsaved changes that cannot be read; look into it", journal("no"), in_order(
        lambda: Path(".a.toml.unsaved.unreadable").read_text(), lambda: Journal(Path("a.toml")).read())),
    Advice("lock {} is edited in another file; return it there, or with: ringlet edit {} --release {}", in_order(EDITS,
        line(f"edit {RECIPE} --freeze {LOCK}"), asked(BACK)), in_order(line(f"edit {RECIPE} --release {LOCK}"),
        asked(BACK))),
    Advice("lock {} is not isolated; isolate it before it is dragged", seen(DRAG), seen(OUT, DRAG)),
    Advice("lock {} has points 1 to {} to drag; there is none at {}", seen(OUT, DRAG.model_copy(update={"point": 0})),
        seen(OUT, DRAG)),
    Advice("paint: the map of directions has no colours; name another one, or none for a new one", in_order(UNWRAP,
        GREY, added(RECIPE, '[maps]\nm = "grey.png"\n'), seen(put("guides.direction", "m"),
        paint("guides.direction"))), asked(put("guides.direction", None), shown, paint("guides.direction"))),
    Advice("note: is empty; write something, or draw", asked(protocol.WriteNote(text=" ", look=LOOK)), in_order(
        asked(protocol.WriteNote(text="a", look=LOOK)), asked(protocol.WriteNote(text="", look=LOOK, strokes=[[(0,
        1)]])))),
    Advice("keep their order, and others follow them; move them in {}, or give {} [[shape]] tables of its own",
        in_order(added(RECIPE, FRIZZ), VARIANT, asked(FIRST, file="b.recipe.toml")), in_order(asked(FIRST),
        added("b.recipe.toml", FRIZZ), asked(FIRST, file="b.recipe.toml"))),
    Advice("paint: '{}' is no picture of [maps]; choose one of them, or none for a new one", in_order(UNWRAP,
        seen(put("guides.length", {"value": 5, "map": "m"}), paint())), in_order(GREY,
        asked(put("guides.length", 5), shown, paint(), put("maps.m", "grey.png"), put("guides.length.map", "m"),
        paint()))),
    Advice("shot: run {} is not kept; choose one that the timeline lists", asked(protocol.UseRun(run=1), file=SHOT),
        seen(START, waited, put("preroll", 1, "shot"), START, waited, protocol.UseRun(run=1), file=SHOT)),
    Advice("{}: is replaced again and again; open it when it is done", patched(seen(AGAINST, file=SHOT),
        lambda: patch.object(WatchedFile, "unchanged", lambda self: False)), seen(AGAINST, file=SHOT)),
    Advice("shot: its groom is still being made; wait until it is shown", asked(START, file=SHOT), seen(START, waited,
        file=SHOT)),
    Advice("{}: its unit is {}, that of the recipe is {}; must be the same", in_order(wrote("b.preset.toml",
        PRESET.replace("[", 'unit = "m"\n[')), asked(TAKE)), in_order(wrote("b.preset.toml", PRESET), asked(TAKE))),
    Advice("is not written as a table [{}]; edit it in the file", in_order(wrote("b.preset.toml", PRESET),
        changed(RECIPE, ("[curl]\nwidth = 1.0\npitch = 1.5\n", ""), ("ringlet = 2",
        "ringlet = 2\ncurl = { width = 1, pitch = 2 }")), asked(TAKE)), in_order(changed(RECIPE,
        ("curl = { width = 1, pitch = 2 }", "")), added(RECIPE, "[curl]\nwidth = 1\npitch = 2\n"), asked(TAKE))),
    Advice("{}: {} names a file; a preset has settings alone", in_order(wrote("b.preset.toml", PRESET + TAIL),
        asked(TAKE)), in_order(wrote("b.preset.toml", PRESET), asked(TAKE))),
    Advice("reference: {} is a {} file; must be PNG or JPEG", reference(".gif"), reference(".png")),
    Advice("render: the camera is where it looks at; move it", camera(0, 0, 0), camera(0, 0, 1)),
    Advice("render: the camera looks straight down or up; turn it", camera(0, 1, 0), camera(0, 1, 0.1)),
    Advice("render: the groom is still being made; wait until it is shown", asked(protocol.Render(number=1,
        camera=[0, 0, 1, 0, 0, 0], width=16, height=16)), patched(seen(protocol.Render(number=1, camera=[0, 0, 1, 0, 0,
        0], width=16, height=16)), lambda: patch.object(rendering, "RenderProcess"))),
    Advice("there is no {}; it may have been deleted", asked(protocol.EditNote(id="a", text="b")), in_order(
        asked(protocol.WriteNote(text="a", look=LOOK)), asked(lambda session: session._review.notes.delete(
        next(iter(session._review.notes.entries)))))),
    Advice("{}: there are {}; delete some first", in_order(*(entry(f"references/{k}.toml", "") for k in range(24)),
        asked(protocol.AddReference(name="", picture=snapshots.picture()))), asked(protocol.DeleteReference(id="7"),
        protocol.AddReference(name="", picture=snapshots.picture()))),
    Advice("pixels; must be at most {} on each side", asked(snapshot(snapshots.picture(size=(9000, 1)))),
        asked(snapshot(snapshots.picture(size=(8192, 1))))),
    Advice("{}: is no picture; must be a PNG or JPEG file", asked(snapshot("aGVsbG8=")), in_order(
        asked(snapshot(snapshots.picture())), asked(snapshot(snapshots.picture(kind="JPEG"))))),
    Advice("{}/{}: cannot be read ({}); mend it, or remove it", in_order(entry("notes/a.toml", "no"),
        asked(lambda session: session._review._folder.read("notes/a.toml", Stored))), in_order(entry("notes/a.toml",
        LOOKED), asked(lambda session: session._review._folder.read("notes/a.toml", Stored)))),
    Advice("--host {}: cannot be listened on; choose an address of this computer", listen("203.0.113.7", None),
        listen("127.0.0.1", None)),
    Advice("--port {}: cannot be used on {} ({}); choose another", taken_port, listen("127.0.0.1", 0)),
    Advice("{}: {}; give a recipe, a shot or a USD file", viewed("gone.toml"), viewed(RECIPE)),
    Advice("{}: the page was not built; build it with: make build", patched(lambda: share_page._built("share.js"),
        lambda: patch.object(share_page, "STATIC", Path("share"))), page()),
    Advice("was changed since its copy was saved; save a copy again", asked(protocol.Save(name="c"), WIDER,
        protocol.UseCopy(), file=SHOT), asked(WIDER, protocol.Save(name="d"), protocol.UseCopy(), file=SHOT)),
    Advice("{}: has {} points at frame {}, {} at its first; make it again", moving(2), moving(3)),
    Advice("belongs to another groom than the shot; choose a cache of the same groom", in_order(changed(RECIPE,
        ("count = 8", "count = 9")), seen(AGAINST, file=SHOT)), in_order(line(
        f"sim {SHOT} -o new.usdc"), seen(protocol.Against(name="new.usdc"), file=SHOT))),
    Advice("{}: has no hair; give a recipe, a shot or a USD file with curves", asked(SAVE, file="head.usda"), in_order(
        asked(SAVE), asked(SAVE, file=SHOT), asked(protocol.Cancel(), file="hair.usdc"))),
    Advice("has [[sculpt]] tables of its own; move them to the file that 'edits' names", in_order(added(RECIPE,
        "[[sculpt]]\nguide = 3\nlength = 1.5\n"), seen(SCULPT)), in_order(changed(RECIPE,
        ("[[sculpt]]\nguide = 3\nlength = 1.5\n", "")), EDITS, wrote("small.edits.toml",
        "ringlet = 2\n[[sculpt]]\nguide = 3\nlength = 1.5\n"), seen(SCULPT))),
    Advice("another page leads this session; take the lead to edit", lambda: two_pages(ask=False),
        lambda: two_pages(ask=True)),
    Advice("share: the groom is still being made; wait until it is shown", lambda: share_page.make_page({}, RECIPE,
        {}), page()),
    Advice("does not fit into {} MB; share fewer locks, or a coarser head", page(9_000), in_order(changed(RECIPE,
        ("count = 8", "count = 1")), page(9_000))),
    Advice("shot: the run cannot continue from frame {}; run it from its start", seen(protocol.Play(action="again_from",
        frame=2), file=SHOT), seen(START, waited, protocol.Play(action="again_from", frame=2), waited, file=SHOT)),
    Advice("snapshot: {}{} is gone; delete the snapshot", in_order(entry("snapshots/a.toml", LOOKED),
        asked(protocol.LoadSnapshot(id="a"))), asked(protocol.DeleteSnapshot(id="a"))),
    Advice("has no texture coordinates (st) to paint over; unwrap it", seen(paint()), in_order(UNWRAP, seen(paint()))),
    Advice("cannot say all that was changed; save a copy instead", in_order(added(RECIPE,
        "[[edit]]\nlock = 19000000\nmove = [{ at = 1.0, by = [0, 0, 1] }]\n"), asked(BACK, protocol.Save(name="b",
        variant=True))), asked(BACK, protocol.Save(name="b"))),
    Advice("save: {} cannot be removed in a variant; save a copy instead", asked(put("locks.count", None),
        protocol.Save(name="b", variant=True)), asked(put("locks.count", None), protocol.Save(name="b"))),
    Advice("{}: the groom is still being made; wait until it is shown", asked(SCULPT), seen(SCULPT)),
]  # fmt: skip
ROWS = [*FARM, *HOST, *PICTURES, *REVIEW]
