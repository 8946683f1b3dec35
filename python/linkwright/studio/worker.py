"""What runs beside a session, in a process of its own, so that it never holds up a slider and can be ended.

It reads one line of JSON a job and answers with bodies as `wire` packs them, each behind its length and
whether it is the last.
"""

from __future__ import annotations

import asyncio
import json
import os
import signal
import struct
import sys
import threading
from asyncio.subprocess import PIPE, Process
from collections.abc import AsyncIterator, Iterator
from functools import lru_cache, partial
from queue import SimpleQueue
from typing import Any

from linkwright.kernel.system import is_unread

# Length of a body, and whether it is the last of its job.
_HEAD = struct.Struct("<I?")

# A job is a machine file and some entries.
_LINE_BYTES = 4_000_000


def _jobs() -> Iterator[bytes]:
    """Lines of the studio; this process ends with it, whatever is being computed."""
    lines = SimpleQueue[bytes]()

    def read() -> None:
        for line in sys.stdin.buffer:
            lines.put(line)
        os._exit(0)

    threading.Thread(target=read, daemon=True).start()
    while True:
        yield lines.get()


def main() -> None:
    """Answer jobs until there are no more; without a word once the server is gone or interrupted."""
    signal.signal(signal.SIGINT, signal.SIG_DFL)
    try:
        _answer_jobs()
    except OSError as error:
        if not is_unread(error):
            raise
        # At once: what is still to be written would be tried again at an ordinary end.
        os._exit(0)


# A machine has two lanes at most.
@lru_cache(2)
def _found(text: str, path: str, lane: str) -> Any:
    """Result of a slow analysis of a file; in another language or unit only its words change."""
    from linkwright.machine.read import loads
    from linkwright.studio.analyses import found

    return found(loads(text, path=path), lane)


def _answer_jobs() -> None:
    from linkwright.kernel.errors import LinkwrightError
    from linkwright.machine.read import loads
    from linkwright.studio.analyses import failed, said
    from linkwright.studio.language import as_read, in_units, in_words, spoken
    from linkwright.studio.wire import packed

    # The page has nothing of what a library might print.
    out = os.fdopen(os.dup(sys.stdout.fileno()), "wb")
    os.dup2(sys.stderr.fileno(), sys.stdout.fileno())

    def send(number: int, code: str, answer: dict[str, Any], *, is_last: bool) -> None:
        body = packed(number, in_words(answer, code))
        out.write(_HEAD.pack(len(body), is_last) + body)
        out.flush()

    for line in _jobs():
        job = json.loads(line)
        number, lane, code = job["number"], job["lane"], job["language"]
        try:
            text, path = job["text"], job["path"]
            if lane == "search":
                from linkwright.studio.search import search

                answer = search(
                    loads(text, path=path), job["search"], partial(send, number, code, is_last=False)
                )
            elif lane == "export":
                from linkwright.studio.export import export

                answer = export(loads(text, path=path), job["export"], code)
            else:
                with in_units(job["units"]):
                    answers = as_read(said(_found(text, path, lane), lane, spoken(code)).body())
                answer = {"of": "beside", "lane": lane, **answers}
        except LinkwrightError as error:
            if lane == "search":
                answer = {"of": "search", "ended": True, "words": str(error)}
            elif lane == "export":
                answer = {"of": "refused", "words": str(error)}
            else:
                answer = {"of": "beside", "lane": lane, **failed(error).body()}
        send(number, code, answer, is_last=True)


class Worker:
    """One such process, begun when there is something to do."""

    def __init__(self) -> None:
        self._process: Process | None = None
        # Whether the last job was ended before its last message.
        self.is_ended = False

    async def run(self, job: dict[str, Any]) -> bytes | None:
        """The message that answers a job; None if the process was ended, or ended by itself.

        Parameters
        ----------
        job : dict
            ``number``, ``lane``, ``text``, ``path`` and ``language``; of an analysis ``units``.
        """
        last = None
        async for message in self.messages(job):
            last = message
        return None if self.is_ended else last

    async def messages(self, job: dict[str, Any]) -> AsyncIterator[bytes]:
        """The messages that answer a job, as they come.

        Parameters
        ----------
        job : dict
            As of `run`; ``search`` or ``export`` besides, what was asked for.
        """
        self.is_ended = is_last = False
        process = await self._running()
        if self.is_ended or process.stdin is None or process.stdout is None:
            # It was ended while it began.
            await self.end()
            return
        try:
            process.stdin.write(json.dumps(job).encode() + b"\n")
            await process.stdin.drain()
            while not is_last:
                size, is_last = _HEAD.unpack(await process.stdout.readexactly(_HEAD.size))
                yield await process.stdout.readexactly(size)
        except (asyncio.IncompleteReadError, ConnectionError):
            self.is_ended = True
            await self.end()

    async def _running(self) -> Process:
        if self._process is None or self._process.returncode is not None:
            # Nothing is imported from the folder of the studio, whoever's files lie there.
            words = (sys.executable, "-P", "-m", "linkwright.studio.worker")
            self._process = await asyncio.create_subprocess_exec(
                *words, stdin=PIPE, stdout=PIPE, limit=_LINE_BYTES
            )
        return self._process

    def kill(self) -> None:
        """End the process, whatever it is doing, without waiting until it is gone."""
        self.is_ended = True
        if self._process is not None and self._process.returncode is None:
            try:
                self._process.kill()
            except ProcessLookupError:
                # It is gone, which was not known yet.
                return

    async def end(self) -> None:
        """End the process, whatever it is doing."""
        self.kill()
        process, self._process = self._process, None
        if process is not None:
            await process.wait()


if __name__ == "__main__":
    main()
