"""Messages of every wrong shape are refused in words, and leave nothing behind: no file, no process."""

from __future__ import annotations

import asyncio
import copy
import json
import os
import struct
import subprocess
import sys
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from linkwright.kernel.files.library import template
from linkwright.studio.worker import Worker

from .conftest import Served, Tab, begun

TEXT = template("four-bar")
RADIUS = "mechanism.cranks.A.radius"
LIMITS = {RADIUS: [0.01, 0.1]}
SOUND: list[dict[str, Any]] = [
    {"ask": "compute", "text": TEXT, "place": "folder", "name": "bar.toml"},
    {"ask": "compute", "held": True, "set": {RADIUS: 0.05}},
    {"ask": "compute", "set": {RADIUS: 0.05}},
    {"ask": "compute", "drag": {"point": "K", "x": 0.03, "y": 0.04, "angle": 0.2, "free": LIMITS}},
    {"ask": "compute", "held": True, "reach": {"of": "steady_state.unevenness", "value": 1, "free": LIMITS}},
    {"ask": "compute", "add": {"kind": "sliders", "size": 1, "picked": "A"}},
    {
        "ask": "compute",
        "draw": {"angle": 0, "pixel": 0.001, "links": [[{"x": 0, "y": 0, "point": "O"}, {"x": 1, "y": 1}]]},
    },
    {"ask": "compute", "merge": {"joint": "A", "into": "C"}},
    {"ask": "slopes", "response": "steady_state.unevenness"},
    {"ask": "open", "place": "folder", "name": "bar.toml"},
    {"ask": "thumbnail", "place": "template", "name": "four-bar"},
    {"ask": "save", "name": "new.toml", "text": "x", "replace": True},
    {"ask": "export", "kind": "svg", "angle": 1.0, "variants": [{"name": "a", "text": "x"}]},
    {"ask": "search", "kind": "sweep", "response": "x", "entries": [{"address": "a", "low": 0, "high": 1}]},
]
WRONG: list[Any] = [
    *(None, True, -1, 1e308, 2**70, float("nan"), float("inf"), "", "a..b", "\ud800", "x\udc00"),
    *([], [[1, 2]], ["\ud800"], {}, {"a": [1]}, {"a": [1, 2, 3]}, {"": 1}, {"mechanism": None}),
    *({RADIUS: [1e308, -1e308]}, {RADIUS: [float("nan"), 1]}, {"name": {"a": [None]}}, {"format": 2}),
]


def places(node: Any, at: tuple[Any, ...] = ()) -> Iterator[tuple[Any, ...]]:
    """Every place of a request, from the top down."""
    if at and at != ("ask",):
        yield at
    items = node.items() if isinstance(node, dict) else enumerate(node) if isinstance(node, list) else ()
    for key, value in items:
        yield from places(value, (*at, key))


def changed(request: dict[str, Any], at: tuple[Any, ...], value: Any) -> dict[str, Any]:
    whole = copy.deepcopy(request)
    node: Any = whole
    for key in at[:-1]:
        node = node[key]
    node[at[-1]] = value
    return whole


def answer_to(tab: Tab, request: dict[str, Any]) -> dict[str, Any]:
    tab.number += 1
    text = json.dumps(request).encode()
    tab.socket.send(struct.pack("<II", tab.number, len(text)) + text)
    while True:
        of, answer = tab.hear()
        if of == tab.number and answer["of"] not in ("beside", "stopped"):
            return answer


def test_every_wrong_shape_is_refused_in_words(tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    """Any value at any place of any request is answered; no traceback, no file that is not finished."""
    (tmp_path / "bar.toml").write_text(TEXT)
    served, server = begun(tmp_path)
    tab = served.tab()
    answer_to(tab, SOUND[0])
    for request in SOUND:
        for at in places(request):
            # What starts a process is tried with some.
            for value in WRONG[:: 5 if request["ask"] in ("export", "search") else 1]:
                answer = answer_to(tab, changed(request, at, value))
                assert "internal error" not in str(answer.get("words", "")), (request, at, value)
            answer_to(tab, SOUND[0])
    tab.socket.close()
    server.should_exit = True
    assert {path.name for path in tmp_path.iterdir()} <= {"bar.toml", "new.toml"}
    assert "Traceback" not in capfd.readouterr().err


BROKEN = ["a = ", "mechanism = 1", "loads = 3\n[mechanism]\n", "[mechanism]\ncranks = 5\n", "units = 1\n"]


@pytest.mark.parametrize("text", [*BROKEN, "format = 1\nname = 'x'\n[loads]\ng = 1\n", "[bodies]\nA = 1\n"])
def test_requests_to_a_file_with_problems_are_answered(tab: Tab, text: str) -> None:
    """Whatever is asked of a text that is no machine is answered by its problems, or refused in words."""
    for request in SOUND[1:9]:
        answer_to(tab, {"ask": "compute", "text": text})
        answer = answer_to(tab, request)
        assert "internal error" not in str(answer.get("words", "")), request
    for kind in ("cranks", "bodies", "gravity", "motor", "dry"):
        answer_to(tab, {"ask": "compute", "text": text})
        answer = answer_to(tab, {"ask": "compute", "add": {"kind": kind, "size": 1.0}})
        assert "internal error" not in str(answer.get("words", "")), kind


@pytest.mark.parametrize(
    ("request_", "words"),
    [
        ({"ask": "fly"}, "'fly': no such request"),
        ({"ask": "compute", "reach": {"of": "x", "value": 1, "free": [1]}}, "compute.reach.free: found [1]"),
        ({"ask": "compute", "drag": {"point": "A"}}, "compute.drag.x: expected an entry"),
        ({"ask": "save", "name": "a.toml", "text": "\ud800"}, "letters that no file can hold"),
        ({"ask": "stop", "now": True}, "stop.now"),
    ],
    ids=str,
)
def test_words_name_the_place(tab: Tab, request_: dict[str, Any], words: str) -> None:
    """A request of another shape is refused with its place and what is there."""
    answer = answer_to(tab, request_)
    assert answer["of"] == "refused"
    assert words in answer["words"]


@pytest.mark.skipif(not Path("/proc").is_dir(), reason="looks for processes in /proc")
def test_tabs_that_are_cut_leave_no_process(served: Served) -> None:
    """Twenty tabs that are cut while their slow analyses begin leave no process behind."""
    before = _children()
    for n in range(20):
        tab = served.tab()
        tab.send(ask="compute", text=TEXT)
        tab.send(ask="export", kind="svg")
        tab.send(ask="search", kind="sweep", response="x", entries=[])
        # Some before their processes begin, some amid.
        time.sleep(0.03 * (n % 8))
        transport = tab.socket.socket
        transport.close()
    end = time.monotonic() + 60
    while _children() - before and time.monotonic() < end:
        time.sleep(0.1)
    assert not _children() - before


@pytest.mark.skipif(not Path("/proc").is_dir(), reason="looks for processes in /proc")
def test_a_process_that_is_ended_while_it_begins_does_not_go_on() -> None:
    """A tab may close between the order for a process and its birth."""

    async def begin_and_end() -> tuple[bytes | None, set[int]]:
        worker = Worker()
        about = {"number": 1, "lane": "study", "text": TEXT, "path": "", "language": "en", "units": []}
        job = asyncio.create_task(worker.run(about))
        await asyncio.sleep(0)
        await worker.end()
        return await asyncio.wait_for(job, 30), _children()

    before = _children()
    answer, children = asyncio.run(begin_and_end())
    assert answer is None
    assert not children - before


def _children() -> set[int]:
    found = set()
    for entry in Path("/proc").iterdir():
        if entry.name.isdigit():
            try:
                words = (entry / "cmdline").read_bytes()
                parent = int((entry / "stat").read_text().rpartition(")")[2].split()[1])
            except OSError:
                continue
            if parent == os.getpid() and b"linkwright.studio.worker" in words:
                found.add(int(entry.name))
    return found


def test_a_file_that_is_saved_is_whole_though_the_studio_is_killed(tmp_path: Path) -> None:
    """A studio that is killed while it saves leaves the old text or the new one, and no other file."""
    place = tmp_path / "bar.toml"
    texts = [f'name = "{letter * 3_000_000}"\n' for letter in "ab"]
    place.write_text(texts[0])
    code = (
        "import sys\n"
        "from pathlib import Path\n"
        "from linkwright.studio.files import Folder\n"
        "folder = Folder.of(Path(sys.argv[1]))\n"
        "print(flush=True)\n"
        "for n in range(10_000):\n"
        "    folder.write('bar.toml', f'name = \"{\"ab\"[n % 2] * 3_000_000}\"\\n', replace=True)\n"
    )
    for n in range(5):
        process = subprocess.Popen([sys.executable, "-c", code, str(tmp_path)], stdout=subprocess.PIPE)
        assert process.stdout is not None
        process.stdout.readline()
        time.sleep(0.02 + 0.007 * n)
        process.kill()
        process.communicate()
        assert place.read_text() in texts
    # What was not finished goes with the next one that writes.
    from linkwright.studio.files import Folder

    Folder.of(tmp_path).write("bar.toml", texts[0], replace=True)
    assert [path.name for path in tmp_path.iterdir()] == ["bar.toml"]
