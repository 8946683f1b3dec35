"""The server of the studio: the page, its modules, and a socket for each tab; on this computer alone.

It answers one user of this computer, and nobody else: guards stand before every page and socket.

| guard | against |
| --- | --- |
| exact list of hosts | a foreign name that is made to resolve to this computer (DNS rebinding) |
| origin present on sockets, and one of ours wherever it is present | scripts of other pages |
| token once, then a cookie | other users and programs of this computer |
| headers of every answer | scripts and frames from elsewhere, were they ever to get into a page |
| length of bodies | filling memory |

Pure ASGI, so that pages and sockets pass the same code.
"""

from __future__ import annotations

import asyncio
import hashlib
import hmac
import mimetypes
import secrets
import socket
from collections.abc import Awaitable, Callable, MutableMapping
from functools import cache
from http.cookies import CookieError, SimpleCookie
from pathlib import Path
from typing import Any
from urllib.parse import parse_qs

import uvicorn
from starlette.applications import Starlette
from starlette.requests import Request
from starlette.responses import HTMLResponse, JSONResponse, Response
from starlette.routing import Mount, Route, WebSocketRoute
from starlette.staticfiles import StaticFiles
from starlette.websockets import WebSocket, WebSocketDisconnect

from linkwright.kernel.errors import InputError
from linkwright.kernel.limits import FILE_BYTES
from linkwright.studio.files import Folder
from linkwright.studio.language import page_texts
from linkwright.studio.session import Session
from linkwright.studio.wire import WireError

Scope = MutableMapping[str, Any]
Message = MutableMapping[str, Any]
Receive = Callable[[], Awaitable[Message]]
Send = Callable[[Message], Awaitable[None]]
App = Callable[[Scope, Receive, Send], Awaitable[None]]

# Only what the server itself serves; nothing of it may be framed, and no address leaks to elsewhere.
_HEADERS = (
    (
        b"content-security-policy",
        # Maps of colours in diagrams are pictures within them.
        b"default-src 'self'; img-src 'self' data:; base-uri 'none'; form-action 'none'; "
        b"frame-ancestors 'none'",
    ),
    (b"x-content-type-options", b"nosniff"),
    (b"referrer-policy", b"no-referrer"),
    (b"cross-origin-opener-policy", b"same-origin"),
    (b"cross-origin-resource-policy", b"same-origin"),
    (b"cache-control", b"no-cache"),
)

# No page of the studio sends a body.
_BODY_BYTES = 0

# Digits of a length; Python reads no number of thousands of them.
_DIGITS = 20

# Code of a socket that breaks the rules (RFC 6455, 7.4.1).
_POLICY = 1008


class Guards:
    """The application behind its guards.

    Parameters
    ----------
    app : callable
        The application.
    port : int
        That it is served on.
    token : str
        Word that opens the door once; the cookie has another.
    """

    def __init__(self, app: App, port: int, token: str) -> None:
        self.app = app
        self.token = token
        self.key = secrets.token_urlsafe(32)
        # Cookies know no ports: two studios side by side need names of their own.
        self.cookie = f"linkwright-{port}"
        self.hosts = frozenset(f"{name}:{port}".encode() for name in ("127.0.0.1", "localhost"))
        self.origins = frozenset(b"http://" + host for host in self.hosts)

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Let pass what is ours, and refuse the rest."""
        if scope["type"] not in ("http", "websocket"):
            return
        is_socket = scope["type"] == "websocket"
        headers = scope["headers"]
        status = self._refused(headers, is_socket=is_socket)
        if status is None and not is_socket and self._brings_token(scope):
            await _redirect(send, self._set_cookie())
            return
        if status is None and not self._is_known(headers):
            status = 403
        if status is not None:
            await _refuse(send, status, is_socket=is_socket)
            return
        await self.app(scope, receive, send if is_socket else _with_headers(send))

    def _refused(self, headers: list[tuple[bytes, bytes]], *, is_socket: bool) -> int | None:
        """Status for a request from elsewhere, or with a body; None for one from here."""
        if _values(headers, b"host") not in ([host] for host in self.hosts):
            return 421
        origins = _values(headers, b"origin")
        if (is_socket and not origins) or len(origins) > 1 or not self.origins.issuperset(origins):
            return 403
        if b"transfer-encoding" in dict(headers):
            return 413
        lengths = _values(headers, b"content-length")
        if any(
            not length.isdigit() or len(length) > _DIGITS or int(length) > _BODY_BYTES for length in lengths
        ):
            return 413
        return None

    def _brings_token(self, scope: Scope) -> bool:
        """Whether the address has the token; it opens once."""
        given = parse_qs(scope["query_string"].decode("latin-1")).get("token", [""])[0]
        if scope["path"] != "/" or not self.token or not _same(given, self.token):
            return False
        self.token = ""
        return True

    def _is_known(self, headers: list[tuple[bytes, bytes]]) -> bool:
        """Whether the cookie is ours."""
        jar: SimpleCookie = SimpleCookie()
        try:
            jar.load(b"; ".join(_values(headers, b"cookie")).decode("latin-1"))
        except CookieError:
            return False
        return self.cookie in jar and _same(jar[self.cookie].value, self.key)

    def _set_cookie(self) -> bytes:
        return f"{self.cookie}={self.key}; Path=/; HttpOnly; SameSite=Strict".encode()


def _same(given: str, known: str) -> bool:
    """Whether two words are the same, in a time that does not tell how far."""
    return hmac.compare_digest(given.encode("utf-8", "replace"), known.encode())


def _values(headers: list[tuple[bytes, bytes]], name: bytes) -> list[bytes]:
    return [value for key, value in headers if key == name]


def _with_headers(send: Send) -> Send:
    """The same way out, with our headers on every answer that has none of its own."""

    async def guarded(message: Message) -> None:
        if message["type"] == "http.response.start":
            given = list(message.get("headers", ()))
            names = {name.lower() for name, _ in given}
            message = {
                **message,
                "headers": [*given, *(header for header in _HEADERS if header[0] not in names)],
            }
        await send(message)

    return guarded


async def _redirect(send: Send, cookie: bytes) -> None:
    """To the page without the token, which then stands neither in the address nor in the history."""
    headers = [(b"location", b"/"), (b"set-cookie", cookie), (b"content-length", b"0"), *_HEADERS]
    await send({"type": "http.response.start", "status": 303, "headers": headers})
    await send({"type": "http.response.body", "body": b""})


async def _refuse(send: Send, status: int, *, is_socket: bool) -> None:
    """End a request without an answer."""
    if is_socket:
        # Before it is accepted: the server answers 403 to the handshake.
        await send({"type": "websocket.close", "code": _POLICY})
        return
    words = b"Refused. Open the address that linkwright studio printed; it opens once.\n"
    headers = [(b"content-type", b"text/plain; charset=utf-8"), (b"content-length", str(len(words)).encode())]
    await send({"type": "http.response.start", "status": status, "headers": [*headers, *_HEADERS]})
    await send({"type": "http.response.body", "body": words})


STATIC = Path(__file__).with_name("static")

# A request brings a machine file and some entries.
MESSAGE_BYTES = 2 * FILE_BYTES.most

# Tabs at once; each may have a process beside.
_TABS = 16

# Codes of a socket that brings no message, and that there is no room for (RFC 6455, 7.4.1).
_NO_MESSAGE, _NO_ROOM = 1003, 1013


class Studio:
    """The application with its door.

    Parameters
    ----------
    folder : Path
        Below which machine files are.
    port : int
        That it is served on; 0 for that of the folder, or a free one where it is taken.
    """

    def __init__(self, folder: Path, port: int = 0) -> None:
        _name_types()
        self.folder = Folder.of(folder)
        self.socket = _bound(port) if port else _bound_for(self.folder.root)
        self.port: int = self.socket.getsockname()[1]
        self.token = secrets.token_urlsafe(32)
        self.tabs = 0
        routes = [
            Route("/", _page),
            Route("/texts/{code}.json", _texts),
            WebSocketRoute("/socket", self._tab),
            Mount("/", StaticFiles(directory=STATIC)),
        ]
        self.app = Guards(Starlette(routes=routes), self.port, self.token)

    def address(self, fragment: str = "") -> str:
        """The address that opens the studio, once; `fragment`: what the page should open, after ``#``."""
        return f"http://127.0.0.1:{self.port}/?token={self.token}" + (f"#{fragment}" if fragment else "")

    def server(self) -> uvicorn.Server:
        """The server, not begun yet."""
        config = uvicorn.Config(
            self.app,
            log_level="warning",
            access_log=False,
            ws="websockets-sansio",
            ws_max_size=MESSAGE_BYTES,
            ws_per_message_deflate=False,
            server_header=False,
            lifespan="off",
            timeout_graceful_shutdown=1,
        )
        return uvicorn.Server(config)

    def run(self) -> None:
        """Serve until interrupted."""
        self.server().run(sockets=[self.socket])

    async def _tab(self, page: WebSocket) -> None:
        """One tab."""
        if self.tabs >= _TABS:
            await page.close(_NO_ROOM)
            return
        self.tabs += 1
        try:
            await page.accept()
            await _converse(page, Session(self.folder, page.send_bytes))
        finally:
            self.tabs -= 1


# What a browser must be told of modules and sheets, which it refuses otherwise.
_TYPES = {".js": "text/javascript", ".mjs": "text/javascript", ".css": "text/css"}


def _name_types() -> None:
    """Set types of files: on Windows they stand in the registry, where any program may have changed them."""
    for ending, kind in _TYPES.items():
        mimetypes.add_type(kind, ending)


# Ports that no service is given (RFC 6335, 6).
_FIRST, _PORTS = 49152, 16384


def _bound_for(root: Path) -> socket.socket:
    """A socket at the port of a folder, or at a free one where that is taken."""
    # What a browser keeps belongs to a port: a studio that starts again after a crash finds it there.
    digest = hashlib.sha256(str(root).encode("utf-8", "surrogateescape")).digest()
    try:
        return _bound(_FIRST + int.from_bytes(digest[:4]) % _PORTS)
    except OSError:
        return _bound(0)


def _bound(port: int) -> socket.socket:
    """A socket of this computer alone."""
    own = socket.socket(socket.AF_INET, socket.SOCK_STREAM)
    # Windows would by SO_REUSEADDR let another program take the port over, or a second studio share it.
    exclusive = getattr(socket, "SO_EXCLUSIVEADDRUSE", None)
    own.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR if exclusive is None else exclusive, 1)
    try:
        own.bind(("127.0.0.1", port))
        own.listen()
    except BaseException:
        own.close()
        raise
    return own


async def _page(request: object) -> HTMLResponse:
    return HTMLResponse(_index())


@cache
def _index() -> str:
    """The page; it asks for all modules at once, which are otherwise known by what imports them alone."""
    modules = sorted([*STATIC.glob("*.js"), *STATIC.glob("vendor/*.mjs")])
    links = "".join(
        f'<link rel="modulepreload" href="{module.relative_to(STATIC).as_posix()}">\n' for module in modules
    )
    return (STATIC / "index.html").read_text(encoding="utf-8").replace("</head>", f"{links}</head>")


async def _texts(request: Request) -> Response:
    try:
        return JSONResponse(page_texts(request.path_params["code"]))
    except InputError:
        # silent: a page in a language that there is none of is not found
        return Response(status_code=404)


async def _converse(page: WebSocket, session: Session) -> None:
    """Hand messages on until the tab closes or sends what is no message."""
    answering = asyncio.create_task(session.run())
    code = None
    try:
        while code is None:
            message = await page.receive()
            if message["type"] == "websocket.disconnect":
                break
            try:
                session.take(message.get("bytes") or b"")
            except WireError:
                code = _NO_MESSAGE
    except WebSocketDisconnect:
        pass
    finally:
        answering.cancel()
        await asyncio.gather(answering, return_exceptions=True)
    if code is not None:
        await page.close(code)
