"""The server of the studio: the page, its modules, and a socket for each tab; on this computer alone."""

from __future__ import annotations

import asyncio
import secrets
import socket
from pathlib import Path

import uvicorn
from starlette.applications import Starlette
from starlette.responses import FileResponse
from starlette.routing import Mount, Route, WebSocketRoute
from starlette.staticfiles import StaticFiles
from starlette.websockets import WebSocket, WebSocketDisconnect

from linkwright.kernel.limits import FILE_BYTES
from linkwright.studio.files import Folder
from linkwright.studio.guards import Guards
from linkwright.studio.session import Session
from linkwright.studio.wire import WireError

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
        That it is served on; 0 for a free one.
    """

    def __init__(self, folder: Path, port: int = 0) -> None:
        self.folder = Folder.of(folder)
        self.socket = socket.socket(socket.AF_INET, socket.SOCK_STREAM)
        self.socket.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        self.socket.bind(("127.0.0.1", port))
        self.port: int = self.socket.getsockname()[1]
        self.token = secrets.token_urlsafe(32)
        self.tabs = 0
        routes = [
            Route("/", _page),
            WebSocketRoute("/socket", self._tab),
            Mount("/", StaticFiles(directory=STATIC)),
        ]
        self.app = Guards(Starlette(routes=routes), self.port, self.token)

    def address(self, fragment: str = "") -> str:
        """The address that opens the studio, once.

        Parameters
        ----------
        fragment : str
            What the page should open, after ``#``.
        """
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


async def _page(request: object) -> FileResponse:
    return FileResponse(STATIC / "index.html")


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
