"""``ringlet serve`` as another program uses it: a process, messages, and one line for every mistake."""

from __future__ import annotations

import io
import json
import os
import random
import signal
import sys
import threading
import time
from collections import Counter
from pathlib import Path

import numpy as np
import pytest
from ringlet.host.link import BrokenMessage, RingletProcess, read_message, write_message
from ringlet.host.server import Server

import ringlet

RECIPE = """
ringlet = 2

[scalp] # a ball
file = "head.usdc"
mesh = "/scene/ball"

[guides]
count = 12
length = 5 # cm

[locks]
count = 20
points = 60

[curl]
width = 1.0
pitch = 1.5

[hairs]
per_lock = 3
"""
SHOT = """
ringlet = 2
groom = "a.recipe.toml"
frames = [1, 4]
preroll = 0
"""


def ball(radius: float = 0.09, rings: int = 8, sides: int = 12) -> dict[str, np.ndarray]:
    """A sphere of quads and triangles, Z up."""
    polar = np.linspace(0, np.pi, rings + 1)[1:-1]
    around = np.linspace(0, 2 * np.pi, sides, endpoint=False)
    belts = np.stack(
        [np.outer(np.sin(polar), np.cos(around)), np.outer(np.sin(polar), np.sin(around)),
         np.repeat(np.cos(polar)[:, None], sides, axis=1)], axis=-1
    )  # fmt: skip
    points = radius * np.concatenate([[[0, 0, 1]], belts.reshape(-1, 3), [[0, 0, -1]]])
    last, faces = len(points) - 1, []
    for k in range(sides):
        n = (k + 1) % sides
        faces.append([0, 1 + k, 1 + n])
        for ring in range(rings - 2):
            a, b = 1 + ring * sides, 1 + (ring + 1) * sides
            faces.append([a + k, b + k, b + n, a + n])
        faces.append([last, last - sides + n, last - sides + k])
    return {
        "points": points.astype(np.float32),
        "counts": np.array([len(face) for face in faces], np.int32),
        "indices": np.concatenate(faces).astype(np.int32),
    }


def start_process() -> RingletProcess:
    command = [sys.executable, "-c", "import ringlet.cli; ringlet.cli.main()", "serve"]
    return RingletProcess(command, {**os.environ, "OMP_NUM_THREADS": "1"})


class Host:
    """A host that waits for its answers."""

    def __init__(self, process: RingletProcess, folder: Path) -> None:
        self.process = process
        self.folder = folder
        self.before: dict[int, list[dict]] = {}  # progress and warnings of each request

    def send(self, do, arrays=None, **fields) -> int:
        if do not in ("hello", "look", "cancel"):
            fields["folder"] = str(self.folder)
        return self.process.send(do, arrays, **fields)

    def wait(self, number: int, until=("result", "error", "canceled"), seconds: float = 300.0):
        end = time.monotonic() + seconds
        while time.monotonic() < end and self.process.alive:
            for message in self.process.poll():
                header = message.header
                if header["id"] == number and header["kind"] in until:
                    return message
                self.before.setdefault(header["id"], []).append(header)
            time.sleep(0.01)
        raise AssertionError(f"no answer to {number}: {self.process.last_words}")

    def ask(self, do, arrays=None, **fields):
        return self.wait(self.send(do, arrays, **fields))

    def send_head(self, **more) -> None:
        head = ball()
        arrays = {f"0/{name}": values for name, values in {**head, **more}.items()}
        answer = self.ask("write_meshes", arrays, file="head.usdc", up_axis="Z", meshes=[{"name": "ball"}])
        assert answer.header["kind"] == "result", answer.header


@pytest.fixture(scope="module")
def process():
    """One process for all hosts: each has a folder of its own."""
    started = start_process()
    yield started
    started.stop()


@pytest.fixture
def host(process, tmp_path):
    return Host(process, tmp_path)


def recipe(text: str = RECIPE, *changes) -> dict:
    return {"name": "a.recipe.toml", "text": text, "changes": list(changes)}


def test_a_message_comes_back_with_its_arrays():
    stream = io.BytesIO()
    arrays = {"points": np.arange(6, dtype=np.float32).reshape(2, 3), "none": np.empty((0, 3), np.int64)}
    write_message(stream, {"id": 3, "text": "lock\nñ"}, arrays)
    stream.seek(0)
    header, back = read_message(stream)
    assert header == {"id": 3, "text": "lock\nñ"}
    for name, values in arrays.items():
        assert back[name].dtype == values.dtype
        np.testing.assert_array_equal(back[name], values)
    assert read_message(stream) is None


@pytest.mark.parametrize(
    "bytes_", [b"no\n", b"[1]\n", b'{"arrays":[["a","<f4",[4]]]}\nab', b'{"arrays":[["a","O",[1]]]}\n']
)
def test_bytes_that_are_no_message_are_refused(bytes_):
    with pytest.raises(BrokenMessage):
        read_message(io.BytesIO(bytes_))


def answers(*lines: bytes, seconds: float = 60.0) -> list[dict]:
    """What a server answers to bytes, in the order of its answers."""
    stream = io.BytesIO()
    server = Server(io.BytesIO(b"".join(lines)), stream)
    while server.take_next():
        pass
    server.stop(seconds)
    stream.seek(0)
    found = []
    while (message := read_message(stream)) is not None:
        found.append(message.header)
    return found


HELLO = b'{"id":99,"do":"hello"}\n'


@pytest.mark.parametrize(
    ("line", "number", "words"),
    [
        (b'{"id":1e400,"do":"hello"}', None, "id is inf; must be"),
        (b'{"id":NaN,"do":"hello"}', None, "id is nan; must be"),
        (b'{"id":{"a":[]},"do":"hello"}', None, "must be a whole number"),
        (b'{"id":' + b"9" * 5000 + b"}", None, "a line of JSON"),
        (b'{"id":7,"do":1e400}', 7, "do is 'inf'; there are: hello"),
        (b'{"id":7,"do":"look","name":"\\ud800"}', 7, "half of a UTF-16 pair; write it in UTF-8"),
        (b'{"id":7,"do":"look","name":"\\u0000"}', 7, "a character of code 0; take it out"),
        (b'{"id":7,"do":"edit","folder":"/","kind":"shot","text":{"name":"..","text":""}}', 7, "text.name is '..'"),
        (b'{"id":7,"do":"hello","arrays":[["a","<f4",[1e400]]]}', 7, "a line of JSON"),
        (b'{"id":7,"do":"hello","arrays":[["a","<f4",[99999999999]]]}', 7, "cannot be read"),
        (b'{"id":7,"do":"hello","arrays":[["a","O",[1]]]}', 7, "cannot be read"),
        (b'{"id":7,"do":"hello","arrays":{"a":1}}', 7, "a line of JSON"),
        (b'{"id":7,' + b'"a":[' * 100_000, None, "a line of JSON"),
        (b"\xff\xfe", None, "a line of JSON"),
        (b"null", None, "a line of JSON"),
        (b"", None, "a line of JSON"),
    ],
)
def test_a_message_that_is_none_is_answered_and_the_next_one_too(line, number, words):
    wrong, hello = answers(line + b"\n", HELLO)
    assert wrong["kind"] == "error" and wrong["id"] == number and words in wrong["message"]
    assert hello["kind"] == "result" and hello["id"] == 99


def test_a_line_that_is_too_long_is_answered_and_the_next_one_too(monkeypatch):
    monkeypatch.setattr("ringlet.host.link.MOST_HEADER", 20_000)
    wrong, hello = answers(b'{"id":1,"do":"' + b"x" * 50_000 + b'"}\n', HELLO)
    assert "must be a line of at most 20,000 bytes" in wrong["message"] and hello["kind"] == "result"


def test_an_id_of_a_request_in_progress_is_refused(monkeypatch):
    release = threading.Event()
    monkeypatch.setattr("ringlet.host.server.texts.looks", lambda: release.wait() and [])
    monkeypatch.setattr(Server, "stop", lambda self, patience: release.set() or [w.stop(9) for w in self._workers])
    refused, hello = answers(HELLO, HELLO)
    assert "id 99 is that of a request in progress" in refused["message"] and hello["kind"] == "result"


ODD = [None, True, -1, 2.5, 10**30, float("inf"), float("nan"), "", "\ud800", "\0", "x" * 5000, [], {}, [[1]], "loop"]


def some_message(rng: random.Random, number: int, folder: Path) -> bytes:
    """A request, of which parts are odd."""
    text = {"name": "a.recipe.toml", "text": rng.choice([RECIPE, "ringlet = 2", "x = " + "[" * 400, "a = 1e400"])}
    text["changes"] = [{"set": ["curl", rng.choice(ODD)], "value": rng.choice(ODD)}] * rng.randrange(2)
    fields = {
        "look": {"name": "3C"},
        "cancel": {"request": number - 1},
        "write_curves": {"folder": str(folder), "file": "c.usdc"},
        "edit": {"folder": str(folder), "kind": "recipe", "text": text},
        "groom": {"folder": str(folder), "recipe": text, "hairs": 0.5},
        "hairs": {"folder": str(folder / "loop"), "cache": "c.usdc"},
        "simulate": {"folder": str(folder), "recipe": text, "shot": {"name": "s.shot.toml", "text": SHOT}},
    }
    do = rng.choice([*fields])
    request = {"do": do, **fields[do]}
    if rng.random() < 0.7:
        request[rng.choice([*request, "more"])] = rng.choice([*ODD, str(folder / "file"), "n" * 300])
    line = json.dumps({"id": number, **request}, ensure_ascii=rng.random() < 0.8).encode("utf-8", "surrogatepass")
    if rng.random() < 0.2:
        line = line[: rng.randrange(len(line))]
    return line + b"\n"


def test_every_message_of_any_content_is_answered_once_and_without_a_mistake(tmp_path):
    (tmp_path / "loop").symlink_to("loop")
    (tmp_path / "file").touch()
    rng = random.Random(53)
    lines = [some_message(rng, number, tmp_path) for number in range(100, 300)]
    found = [one for one in answers(*lines, HELLO) if one["kind"] not in ("progress", "warning")]
    messages = [one.get("message", "") for one in found]
    assert not [message for message in messages if "mistake in Ringlet" in message or "\n" in message]
    numbers = Counter(one["id"] for one in found if one["id"] is not None)
    assert max(numbers.values()) == 1 and numbers[99] == 1 and len(numbers) > 100


def test_a_host_grooms_its_own_mesh_in_its_own_axes(host):
    hello = host.ask("hello").header
    assert hello["protocol"] == 1 and hello["version"] == ringlet.__version__
    assert {"name": "3C", "group": "types"} in hello["looks"]
    host.send_head()
    answer = host.ask("groom", recipe=recipe(), hairs=1.0)
    assert answer.header["counts"] == {"guides": 12, "locks": 20, "hairs": 60}
    roots = answer.arrays["locks/points"][np.cumsum([0, *answer.arrays["locks/counts"][:-1]])]
    np.testing.assert_allclose(np.linalg.norm(roots, axis=1), 0.09, rtol=0.06)  # on the faceted ball
    assert (host.folder / "a.recipe.toml").read_text() == RECIPE


def test_a_changed_setting_keeps_the_comments_of_the_text(host):
    host.send_head()
    before = host.ask("groom", recipe=recipe(), hairs=None).arrays["guides/points"]
    after = host.ask("groom", recipe=recipe(RECIPE, {"set": ["guides", "length"], "value": 10}), hairs=None)
    assert after.header["kind"] == "result", after.header
    assert after.header["text"] == RECIPE.replace("length = 5", "length = 10")
    assert after.header["settings"]["guides"]["length"]["value"] == pytest.approx(0.1)
    far = [np.abs(points).max() for points in (before, after.arrays["guides/points"])]
    assert far[1] > far[0] + 0.02
    added = host.ask("edit", kind="recipe", text=recipe(RECIPE, {"add": "shape", "at": 0, "entry": {"op": "frizz"}}))
    assert '[[shape]]\nop = "frizz"' in added.header["text"]


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"set": ["guides", "length"], "value": -2}, "guides.length is -0.02 m; must be at least"),
        ({"set": ["guides", "lenght"], "value": 2}, "guides.lenght is not a setting"),
        ({"sett": ["guides"], "value": 2}, "request: "),
    ],
)
def test_a_mistake_is_one_line_and_the_process_goes_on(host, change, message):
    host.send_head()
    answer = host.ask("groom", recipe=recipe(RECIPE, change), hairs=None)
    assert answer.header["kind"] == "error" and message in answer.header["message"]
    assert "\n" not in answer.header["message"]
    assert not (host.folder / "a.recipe.toml").exists()
    assert host.ask("groom", recipe=recipe(), hairs=None).header["kind"] == "result"


@pytest.mark.parametrize(
    ("name", "values", "message"),
    [
        ("indices", np.full(3, 7, np.int32), "indices has the shape (3,)"),
        ("points", np.full((86, 3), np.nan, np.float32), "points has a value that is not finite"),
        ("uv", np.zeros((4, 2), np.float32), "uv has the shape"),
        ("map/density", np.zeros(4, np.float32), "map density has the shape"),
    ],
)
def test_arrays_that_do_not_fit_are_refused_and_nothing_is_written(host, name, values, message):
    arrays = {f"0/{key}": array for key, array in {**ball(), name: values}.items()}
    answer = host.ask("write_meshes", arrays, file="head.usdc", meshes=[{"name": "ball"}]).header
    assert answer["kind"] == "error" and message in answer["message"]
    assert list(host.folder.iterdir()) == []


def test_an_overlay_counts_and_stays_out_of_the_text(host):
    host.send_head()
    drawn = {
        "points": np.float32([[0, 0, 0.09], [0, 0, 0.12], [0, 0.01, 0.09], [0, 0.02, 0.12]]),
        "counts": np.int32([2, 2]),
    }
    host.ask("write_curves", drawn, file="guides.usdc", up_axis="Z")
    overlay = [{"set": ["guides"], "value": {"file": "guides.usdc"}}]
    answer = host.ask("groom", recipe={**recipe(), "overlay": overlay}, hairs=None).header
    assert answer["kind"] == "result", answer
    assert answer["counts"]["guides"] == 2 and answer["text"] == RECIPE
    assert "guides.usdc" in (host.folder / "a.recipe.toml").read_text()


def test_maps_regions_and_drawn_guides_of_a_host_reach_the_recipe(host):
    head = ball()
    top = np.flatnonzero(head["points"][head["indices"]].reshape(-1, 3)[:, 2] > 0.08)
    counts = head["counts"]
    faces = np.unique(np.repeat(np.arange(len(counts)), counts)[top]).astype(np.int32)
    host.send_head(**{"region/crown": faces, "map/long": (head["points"][:, 0] > 0).astype(np.float32)})
    grown = host.ask(
        "groom", recipe=recipe(RECIPE.replace("[guides]", 'region = "crown"\n[guides]')), hairs=None
    ).arrays
    assert grown["guides/points"][:, 2].min() > 0.05
    drawn = {"points": grown["guides/points"], "counts": grown["guides/counts"], "ids": grown["guides/ids"]}
    assert host.ask("write_curves", drawn, file="guides.usdc", up_axis="Z").header["curves"] == 12
    text = RECIPE.replace("count = 12\nlength = 5 # cm", 'file = "guides.usdc"')
    back = host.ask("groom", recipe=recipe(text), hairs=None)
    assert back.arrays["guides/ids"].tolist() == grown["guides/ids"].tolist()
    np.testing.assert_allclose(back.arrays["guides/points"], grown["guides/points"], atol=1e-5)


def test_recipes_whose_names_become_alike_are_variants_of_their_own(host):
    host.send_head()
    names = ["Kim curls", "Kim_curls", "base", "Kim.curls"]
    longer = [RECIPE.replace("length = 5", f"length = {6 + k}") for k in range(4)]
    texts = [{**recipe(text), "name": f"{name}.recipe.toml"} for name, text in zip(names, longer, strict=True)]
    answer = host.ask("write_groom", recipe=recipe(), file="groom.usdc", variants=texts).header
    assert answer["variants"] == ["Kim_curls_2", "Kim_curls", "base_2", "Kim_curls_3"]
    lengths = [ringlet.read_groom(answer["path"], variant=name).guides.lengths().mean() for name in answer["variants"]]
    base = ringlet.read_groom(answer["path"]).guides.lengths().mean()
    np.testing.assert_allclose(np.divide(lengths, base), [1.2, 1.4, 1.6, 1.8], rtol=1e-3)


def test_a_canceled_shot_is_resumed_to_the_same_bits(host):
    head = ball()
    turn = np.stack([head["points"] + np.float32([0.01 * k, 0, 0]) for k in range(6)])
    host.send_head(motion=turn)
    whole = {"recipe": recipe(), "shot": {"name": "a.shot.toml", "text": SHOT}}
    assert host.ask("simulate", **whole, cache="one.usdc").header["frames"] == [1, 2, 3, 4]
    number = host.send("simulate", **whole, cache="two.usdc")
    host.wait(number, until=("progress",))
    host.send("cancel", request=number)
    canceled = host.wait(number).header
    if canceled["kind"] == "canceled":  # a fast machine may be done
        assert not (host.folder / "two.usdc").exists()
        assert host.ask("simulate", **whole, cache="two.usdc", resume=True).header["kind"] == "result"
    one, two = (ringlet.read_cache(host.folder / f"{name}.usdc").points for name in ("one", "two"))
    np.testing.assert_array_equal(one, two)
    hairs = host.ask("hairs", cache="one.usdc").header
    assert hairs["counts"]["hairs"] == 60 and Path(hairs["path"]).exists()


def test_a_killed_process_is_noticed_and_leaves_no_half_of_a_file(tmp_path):
    host = Host(start_process(), tmp_path)
    host.send_head()
    host.ask("groom", recipe=recipe(), hairs=None)
    os.kill(host.process.pid, signal.SIGKILL)
    end = time.monotonic() + 5
    while host.process.alive and time.monotonic() < end:
        time.sleep(0.01)
    assert not host.process.alive
    host.process.send("hello")  # is lost, and does not block
    assert sorted(path.name for path in host.folder.iterdir()) == ["a.recipe.toml", "head.usdc"]
