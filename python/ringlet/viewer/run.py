"""Starts the server and opens a browser on it."""

from __future__ import annotations

import logging
import secrets
import socket
import threading
import webbrowser
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING

from ringlet.data.errors import UserError
from ringlet.data.extras import need
from ringlet.data.reads import unrecorded
from ringlet.viewer.project import Project
from ringlet.viewer.session import Session
from ringlet.viewer.wire import MOST

if TYPE_CHECKING:
    import uvicorn

DEFAULT_PORT = 8642


@unrecorded()
def view(
    file: Path | str,
    *,
    port: int | None = None,
    host: str = "127.0.0.1",
    browser: bool = True,
    project: Path | str | None = None,
    told: Callable[[str], None] = print,
    until: threading.Event | None = None,
) -> None:
    """Serves the review page of a recipe, a shot or a USD file with hair, until it is interrupted.

    port:    port to listen on; by default 8642, or any free one when that is taken
    host:    address to listen on; any other than loopback needs a token, which is part of the announced address
    browser: opens a browser
    project: folder that the page may read and write; by default the folder of the file
    told:    called with a line that has the address
    until:   stops the server when set, for a server in a thread

    Raises UserError for a missing file, an unusable port or host, a page that was not built, and without the packages
    of the extra ``review``.
    """
    need("fastapi", "uvicorn", "websockets")
    import uvicorn  # an extra brings what serves the page

    from ringlet.viewer.server import LOOPBACK, STATIC, AccessControl, make_app

    file = Path(file)
    if not file.is_file():
        wrong = "is a folder" if file.is_dir() else "there is no such file"
        raise UserError(f"{file}: {wrong}; give a recipe, a shot or a USD file")
    if not (STATIC / "index.html").exists():
        raise UserError(f"{STATIC}: the page was not built; build it with: make build")
    token = "" if host in LOOPBACK else secrets.token_urlsafe(18)
    session = Session(file.resolve(), Project(Path(project) if project else file.resolve().parent))
    app = make_app(session, AccessControl(host, token))
    listening = _listen(host, port)
    address = f"http://{_url_host(host)}:{listening.getsockname()[1]}/" + (f"#{token}" if token else "")
    config = uvicorn.Config(
        app, log_level="error", ws_max_size=MOST, ws_per_message_deflate=False, timeout_graceful_shutdown=1
    )
    told(f"ringlet view: {file.name} at {address}  (Ctrl-C ends it)")
    if browser:
        threading.Thread(target=webbrowser.open, args=[address], daemon=True).start()
    logging.getLogger("asyncio").setLevel(logging.ERROR)  # that a page left is no warning
    server = uvicorn.Server(config)
    if until is not None:
        threading.Thread(target=_stop_when_set, args=(server, until), daemon=True).start()
    server.run(sockets=[listening])


def _stop_when_set(server: uvicorn.Server, until: threading.Event) -> None:
    until.wait()
    server.should_exit = True


def _listen(host: str, port: int | None) -> socket.socket:
    """Opens a listening socket on the port; without one on the default port, or any free one.

    Raises UserError when the port or the host cannot be used.
    """
    for candidate in [DEFAULT_PORT, 0] if port is None else [port]:
        listening = socket.socket(socket.AF_INET6 if ":" in host else socket.AF_INET)
        listening.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        try:
            listening.bind((host, candidate))
            listening.listen()  # what connects from now on waits until the server runs
        except OSError as error:
            listening.close()
            if port is not None:
                raise UserError(
                    f"--port {port}: cannot be used on {host} ({error.strerror}); choose another"
                ) from error
            continue
        return listening
    raise UserError(f"--host {host}: cannot be listened on; choose an address of this computer")


def _url_host(host: str) -> str:
    if host in ("0.0.0.0", "::"):
        return socket.gethostname()
    return f"[{host}]" if ":" in host else host
