"""The server: static files of the page, and one websocket for messages."""

from __future__ import annotations

import asyncio
import hmac
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager, suppress
from pathlib import Path

from fastapi import FastAPI, Request, Response, WebSocket, WebSocketDisconnect
from fastapi.staticfiles import StaticFiles
from starlette.middleware.base import RequestResponseEndpoint

from ringlet.data.errors import UserError, failure
from ringlet.viewer import protocol
from ringlet.viewer.pages import Page
from ringlet.viewer.session import Session
from ringlet.viewer.wire import trouble, unpack

STATIC = Path(__file__).with_name("static")
LOOPBACK = ("localhost", "127.0.0.1", "[::1]")
MAX_PAGES = 32
HELLO_TIMEOUT = 10.0  # seconds
LONG = 10.0  # seconds after which a page learns that its message is still worked on
MAX_INVALID_MESSAGES = 20  # invalid messages of a page before the server closes its socket

REFUSED, WRONG = 4403, 4400  # close codes of the protocol

# Content policy: the page loads from this server only, and no other page may embed it.
POLICY = (
    "default-src 'self'; img-src 'self' data: blob:; style-src 'self' 'unsafe-inline'; connect-src 'self' ws: wss:; "
    "frame-ancestors 'none'; base-uri 'none'; form-action 'none'; object-src 'none'"
)


class AccessControl:
    """Access control: checks the host name, the origin and the token of a request.

    host:  address that the server listens on; any other than loopback needs a token
    token: token that a page must send; empty for none
    """

    def __init__(self, host: str, token: str) -> None:
        self.names = {*LOOPBACK, host}
        self.anywhere = host in ("0.0.0.0", "::")
        self.token = token

    def accepts_host(self, host: str) -> bool:
        """Whether a Host header names this server; prevents DNS rebinding."""
        return self.anywhere or _without_port(host) in self.names

    def accepts(self, host: str, origin: str | None, token: str) -> bool:
        """Whether a websocket may open: for a page of the same origin that sends the token."""
        same_origin = origin is None or origin.partition("://")[2] == host
        return self.accepts_host(host) and same_origin and hmac.compare_digest(token.encode(), self.token.encode())


def make_app(session: Session, access: AccessControl, static: Path = STATIC) -> FastAPI:
    """The application of one session."""

    @asynccontextmanager
    async def lifespan(_: FastAPI) -> AsyncIterator[None]:
        session.start(asyncio.get_running_loop())
        yield
        session.stop()

    app = FastAPI(lifespan=lifespan, openapi_url=None, docs_url=None, redoc_url=None)

    @app.middleware("http")
    async def guard(request: Request, proceed: RequestResponseEndpoint) -> Response:
        if not access.accepts_host(request.headers.get("host", "")):
            return Response("this server does not go by that name\n", status_code=421)
        response = await proceed(request)
        response.headers["Content-Security-Policy"] = POLICY
        response.headers["X-Content-Type-Options"] = "nosniff"
        response.headers["Referrer-Policy"] = "no-referrer"
        response.headers["Cache-Control"] = "no-cache"
        return response

    @app.websocket("/session")
    async def talk(socket: WebSocket) -> None:
        headers, token = socket.headers, socket.query_params.get("token", "")
        await socket.accept()
        if not access.accepts(headers.get("host", ""), headers.get("origin"), token):
            await socket.close(REFUSED, "the token or the origin is wrong")
            return
        if len(session.pages) >= MAX_PAGES:
            await socket.close(REFUSED, "too many pages look at this session")
            return
        with suppress(WebSocketDisconnect, RuntimeError):
            await _serve(socket, session)

    if static.is_dir():
        app.mount("/", StaticFiles(directory=static, html=True))
    return app


async def _serve(socket: WebSocket, session: Session) -> None:
    """Serves one page until it disconnects."""
    try:
        hello = unpack(await asyncio.wait_for(socket.receive_bytes(), HELLO_TIMEOUT))
    except (UserError, KeyError, TimeoutError):
        hello = None
    if not isinstance(hello, protocol.Hello) or hello.version != protocol.VERSION:
        await socket.close(WRONG, f"expected hello of version {protocol.VERSION}; reload the page")
        return
    page = await asyncio.wrap_future(session.submit(session.join, hello.client, hello.leads, hello.person))
    sending = asyncio.create_task(_send(socket, page))
    try:
        await _receive(socket, session, page)
    finally:
        sending.cancel()
        session.submit(session.leave, page)


async def _send(socket: WebSocket, page: Page) -> None:
    with suppress(WebSocketDisconnect, RuntimeError):
        while True:
            await socket.send_bytes(await page.queue.next())


async def _receive(socket: WebSocket, session: Session, page: Page) -> None:
    invalid_messages = 0
    while True:
        try:
            data = await socket.receive_bytes()
        except KeyError:  # a text message; the page sends binary ones only
            await socket.close(WRONG, "messages are binary")
            return
        try:
            message = unpack(data)
            handled = asyncio.wrap_future(session.submit(session.handle, page, message))
            await asyncio.wait([handled], timeout=LONG)
            if not handled.done():
                page.queue.put("slow", trouble(f"message: {message.kind} takes over {LONG:g} s; it is still worked on"))
            await handled
        except UserError as error:
            invalid_messages += 1
            page.queue.put("trouble", trouble(str(error)))
            if invalid_messages > MAX_INVALID_MESSAGES and not isinstance(error.__cause__, UserError):
                await socket.close(WRONG, "too many messages were wrong")
                return
        except Exception as error:
            page.queue.put("trouble", trouble(failure(f"a message of {page.name} could not be handled", error)))


def _without_port(host: str) -> str:
    return host.rsplit(":", 1)[0] if host.rsplit(":", 1)[-1].isdigit() else host
