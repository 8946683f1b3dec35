"""A studio of its own, below a folder of its own, and a tab that speaks to it."""

from __future__ import annotations

import http.client
import json
import struct
import threading
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any, NamedTuple

import pytest
from websockets.sync.client import ClientConnection, connect

from linkwright.kernel.files.library import template
from linkwright.studio.server import Studio
from linkwright.studio.wire import packed

# Seconds that an answer may take on a machine that does other things too.
PATIENCE = 180


class Served(NamedTuple):
    """A studio that runs, and what opens it."""

    studio: Studio

    @property
    def host(self) -> str:
        return f"127.0.0.1:{self.studio.port}"

    def get(
        self, path: str, method: str = "GET", body: bytes | None = None, **headers: str
    ) -> tuple[int, dict[str, str], bytes]:
        """Status, headers and body of an answer; headers are sent as they are given, no others."""
        line = http.client.HTTPConnection("127.0.0.1", self.studio.port, timeout=PATIENCE)
        line.putrequest(method, path, skip_host=True, skip_accept_encoding=True)
        for name, value in ({"Host": self.host} | headers).items():
            line.putheader(name.replace("_", "-"), value)
        line.endheaders(body)
        answer = line.getresponse()
        found = answer.status, {name.lower(): value for name, value in answer.getheaders()}, answer.read()
        line.close()
        return found

    def tab(self, **headers: str | None) -> Tab:
        """A tab, with the headers of our page unless others are given; None leaves one out."""
        tab = self.door(**headers)
        assert tab.ask(ask="enter", key=self.studio.key)["key"] == self.studio.key
        return tab

    def door(self, **headers: str | None) -> Tab:
        given = {"Origin": f"http://{self.host}"} | headers
        others = {name: value for name, value in given.items() if value is not None}
        return Tab(
            connect(
                f"ws://{self.host}/socket",
                additional_headers=others,
                max_size=None,
                compression=None,
                legacy=True,
            )
        )


class Tab:
    """One socket."""

    def __init__(self, socket: ClientConnection) -> None:
        self.socket = socket
        self.number = 0

    def send(self, **body: Any) -> int:
        self.number += 1
        self.socket.send(packed(self.number, body))
        return self.number

    def hear(self) -> tuple[int, dict[str, Any]]:
        message = self.socket.recv(timeout=PATIENCE)
        assert isinstance(message, bytes)
        number, length = struct.unpack_from("<II", message)
        doubles = memoryview(message)[8 + length :].cast("d")

        def filled(table: dict[str, Any]) -> Any:
            if table.keys() != {"$"}:
                return table
            first, *shape = table["$"]
            return list(doubles[first : first + shape[0] * (shape[1] if len(shape) > 1 else 1)])

        return number, json.loads(message[8 : 8 + length], object_hook=filled)

    def ask(self, **body: Any) -> dict[str, Any]:
        """The answer to one request; what slow analyses send meanwhile is left."""
        number = self.send(**body)
        while True:
            of, answer = self.hear()
            if of == number and answer["of"] != "beside":
                return answer


def begun(folder: Path) -> tuple[Served, Any]:
    studio = Studio(folder)
    server = studio.server()
    threading.Thread(target=lambda: server.run(sockets=[studio.socket]), daemon=True).start()
    while not server.started:
        time.sleep(0.01)
    return Served(studio), server


@pytest.fixture(scope="session")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    top = tmp_path_factory.mktemp("outside")
    inside = top / "studio"
    inside.mkdir()
    (top / "secret.toml").write_text(template("four-bar"))
    (inside / "bar.toml").write_text(template("four-bar"))
    (inside / "link.toml").symlink_to(top / "secret.toml")
    (inside / "way").symlink_to(top, target_is_directory=True)
    return inside


@pytest.fixture(scope="session")
def served(folder: Path) -> Iterator[Served]:
    found, server = begun(folder)
    yield found
    server.should_exit = True


@pytest.fixture
def tab(served: Served) -> Iterator[Tab]:
    found = served.tab()
    yield found
    found.socket.close()
