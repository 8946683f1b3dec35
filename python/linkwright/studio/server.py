"""The server of the studio: the page, its modules, and a socket for each tab; on this computer alone.

It answers one user of this computer, and nobody else: guards stand before every page and socket.

| guard | against |
| --- | --- |
| exact list of hosts | a foreign name that is made to resolve to this computer (DNS rebinding) |
| origin present on sockets, and one of ours wherever it is present | scripts of other pages |
| key in the first message of a socket, in a header elsewhere | other users and programs of this computer |
| headers of every answer | scripts and frames from elsewhere, were they ever to get into a page |
| length of bodies | filling memory |

The page and its modules are those of the package and no secret; a machine is behind the key. Browsers send
cookies to every port of a host: the page therefore keeps the key itself, which stands behind ``#`` in the
address and so in no request for a page.

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
from pathlib import Path
from typing import Any

import uvicorn
from starlette.applications import Starlette
from starlette.requests import Request
from starlette.responses import HTMLResponse, JSONResponse, Response
from starlette.routing import Mount, Route, WebSocketRoute
from starlette.staticfiles import StaticFiles
from starlette.websockets import WebSocket, WebSocketDisconnect, WebSocketState

from linkwright.kernel.errors import InputError
from linkwright.kernel.limits import FILE_BYTES
from linkwright.studio.building import menu
from linkwright.studio.files import Folder
from linkwright.studio.language import page_texts
from linkwright.studio.messages import Enter, read
from linkwright.studio.session import Session
from linkwright.studio.wire import WireError, packed, unpacked

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
    """

    def __init__(self, app: App, port: int) -> None:
        self.app = app
        self.hosts = frozenset(f"{name}:{port}".encode() for name in ("127.0.0.1", "localhost"))
        self.origins = frozenset(b"http://" + host for host in self.hosts)

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Let pass what is ours, and refuse the rest."""
        if scope["type"] not in ("http", "websocket"):
            return
        is_socket = scope["type"] == "websocket"
        headers = scope["headers"]
        status = self._refused(headers, is_socket=is_socket)
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


def _same(given: str, known: str) -> bool:
    """Compare two texts in constant time."""
    return hmac.compare_digest(given.encode("utf-8", "replace"), known.encode())


def _values(headers: list[tuple[bytes, bytes]], name: bytes) -> list[bytes]:
    return [value for key, value in headers if key == name]


def _with_headers(send: Send) -> Send:
    """The same sender, which adds our headers to answers that have none."""

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


async def _refuse(send: Send, status: int, *, is_socket: bool) -> None:
    if is_socket:
        # Before it is accepted: the server answers 403 to the handshake.
        await send({"type": "websocket.close", "code": _POLICY})
        return
    words = b"Refused. Open the address that linkwright studio printed.\n"
    headers = [(b"content-type", b"text/plain; charset=utf-8"), (b"content-length", str(len(words)).encode())]
    await send({"type": "http.response.start", "status": status, "headers": [*headers, *_HEADERS]})
    await send({"type": "http.response.body", "body": words})


STATIC = Path(__file__).with_name("static")

# A request brings a machine file and some entries.
MESSAGE_BYTES = 2 * FILE_BYTES.most

# Tabs at once; each may have a process beside.
_TABS = 16

# Codes of a socket that brings no message, that there is no room for, and that brings no key of this studio
# (RFC 6455, 7.4.1 and 7.4.2).
_NO_MESSAGE, _NO_ROOM, _NO_KEY = 1003, 1013, 4403

# Header with the key, and seconds that a socket may take to bring it.
_KEY_HEADER, _PATIENCE = "x-linkwright-key", 10.0


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
        # The key opens the studio until it ends. The browser is started with a pass that opens once: other
        # users see the command lines of programs.
        self.key, self.once = secrets.token_urlsafe(32), secrets.token_urlsafe(32)
        self.tabs = 0
        routes = [
            Route("/", _page),
            Route("/texts/{code}.json", self._texts),
            WebSocketRoute("/socket", self._tab),
            Mount("/", StaticFiles(directory=STATIC)),
        ]
        self.app = Guards(Starlette(routes=routes), self.port)

    def address(self, fragment: str = "", *, once: bool = False) -> str:
        """The address that opens the studio until it ends, or `once`; `fragment`: what the page opens."""
        key = self.once if once else self.key
        return f"http://127.0.0.1:{self.port}/#key={key}" + (f"&{fragment}" if fragment else "")

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

    async def _texts(self, request: Request) -> Response:
        if not _same(request.headers.get(_KEY_HEADER, ""), self.key):
            return Response(status_code=403)
        try:
            return JSONResponse(page_texts(request.path_params["code"]))
        except InputError:
            # silent: a page in a language that there is none of is not found
            return Response(status_code=404)

    async def _tab(self, page: WebSocket) -> None:
        await page.accept()
        if not await self._enters(page):
            await _end(page, _NO_KEY)
            return
        if self.tabs >= _TABS:
            await _end(page, _NO_ROOM)
            return
        self.tabs += 1
        try:
            await _converse(page, Session(self.folder, page.send_bytes))
        finally:
            self.tabs -= 1

    async def _enters(self, page: WebSocket) -> bool:
        """Whether the first message of a socket brings the key, or the pass, which is answered by the key."""
        try:
            message = await asyncio.wait_for(page.receive(), _PATIENCE)
            number, body = unpacked(message.get("bytes") or b"")
            given = read(body)
        except (TimeoutError, WireError, InputError):
            # silent: the connection is refused
            return False
        if not isinstance(given, Enter):
            return False
        if self.once and _same(given.key, self.once):
            self.once = ""
        elif not _same(given.key, self.key):
            return False
        await page.send_bytes(packed(number, {"of": "entered", "key": self.key, "kinds": menu()}))
        return True


# What a browser must be told of modules and sheets, which it refuses otherwise.
_TYPES = {".js": "text/javascript", ".mjs": "text/javascript", ".css": "text/css"}


def _name_types() -> None:
    """Set MIME types: on Windows they are in the registry, where any program may have changed them."""
    for ending, kind in _TYPES.items():
        mimetypes.add_type(kind, ending)


# Ports that no service is given (RFC 6335, 6).
_FIRST, _PORTS = 49152, 16384


def _bound_for(root: Path) -> socket.socket:
    # What a browser keeps belongs to a port: a studio that starts again after a crash finds it there.
    digest = hashlib.sha256(str(root).encode("utf-8", "surrogateescape")).digest()
    try:
        return _bound(_FIRST + int.from_bytes(digest[:4]) % _PORTS)
    except OSError:
        return _bound(0)


def _bound(port: int) -> socket.socket:
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


async def _converse(page: WebSocket, session: Session) -> None:
    """Hand messages on until the tab closes or sends what is no message."""
    answering = asyncio.create_task(session.run())
    code = None
    # The lanes of the session begin before the first message comes.
    await asyncio.sleep(0)
    try:
        while code is None:
            message = await page.receive()
            if message["type"] == "websocket.disconnect":
                break
            try:
                session.take(message.get("bytes") or b"")
            except WireError:
                # silent: the connection ends with this code
                code = _NO_MESSAGE
    except WebSocketDisconnect:
        pass
    finally:
        answering.cancel()
        await asyncio.gather(answering, return_exceptions=True)
    if code is not None:
        await _end(page, code)


async def _end(page: WebSocket, code: int) -> None:
    if page.client_state is WebSocketState.CONNECTED:
        try:
            await page.close(code)
        except (WebSocketDisconnect, RuntimeError):
            return
