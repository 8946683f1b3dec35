"""A command of Linkwright in a process of its own: it sees one folder, and ends when its time is over.

Messages are those of the command line. Of an answer the parts that are asked for are kept; one that is too
long is refused with the names of its parts.
"""

from __future__ import annotations

import sys
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from json import dumps, loads
from pathlib import Path
from subprocess import DEVNULL
from tempfile import TemporaryDirectory, TemporaryFile
from typing import IO, Any

import anyio

from linkwright.app.assistant.offered import words
from linkwright.kernel.errors import InputError, show
from linkwright.kernel.files.library import library_path
from linkwright.kernel.limits import ANSWER, ANSWER_ROWS, OUTPUT, grouped
from linkwright.kernel.result import finite
from linkwright.studio.files import Folder

# How many commands compute at the same time: others wait.
_TOGETHER = 2

# Exit codes of an answer: success, and findings.
_ANSWERS = (0, 1)

# How many parts of an answer a message names.
_NAMED = 30


@dataclass(frozen=True)
class Calls:
    """Commands on files below a folder."""

    folder: Folder
    seconds: float  # that a command may take
    limiter: anyio.CapacityLimiter

    @classmethod
    def of(cls, root: Path, seconds: float) -> Calls:
        """Calls on the files below a folder."""
        return cls(Folder.of(root), seconds, anyio.CapacityLimiter(_TOGETHER))

    def place(self, name: str) -> str:
        """A machine of the library, or a file below the folder by its real place; else an `InputError`."""
        if name.isidentifier():
            # Names what is similar where there is no such machine.
            library_path(name)
            return name
        # Refuses what is no file that can be read before a process begins.
        self.folder.read(name)
        return self._real(name, ".toml")

    def _real(self, name: str, ending: str) -> str:
        """The real place of a file, from the folder on."""
        return self.folder.inside(name, ending).relative_to(self.folder.root).as_posix()

    async def run(
        self,
        command: str,
        file: str,
        entries: Sequence[str] = (),
        options: Mapping[str, Any] | None = None,
        keys: Sequence[str] = (),
    ) -> dict[str, Any]:
        """The JSON object of a command on a file.

        `entries`: as for ``--set``; `keys`: the parts of the results that are wanted, all without any. Raises
        `InputError` with the message of the command, or if the answer is too long or takes too long.
        """
        place = self.place(file)
        line = words(command, place, entries, options or {}, partial(self._real, ending=".csv"))
        return _within_limits(await self._answer(line), keys)

    async def sweep(
        self, file: str, entries: Sequence[str] = (), *, first: int = 0, rows: int = 100
    ) -> dict[str, Any]:
        """The JSON object of ``linkwright sweep`` on a study, with some rows.

        `entries`: as for ``--set``; `first`, `rows`: the first row that is wanted, from 0, and how many.
        Raises `InputError` as `run` does.
        """
        if not (first >= 0 and 0 <= rows <= ANSWER_ROWS.most):
            raise InputError(
                f"first, rows: found {first}, {rows}; expected {ANSWER_ROWS.words}, from row 0 on"
            )
        place = self.place(file)
        with TemporaryDirectory(prefix="linkwright-") as at:
            into = Path(at) / "rows"
            line = ["sweep", "--json", *(f"--set={each}" for each in entries), f"--out={into}", "--", place]
            answer = await self._answer(line)
            # The folder is gone when the answer is read.
            del answer["results"]["sweep"]["path"]
            answer["results"]["rows"] = await anyio.to_thread.run_sync(partial(_rows, into, first, rows))
        return _within_limits(answer, ())

    async def _answer(self, line: Sequence[str]) -> dict[str, Any]:
        """The JSON object that a command line prints; else an `InputError` with its message."""
        async with self.limiter:
            code, out, said = await self._done(line)
        if code not in _ANSWERS:
            raise InputError(said.strip() or f"the command ended with exit code {code}")
        answer: dict[str, Any] = loads(out)
        return answer

    async def _done(self, line: Sequence[str]) -> tuple[int, str, str]:
        """Exit code and both outputs of a command."""
        # Nothing is imported from the folder, whoever's files lie there; standard input is the assistant's.
        program = [sys.executable, "-P", "-m", "linkwright", *line]
        with TemporaryFile() as out, TemporaryFile() as said:
            # Time that is over ends the process.
            with anyio.move_on_after(self.seconds):
                done = await anyio.run_process(
                    program, stdin=DEVNULL, stdout=out, stderr=said, check=False, cwd=self.folder.root
                )
                return done.returncode, _text(out), _text(said)
        remedy = "ask for less, or allow more by `linkwright mcp --seconds`"
        raise InputError(f"{line[0]}: no answer within {self.seconds:g} s; {remedy}")


def _text(file: IO[bytes]) -> str:
    """What a process wrote; an `InputError` if that is too much."""
    if file.tell() > OUTPUT.most:
        raise InputError(f"found an answer of {grouped(file.tell())} bytes, expected {OUTPUT.words}")
    file.seek(0)
    return file.read().decode("utf-8", "backslashreplace")


def _rows(folder: Path, first: int, count: int) -> dict[str, Any]:
    """Some rows of a sweep, as lists by the names of their columns."""
    from linkwright.studies.figures import rows_of
    from linkwright.studies.folder import opened

    columns = rows_of(opened(folder))
    return {name: column[first : first + count].tolist() for name, column in columns.items()}


def _within_limits(answer: dict[str, Any], keys: Sequence[str]) -> dict[str, Any]:
    """An answer with the parts that are wanted; an `InputError` if it is too long."""
    results = answer["results"]
    if keys:
        answer = answer | {"results": {key: _part(results, key, key) for key in keys}}
    length = len(dumps(finite(answer), ensure_ascii=False))
    if length > ANSWER.most:
        near = f"name parts of it by keys: {', '.join(answer['results'])}"
        raise InputError(f"found an answer of {grouped(length)} characters, expected {ANSWER.words}; {near}")
    return answer


def _part(results: Any, key: str, whole: str) -> Any:
    """What stands at a key in results, such as ``linkage.elements.ram.rod.swing``; names have points."""
    if not key:
        return results
    known = list(results) if isinstance(results, Mapping) else []
    heads = [head for head in known if key == head or key.startswith(f"{head}.")]
    if not heads:
        there = f"there is {', '.join(known[:_NAMED])}" if known else "a value has no parts"
        raise InputError(
            f"keys: found {show(whole)}, of which {show(key)} is no part of the results; {there}"
        )
    # A longer name goes before a shorter one that it begins with.
    head = max(heads, key=len)
    return _part(results[head], key[len(head) + 1 :], whole)
