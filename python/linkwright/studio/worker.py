"""What runs beside a session, in a process of its own, so that it never holds up a slider and can be ended.

It reads one line of JSON a job and answers with the length of a body and the body, as `wire` packs it.
"""

from __future__ import annotations

import asyncio
import json
import os
import struct
import sys
from asyncio.subprocess import PIPE, Process
from typing import Any

_LENGTH = struct.Struct("<I")

# A job is a machine file and some entries.
_LINE_BYTES = 4_000_000


def main() -> None:
    """Answer jobs until there are no more."""
    from linkwright.kernel.errors import LinkwrightError
    from linkwright.machine.read import loads
    from linkwright.studio.analyses import beside, failed
    from linkwright.studio.wire import packed

    # The page has nothing of what a library might print.
    out = os.fdopen(os.dup(sys.stdout.fileno()), "wb")
    os.dup2(sys.stderr.fileno(), sys.stdout.fileno())
    for line in sys.stdin.buffer:
        job = json.loads(line)
        try:
            found = beside(loads(job["text"], path=job["path"]), job["lane"])
        except LinkwrightError as error:
            found = failed(error)
        body = packed(job["number"], {"of": "beside", "lane": job["lane"], **found.body()})
        out.write(_LENGTH.pack(len(body)) + body)
        out.flush()


class Worker:
    """One such process, begun when there is something to do."""

    def __init__(self) -> None:
        self._process: Process | None = None

    async def run(self, job: dict[str, Any]) -> bytes | None:
        """The message that answers a job; None if the process was ended, or ended by itself.

        Parameters
        ----------
        job : dict
            ``number``, ``lane``, ``text`` and ``path``.
        """
        process = await self._running()
        if process.stdin is None or process.stdout is None:
            return None
        try:
            process.stdin.write(json.dumps(job).encode() + b"\n")
            await process.stdin.drain()
            size = _LENGTH.unpack(await process.stdout.readexactly(_LENGTH.size))[0]
            return await process.stdout.readexactly(size)
        except (asyncio.IncompleteReadError, ConnectionError):
            await self.end()
            return None

    async def _running(self) -> Process:
        if self._process is None or self._process.returncode is not None:
            words = (sys.executable, "-m", "linkwright.studio.worker")
            self._process = await asyncio.create_subprocess_exec(
                *words, stdin=PIPE, stdout=PIPE, limit=_LINE_BYTES
            )
        return self._process

    async def end(self) -> None:
        """End the process, whatever it is doing."""
        process, self._process = self._process, None
        if process is not None and process.returncode is None:
            process.kill()
            await process.wait()


if __name__ == "__main__":
    main()
