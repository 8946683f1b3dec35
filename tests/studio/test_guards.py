"""Attacks: whoever is not the user of this computer is refused, and what is no message is harmless."""

from __future__ import annotations

import mimetypes
import re
import socket
import struct
from pathlib import Path

import pytest
from websockets.exceptions import ConnectionClosed, InvalidStatus

from linkwright import InputError
from linkwright.kernel import system
from linkwright.kernel.files.library import template
from linkwright.studio.files import Folder
from linkwright.studio.server import Studio

from .conftest import Served, Tab


@pytest.mark.parametrize("key", ["", "wrong", "\u0444"])
def test_a_socket_without_the_key_is_closed_before_it_learns_anything(served: Served, key: str) -> None:
    """The first message of a socket brings the key; any other ends it without an answer."""
    for body in ({"ask": "enter", "key": key}, {"ask": "gallery"}, {"ask": "enter"}):
        door = served.door()
        door.send(**body)
        with pytest.raises(ConnectionClosed) as ended:
            door.hear()
        assert ended.value.rcvd is not None
        assert ended.value.rcvd.code == 4403


def test_no_cookie_is_set_or_read(served: Served) -> None:
    """Browsers send cookies to every port of a host: the studio knows none, and requests need a header."""
    status, headers, body = served.get("/")
    assert status == 200
    assert b"<html" in body
    assert served.studio.key.encode() not in body
    assert "set-cookie" not in headers
    assert headers["content-security-policy"].startswith("default-src 'self'")
    assert "access-control-allow-origin" not in headers
    assert served.get("/texts/uk.json")[0] == 403
    assert served.get("/texts/uk.json", Cookie=f"key={served.studio.key}")[0] == 403
    assert served.get("/texts/uk.json", X_Linkwright_Key=served.studio.key)[0] == 200


def test_the_printed_address_opens_until_the_end_and_the_pass_of_the_browser_once(tmp_path: Path) -> None:
    """Command lines of programs are seen by others: what a browser is started with opens once."""
    from .conftest import begun

    served, server = begun(tmp_path)
    studio = served.studio
    key, once = studio.key, studio.once
    assert studio.address("open=library/x").endswith(f"/#key={key}&open=library/x")
    assert studio.address(once=True).endswith(f"#key={once}")
    assert served.door().ask(ask="enter", key=once)["key"] == key
    again = served.door()
    again.send(ask="enter", key=once)
    with pytest.raises(ConnectionClosed):
        again.hear()
    for _ in range(3):
        served.tab().socket.close()
    server.should_exit = True


@pytest.mark.parametrize(
    "host", ["evil.example", "127.0.0.1", "localhost:1", "127.0.0.1.evil.example:80", ""]
)
def test_foreign_hosts_are_refused(served: Served, host: str) -> None:
    assert served.get("/", Host=host)[0] in (400, 421)
    assert served.get("/wire.js", Host=host)[0] in (400, 421)


@pytest.mark.parametrize("origin", ["http://evil.example", "null", "https://127.0.0.1", "http://127.0.0.1:1"])
def test_foreign_origins_are_refused(served: Served, origin: str) -> None:
    assert served.get("/", Origin=origin)[0] == 403
    with pytest.raises(InvalidStatus):
        served.tab(Origin=origin)


@pytest.mark.parametrize(
    "headers",
    [{"Origin": None}, {"Host": "evil.example"}],
    ids=str,
)
def test_sockets_need_origin_and_host(served: Served, headers: dict[str, str | None]) -> None:
    with pytest.raises(InvalidStatus):
        served.tab(**headers)


def test_bodies_and_other_methods_are_refused(served: Served) -> None:
    assert served.get("/", "POST")[0] == 405
    assert served.get("/", "POST", b"x", Content_Length="1")[0] == 413
    assert served.get("/", Transfer_Encoding="chunked")[0] in (400, 413)
    # More digits than Python reads as a number; uvicorn's parser may refuse them before the guard does.
    assert served.get("/", Content_Length="9" * 5000)[0] in (400, 413)


@pytest.mark.parametrize(
    "path", ["/../server.py", "/%2e%2e/server.py", "/..%2fserver.py", "//etc/passwd", "/vendor/%00"]
)
def test_pages_lie_in_their_folder(served: Served, path: str) -> None:
    assert served.get(path)[0] in (400, 404)


NO_MESSAGES: dict[str, bytes | str] = {
    "empty": b"",
    "short": b"\0" * 7,
    "length": struct.pack("<II", 1, 100),
    "list": struct.pack("<II", 1, 2) + b"[]",
    "broken": struct.pack("<II", 1, 4) + b"{{{{",
    "deep": struct.pack("<II", 1, 200_000) + b"[" * 200_000,
    "text": "text",
}


@pytest.mark.parametrize("message", NO_MESSAGES.values(), ids=NO_MESSAGES.keys())
def test_what_is_no_message_ends_the_tab_alone(served: Served, tab: Tab, message: bytes | str) -> None:
    tab.socket.send(message)
    with pytest.raises(ConnectionClosed) as ended:
        tab.hear()
    assert ended.value.rcvd is not None
    assert ended.value.rcvd.code in (1003, 1007)
    assert served.get("/")[0] == 200


def test_oversized_messages_end_the_tab(served: Served, tab: Tab) -> None:
    def send_and_hear() -> None:
        tab.socket.send(b"x" * 3_000_000)
        tab.hear()

    with pytest.raises(ConnectionClosed) as ended:
        send_and_hear()
    assert ended.value.rcvd is None or ended.value.rcvd.code == 1009
    assert served.get("/")[0] == 200


def test_floods_of_requests_are_answered_by_the_newest(tab: Tab) -> None:
    text = template("four-bar")
    tab.ask(ask="compute", held=True, text=text)
    for _ in range(300):
        last = tab.send(ask="compute", held=True, text=text)
    numbers = []
    while not numbers or numbers[-1] != last:
        numbers.append(tab.hear()[0])
    assert len(numbers) < 100


def test_floods_of_files_end_the_tab(served: Served, tab: Tab) -> None:
    def flood() -> None:
        for _ in range(2000):
            tab.send(ask="gallery")
        while True:
            tab.hear()

    with pytest.raises(ConnectionClosed):
        flood()
    assert served.get("/")[0] == 200


@pytest.mark.parametrize(
    "name",
    [
        "../secret.toml",
        "/etc/passwd",
        "link.toml",
        "way/secret.toml",
        "a/../../secret.toml",
        "x\0.toml",
        "bar.txt",
        "..",
    ],
)
def test_files_outside_are_neither_read_nor_written(tab: Tab, folder: Path, name: str) -> None:
    before = (folder.parent / "secret.toml").read_text()
    assert tab.ask(ask="open", place="folder", name=name)["of"] == "refused"
    assert tab.ask(ask="save", name=name, text="x", replace=True)["of"] == "refused"
    assert (folder.parent / "secret.toml").read_text() == before


def test_entries_of_a_machine_lead_no_way_out(tab: Tab, folder: Path) -> None:
    (folder.parent / "points.csv").write_text("angle,torque\n0,1\n1,2\n")
    text = """format = 1
name = "x"
[turning_moment]
speed = 10
driver = { kind = "table", file = "../points.csv" }
"""
    answer = tab.ask(ask="compute", text=text, place="folder", name="bar.toml")
    assert answer["problems"]


@pytest.mark.parametrize("name", ["<img src=x onerror=alert(1)>", "\u202eevil", "a\x1b[2J"])
def test_names_with_markup_are_words(tab: Tab, name: str) -> None:
    text = template("four-bar").replace("name = ", "name = '''" + name.replace("\x1b", "e") + "'''\n# ", 1)
    answer = tab.ask(ask="compute", text=text)
    assert answer.get("machine") == name.replace("\x1b", "e") or answer["problems"]


@pytest.mark.parametrize(
    "body",
    [
        {"drag": {}},
        {"drag": {"point": "x", "x": "y"}},
        {"set": {"a..b": 1}},
        {"text": "a = "},
        {"set": {"mechanism": 1}},
        {"text": "\0"},
    ],
    ids=str,
)
def test_requests_without_sense_are_answered(tab: Tab, body: dict[str, object]) -> None:
    tab.ask(ask="compute", text=template("four-bar"))
    answer = tab.ask(ask="compute", **body)
    assert answer["of"] == "refused" or answer["problems"]
    assert "problems" not in tab.ask(ask="compute", text=template("four-bar"))


def test_server_listens_on_this_computer_alone(served: Served) -> None:
    assert served.studio.socket.getsockname()[0] == "127.0.0.1"
    assert served.studio.socket.family == socket.AF_INET


def test_the_page_asks_for_modules_that_exist(served: Served) -> None:
    status, _, page = served.get("/")
    links = re.findall(r'modulepreload" href="([^"]+)"', page.decode())
    assert status == 200
    assert {"app.js", "stage.js", "vendor/preact.mjs"} <= set(links)
    assert all(served.get(f"/{link}")[0] == 200 for link in links)


def test_a_folder_keeps_its_port(tmp_path: Path) -> None:
    """What a browser keeps belongs to a port: after a crash the studio is there again."""
    first = Studio(tmp_path)
    beside = Studio(tmp_path)
    assert beside.port != first.port
    beside.socket.close()
    first.socket.close()
    again = Studio(tmp_path)
    assert again.port == first.port
    again.socket.close()


def test_types_of_modules_are_ours_whatever_the_registry_says(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Browsers refuse a module that is sent as text, as some programs set it on Windows."""
    from .conftest import begun

    mimetypes.init()
    for ending in (".js", ".mjs", ".css"):
        monkeypatch.setitem(mimetypes.types_map, ending, "text/plain")
    served, server = begun(tmp_path)
    for name, kind in (("wire.js", "text/javascript"), ("studio.css", "text/css")):
        status, headers, _ = served.get(f"/{name}")
        assert status == 200
        assert headers["content-type"].startswith(kind)
    server.should_exit = True


def test_no_other_program_takes_the_port_over(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Windows has an option for it; another one stands in, and that for reuse stays unset."""
    monkeypatch.setattr(socket, "SO_EXCLUSIVEADDRUSE", socket.SO_KEEPALIVE, raising=False)
    own = Studio(tmp_path).socket
    assert own.getsockopt(socket.SOL_SOCKET, socket.SO_KEEPALIVE)
    assert not own.getsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR)
    own.close()


@pytest.mark.parametrize("name", ["C:secret.toml", "bar.toml:hidden.toml"])
def test_colons_of_windows_are_refused(name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Another drive, and a hidden stream of a file."""
    Folder(tmp_path).inside(name)
    monkeypatch.setattr(system, "WINDOWS", True)
    with pytest.raises(InputError, match=r"expected the name of a \.toml file below the folder"):
        Folder(tmp_path).inside(name)
