"""One tab of the studio: a machine file as it is being edited, and one socket.

Only the newest request to compute is answered; older ones that wait are dropped. Slow analyses start when
nothing has changed for a moment, and what they find is sent if it is still that machine's. Everything else,
opening and saving, is answered in its order.
"""

from __future__ import annotations

import asyncio
import math
import time
import tomllib
import traceback
from collections.abc import Callable, Coroutine
from dataclasses import asdict
from typing import Any

from anyio import to_thread

from linkwright.kernel.description.place import split
from linkwright.kernel.description.schema_walk import annotation_at, mark_of
from linkwright.kernel.errors import InputError, LinkwrightError, MachineError, Problem
from linkwright.kernel.units.marks import Quantity
from linkwright.machine.address import get, replace
from linkwright.machine.machine import Machine
from linkwright.machine.read import loads
from linkwright.studio.analyses import chips, failed, fast, lanes
from linkwright.studio.building import End, added, drawn
from linkwright.studio.controls import controls
from linkwright.studio.design import goals, reach, slopes
from linkwright.studio.document import changed, merged, rounded
from linkwright.studio.drag import drag
from linkwright.studio.files import Folder, base, gallery, opened
from linkwright.studio.language import as_read, in_units, in_words, spoken, units_of
from linkwright.studio.messages import (
    Add,
    Bare,
    Compute,
    Draw,
    Enter,
    Export,
    File,
    Merge,
    Pull,
    Reach,
    Save,
    Search,
    SlopesOf,
    Speak,
    read,
)
from linkwright.studio.views import thumbnail
from linkwright.studio.wire import WireError, packed, unpacked
from linkwright.studio.worker import Worker

# Seconds without a change after which slow analyses start, and how long one of an older machine may go on.
_QUIET = 0.12
_GRACE = 0.5

# Requests to open, save and list that may wait.
_WAITING = 32

Body = dict[str, Any]


class Session:
    """What one tab knows.

    Parameters
    ----------
    folder : Folder
        Of the studio.
    send : callable
        Sends one message.
    """

    def __init__(self, folder: Folder, send: Callable[[bytes], Any]) -> None:
        self.folder, self.send = folder, send
        self.text, self.place, self.name = "", "", ""
        self.language, self.units = "en", list[str]()
        # The last text that was sound, with its path and its machine.
        self.sound: tuple[str, str, Machine] | None = None
        self.newest: tuple[int, Compute] | None = None
        self.others: asyncio.Queue[tuple[int, Any]] = asyncio.Queue(_WAITING)
        self.changed, self.quiet = asyncio.Event(), asyncio.Event()
        # Number and text that slow analyses are due for, and which of them the user stopped.
        self.due: tuple[int, str, list[str]] | None = None
        self.worker, self.running, self.stopped = Worker(), "", False
        # Searches have a process of their own: they go on while the machine changes.
        self.searcher: Worker = Worker()
        self.search: tuple[int, Search] | None = None
        self.sought = asyncio.Event()
        # Files that were asked for, made one after another.
        self.maker: Worker = Worker()
        self.exports: asyncio.Queue[tuple[int, Export]] = asyncio.Queue(_WAITING)
        # Everything that is begun ends with the tab: what starts a process too, so that none is left behind.
        self.tasks = asyncio.TaskGroup()

    async def run(self) -> None:
        """Answer until cancelled."""
        try:
            async with self.tasks:
                for lane in (self._compute, self._answer, self._beside, self._search, self._export):
                    self.tasks.create_task(lane())
        finally:
            workers = (self.worker, self.searcher, self.maker)
            # All at once: an end of the server does not wait for the first to be gone.
            for worker in workers:
                worker.kill()
            await asyncio.gather(*(worker.end() for worker in workers))

    def take(self, message: bytes) -> None:
        """Take one message of the page; a `WireError` if it is none, or more wait than a page ever sends."""
        number, text = unpacked(message)
        try:
            asked = read(text)
            match asked:
                case Compute():
                    self.newest = (number, asked)
                    self.changed.set()
                case Search():
                    self.search = (number, asked)
                    self.sought.set()
                case Speak():
                    self._speak(asked)
                case Enter():
                    raise InputError("request 'enter': expected once, as the first message")
                case Bare(ask="end search"):
                    self._begin(self.searcher.end())
                case Bare(ask="end export"):
                    self._begin(self.maker.end())
                case Bare(ask="stop"):
                    self._begin(self._stop())
                case _:
                    (self.exports if isinstance(asked, Export) else self.others).put_nowait((number, asked))
        except asyncio.QueueFull:
            raise WireError("too many requests at once") from None
        except InputError as error:
            self._begin(self._refuse(number, error))

    def _begin(self, task: Coroutine[Any, Any, None]) -> None:
        """Start a task that nothing waits for, for as long as the tab exists."""
        try:
            self.tasks.create_task(task)
        except RuntimeError:
            # The tab is ending.
            task.close()

    async def _refuse(self, number: int, error: LinkwrightError) -> None:
        await self.send(self._packed(number, {"of": "refused", "words": str(error)}))

    def _speak(self, asked: Speak) -> None:
        spoken(asked.code)
        with in_units(asked.units):
            self.language, self.units = asked.code, asked.units

    def _packed(self, number: int, body: Body) -> bytes:
        return packed(number, in_words(body, self.language))

    # -- the newest machine ----------------------------------------------------------------------------------

    async def _compute(self) -> None:
        while True:
            await self.changed.wait()
            self.changed.clear()
            if self.newest is None:
                continue
            (number, asked), self.newest = self.newest, None
            try:
                message, due = await to_thread.run_sync(self._computed, number, asked)
            except Exception as error:
                message, due = _internal(number, error), None
            await self.send(message)
            if due is not None:
                self.due = due
                self.quiet.set()

    def _computed(self, number: int, asked: Compute) -> tuple[bytes, tuple[int, str, list[str]] | None]:
        begun = time.perf_counter()
        held, entries = asked.held, dict(asked.set)
        if asked.text is not None:
            self.text, self.place, self.name = asked.text, asked.place, asked.name
        answer: Body = {"of": "machine", "set": entries}
        machine: Machine | None = None
        try:
            if asked.drag is not None:
                answer |= self._dragged(asked.drag, entries)
            if asked.reach is not None:
                answer |= self._reached(asked.reach, entries)
            if asked.merge is not None:
                answer |= self._merged(asked.merge)
            if asked.add is not None:
                answer |= self._added(asked.add)
            if asked.draw is not None:
                answer |= self._drawn(asked.draw)
            if not held and entries:
                self.text, entries = changed(self.text, entries), {}
                answer["text"] = self.text
            machine = self._machine(entries)
            with in_units(self.units):
                answer |= as_read(fast(machine, held=held).body()) | {"machine": machine.name}
        except LinkwrightError as error:
            answer |= {"problems": _problems(error)} if machine is None else failed(error).body()
        if not held:
            answer |= self._around(machine)
        answer["seconds"] = time.perf_counter() - begun
        due = (number, self.text, lanes(machine)) if machine is not None and not held else None
        return self._packed(number, answer), due

    def _machine(self, entries: dict[str, Any]) -> Machine:
        # Lengths, places and masses of a sound text are checked by their own bounds alone, and set; whatever
        # else may contradict other entries, and the whole is read.
        path = base(self.folder, self.place, self.name)
        if self.sound is None or self.sound[:2] != (self.text, path):
            self.sound = None
            if not entries:
                self.sound = (self.text, path, loads(self.text, path=path))
                return self.sound[2]
        elif all(_stands_alone(self.sound[2], address, value) for address, value in entries.items()):
            return replace(self.sound[2], entries) if entries else self.sound[2]
        return loads(self.text, entries, path=path)

    def _dragged(self, pull: Pull, entries: dict[str, Any]) -> Body:
        """The entries that follow a joint; they are put to the others."""
        start, place = self._machine({}), (pull.x, pull.y)
        locked, limits = frozenset(pull.locked), pull.free or None
        dragged = drag(start, pull.point, place, pull.angle, locked, limits, pull.pixel)
        raw = tomllib.loads(self.text)
        for address, value in dragged.entries.items():
            worth, begun = dragged.worth.get(address, (0.0, math.nan))
            # What has moved by less than a pixel stays as it is written.
            if not abs(value - begun) < worth:
                entries[address] = rounded(raw, address, value, worth, begun) if worth else value
        return {"reason": dragged.reason, "limit": dragged.limit}

    def _merged(self, both: Merge) -> Body:
        try:
            self.text = merged(self.text, both.joint, both.into, base(self.folder, self.place, self.name))
        except LinkwrightError as error:
            return {"words": f"{both.joint} was not merged with {both.into}: {error}"}
        return {"text": self.text}

    def _added(self, asked: Add) -> Body:
        path = base(self.folder, self.place, self.name)
        try:
            self.text = added(self.text, asked.kind, asked.size, asked.picked, path)
        except LinkwrightError as error:
            return {"words": str(error)}
        return {"text": self.text}

    def _drawn(self, asked: Draw) -> Body:
        """The text with links that were drawn; what they wait for, or why they cannot be."""
        path = base(self.folder, self.place, self.name)
        links = [
            (*(End(end.x, end.y, end.point) for end in (start, end)), kind)
            for start, end, kind in asked.links
        ]
        try:
            self.text, waits = drawn(self.text, links, asked.angle, asked.pixel, path)
        except LinkwrightError as error:
            return {"words": f"The link was not added: {error}", "draft": "refused"}
        return {"draft": "waiting", "waits": waits} if waits else {"draft": "done", "text": self.text}

    def _reached(self, pull: Reach, entries: dict[str, Any]) -> Body:
        """The entries that follow a result; they are put to the others."""
        reached = reach(self._machine({}), pull.of, pull.value, pull.free, pull.bounds)
        entries |= reached.entries
        return {"reason": reached.reason, "reached": reached.value}

    def _around(self, machine: Machine | None) -> Body:
        """Controls, chips and lanes of a machine that is not being dragged."""
        try:
            raw = tomllib.loads(self.text)
        except (ValueError, RecursionError):
            raw = None
        try:
            path = base(self.folder, self.place, self.name)
        except InputError:
            # silent: the machine has been refused for its name
            path = ""
        return {
            "controls": None if raw is None else controls(raw, path),
            "chips": [] if machine is None else chips(machine),
            "lanes": [] if machine is None else lanes(machine),
            "units": None if machine is None else units_of(machine),
            "goals": [] if machine is None else [asdict(goal) for goal in goals(machine)],
        }

    # -- slow analyses ---------------------------------------------------------------------------------------

    async def _beside(self) -> None:
        """Run slow analyses of the newest machine, once nothing changes any more."""
        while True:
            await self.quiet.wait()
            self.quiet.clear()
            await asyncio.sleep(_QUIET)
            due = self.due
            if self.quiet.is_set() or due is None:
                continue
            self.stopped = False
            for lane in due[2]:
                if self.due is due:
                    await self._job(due, lane)
            if self.due is due:
                self.due = None

    async def _job(self, due: tuple[int, str, list[str]], lane: str) -> None:
        """One slow analysis; its process is ended if the machine changes while it goes on for long."""
        number, text, _ = due
        path = base(self.folder, self.place, self.name)
        if self.stopped:
            await self.send(packed(number, {"of": "stopped", "lane": lane}))
            return
        self.running = lane
        job = {"number": number, "lane": lane, "text": text, "path": path}
        job |= {"language": self.language, "units": self.units}
        task = self.tasks.create_task(self.worker.run(job))
        stale = 0.0
        while not task.done():
            await asyncio.wait({task}, timeout=0.05)
            stale = stale + 0.05 if self.due is not due else 0.0
            if stale > _GRACE:
                await self.worker.end()
        self.running = ""
        message = task.result()
        # What is said in a language that was left is asked for again.
        if self.due is due and job["language"] == self.language:
            stopped = packed(number, {"of": "stopped", "lane": lane})
            await self.send(message if message is not None else stopped)

    async def _stop(self) -> None:
        due, self.stopped = self.due, True
        if self.running:
            await self.worker.end()
        elif due is not None:
            self.due = None
            for lane in due[2]:
                await self.send(packed(due[0], {"of": "stopped", "lane": lane}))

    # -- searches ------------------------------------------------------------------------------------------

    async def _search(self) -> None:
        """Run the sweep or the optimisation that was asked for last, and send what it finds on its way."""
        while True:
            await self.sought.wait()
            self.sought.clear()
            if self.search is None:
                continue
            (number, asked), self.search = self.search, None
            path = base(self.folder, self.place, self.name)
            job = {"number": number, "lane": "search", "text": self.text, "path": path}
            job |= {"search": asked.model_dump(exclude_none=True), "language": self.language}
            is_ended = True
            async for message in self.searcher.messages(job):
                await self.send(message)
                is_ended = False
            if is_ended or self.searcher.is_ended:
                await self.send(packed(number, {"of": "search", "ended": True}))

    # -- exports -------------------------------------------------------------------------------------------

    async def _export(self) -> None:
        while True:
            number, asked = await self.exports.get()
            path = base(self.folder, self.place, self.name)
            try:
                job = {"number": number, "lane": "export", "text": self.text, "path": path}
                job |= {"export": self._to_make(asked), "language": self.language}
            except LinkwrightError as error:
                await self._refuse(number, error)
                continue
            message = await self.maker.run(job)
            ended = self._packed(number, {"of": "export", "ended": True})
            await self.send(ended if message is None else message)

    def _to_make(self, asked: Export) -> Body:
        """What is asked for, with the real paths of a company file and of the variants."""
        path = base(self.folder, self.place, self.name)
        return {
            **asked.model_dump(),
            "variants": [{**one.model_dump(), "path": path} for one in asked.variants],
            "company": str(self.folder.inside(asked.company)) if asked.company else "",
        }

    # -- files -----------------------------------------------------------------------------------------------

    async def _answer(self) -> None:
        while True:
            number, asked = await self.others.get()
            try:
                answer = await to_thread.run_sync(self._asked, asked)
                message = self._packed(number, answer)
            except LinkwrightError as error:
                await self._refuse(number, error)
                continue
            except Exception as error:
                message = _internal(number, error)
            await self.send(message)

    def _asked(self, asked: Bare | SlopesOf | File | Save) -> Body:
        match asked:
            case SlopesOf():
                return {"of": "slopes", **slopes(self._machine({}), asked.response)}
            case File(ask="open"):
                text = opened(self.folder, asked.place, asked.name)
                self.place, self.name = asked.place, asked.name
                return {"of": "file", "place": asked.place, "name": asked.name, "text": text}
            case File():
                return {"of": "thumbnail", **thumbnail(self.folder, asked.place, asked.name)}
            case Save():
                self.folder.write(asked.name, asked.text, replace=self._replaces(asked))
                self.place, self.name = "folder", asked.name
                return {"of": "saved", "name": asked.name}
        return {"of": "gallery", "machines": gallery(self.folder), "folder": str(self.folder.root)}

    def _replaces(self, asked: Save) -> bool:
        """Whether a file is replaced: by all means, or as long as it has the text that the page knows."""
        if isinstance(asked.replace, bool):
            return asked.replace
        name = asked.name
        if self.folder.inside(name).exists() and opened(self.folder, "folder", name) != asked.replace:
            raise InputError(
                f"{name} was changed elsewhere since it was opened here; open it again, or write over it "
                "with Save as and Replace"
            )
        return True


def _stands_alone(machine: Machine, address: str, value: Any) -> bool:
    """Whether a new value is sound, and is so whatever the other entries are."""
    place = split(address)
    if place[0] not in ("mechanism", "bodies") or type(value) is not float or machine.mechanism.cams:
        return False
    mark = mark_of(annotation_at(Machine, place, machine))
    return isinstance(mark, Quantity) and isinstance(get(machine, address), float) and mark.holds(value)


def _internal(number: int, error: Exception) -> bytes:
    """Report a fault of the studio, or a request that its page does not make; the tab goes on."""
    traceback.print_exception(error)
    words = f"internal error, {type(error).__name__}: {error}; the terminal has the details"
    return packed(number, {"of": "refused", "words": words})


def _problems(error: LinkwrightError) -> list[Body]:
    listed = error.problems if isinstance(error, MachineError) else [Problem(found=str(error))]
    names = ("key", "found", "expected", "remedy", "line")
    return [{name: getattr(problem, name) for name in names} for problem in listed[:100]]
