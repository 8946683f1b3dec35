"""Random cases for hours: ``python tests/fuzz/deep.py --minutes 60``, which ``make test-deep`` runs.

Every case runs in a process of its own kind that may hang, die or run out of memory without harm; what breaks
is written to a folder with all that is needed to see it again. ``--kind NAME --seed N`` runs one case here.
"""

from __future__ import annotations

import argparse
import multiprocessing as mp
import re
import resource
import sys
import time
import traceback
from collections import Counter, defaultdict
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from multiprocessing.connection import Connection, wait
from pathlib import Path

import kinds
import numpy as np
from broken import CLOCK, LONGEST, SECONDS, PromiseError

# Calls of a case that are watched one by one, at most.
CALLS = 3

# Processor time after which a case that has not stopped itself hangs where Python cannot interrupt it [s].
HARD_SECONDS = max(LONGEST, CALLS * SECONDS) + 60.0

# No case may need more memory than this [bytes]; machine files of a few pages describe them all.
MEMORY = 6 << 30

# A fresh process now and then, so that what one case leaves behind cannot help or harm thousands of others.
CASES_OF_A_PROCESS = 2000


@dataclass
class Tally:
    """What came out: cases of each kind, and the breaks by what they say."""

    cases: Counter[str] = field(default_factory=Counter)
    seconds: defaultdict[str, float] = field(default_factory=lambda: defaultdict(float))
    broken: Counter[tuple[str, str]] = field(default_factory=Counter)

    def table(self) -> str:
        heads = f"{'kind':16}{'cases':>10}{'ms a case':>12}{'broken':>8}"
        rows = [heads, "─" * len(heads)]
        for kind, n in sorted(self.cases.items()):
            count = sum(k for (of, _), k in self.broken.items() if of == kind)
            rows.append(f"{kind:16}{n:10}{1e3 * self.seconds[kind] / n:12.1f}{count:8}")
        rows += [f"{count:6}  {kind}: {what}" for (kind, what), count in self.broken.most_common(40)]
        return "\n".join(rows)


def worker(pipe: Connection) -> None:
    """Run cases as they come; answer with the break, or None."""
    resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY))
    while True:
        kind, seed = pipe.recv()
        try:
            kinds.run(kind, seed)
        except PromiseError as broken:
            pipe.send((broken.what, broken.inputs))
        # A case that fails by itself, as by an error of Linkwright that it did not expect.
        except Exception as error:
            what = f"the case itself failed: {type(error).__name__}: {error}"
            pipe.send((what, {"traceback.txt": traceback.format_exc()}))
        else:
            pipe.send(None)


def processor_time(process: mp.process.BaseProcess) -> float:
    """Processor time that a process has taken, all its threads together [s]; 0 for one that has ended."""
    # The clock of a process as Linux numbers it, clock_getcpuclockid(3).
    clock = (~(process.pid or 0) << 3) | 2
    try:
        return time.clock_gettime(clock)
    except OSError:
        return 0.0


@dataclass
class Runner:
    """A process with the case that it works on."""

    process: mp.process.BaseProcess
    pipe: Connection
    case: tuple[str, int] = ("", 0)
    since: float = 0.0
    used: float = 0.0
    done: int = 0

    @classmethod
    def start(cls) -> Runner:
        """A fresh process. It is spawned, not forked: a fork would take along the state of this one."""
        context = mp.get_context("spawn")
        here, there = context.Pipe()
        process = context.Process(target=worker, args=(there,), daemon=True)
        process.start()
        there.close()
        return cls(process, here)

    def give(self, case: tuple[str, int]) -> None:
        self.pipe.send(case)
        self.case, self.since, self.done = case, time.monotonic(), self.done + 1
        self.used = processor_time(self.process)

    def hangs(self) -> bool:
        """Whether the case has taken more processor time than any may, or has waited far longer than that."""
        if time.monotonic() - self.since > CLOCK * HARD_SECONDS:
            return True
        return processor_time(self.process) - self.used > HARD_SECONDS

    def stop(self) -> None:
        self.process.kill()
        self.process.join()
        self.pipe.close()


def cases(seed: int, only: Sequence[str]) -> Iterator[tuple[str, int]]:
    wanted = {name: kind for name, kind in kinds.KINDS.items() if not only or name in only}
    names = [name for name, kind in wanted.items() for _ in range(kind.weight)]
    random = np.random.default_rng(seed)
    while True:
        yield names[random.integers(len(names))], int(random.integers(1 << 62))


def run(minutes: float, jobs: int, seed: int, only: Sequence[str], out: Path) -> Tally:
    """Run random cases until the time is over.

    Parameters
    ----------
    minutes : float
        How long.
    jobs : int
        Processes at a time.
    seed : int
        Where the cases start; the same seed gives the same cases.
    only : sequence of str
        The kinds to run; all if empty.
    out : Path
        Folder for what breaks.

    Returns
    -------
    Tally
        What came out.
    """
    tally, queue = Tally(), cases(seed, only)
    end = time.monotonic() + 60.0 * minutes
    runners = [Runner.start() for _ in range(jobs)]
    for runner in runners:
        runner.give(next(queue))
    said = time.monotonic()
    while time.monotonic() < end:
        ready = wait([runner.pipe for runner in runners], timeout=1.0)
        for k, runner in enumerate(runners):
            late = runner.pipe not in ready and runner.hangs()
            if runner.pipe not in ready and not late:
                continue
            runners[k] = _next(runner, tally, out, late=late)
            runners[k].give(next(queue))
        if time.monotonic() - said > 60.0:
            said = time.monotonic()
            print(f"{tally.cases.total()} cases, {tally.broken.total()} broken, ", end="")
            print(f"{(end - said) / 60.0:.0f} min left", flush=True)
    for runner in runners:
        runner.stop()
    return tally


def _next(runner: Runner, tally: Tally, out: Path, *, late: bool) -> Runner:
    kind, seed = runner.case
    tally.cases[kind] += 1
    tally.seconds[kind] += time.monotonic() - runner.since
    answer: tuple[str, dict[str, str | bytes]] | None
    if late:
        answer = (f"no answer within {HARD_SECONDS:g} s of processor time, and not to be interrupted", {})
    else:
        try:
            answer = runner.pipe.recv()
        except EOFError:
            runner.process.join()
            answer = (f"the process died with exit code {runner.process.exitcode}", {})
    if answer is not None:
        what, inputs = answer
        tally.broken[kind, _class_of(what)] += 1
        _record(out / f"{kind.replace(' ', '_')}_{seed}", kind, seed, what, inputs)
    if late or not runner.process.is_alive() or runner.done >= CASES_OF_A_PROCESS:
        runner.stop()
        return Runner.start()
    return runner


def _class_of(what: str) -> str:
    """What a break says, without its numbers and names, so that the same cause is counted as one."""
    return re.sub(r"[-+]?\d[\d.e+-]*", "#", what.split("\n")[0])[:150]


def _record(folder: Path, kind: str, seed: int, what: str, inputs: dict[str, str | bytes]) -> None:
    """Write down a break: its words, its files, and how to run it again."""
    folder.mkdir(parents=True, exist_ok=True)
    again = f"python tests/fuzz/deep.py --kind {kind!r} --seed {seed}\n"
    (folder / "what.txt").write_text(f"{what}\n\n{again}", encoding="utf-8", errors="backslashreplace")
    for name, content in inputs.items():
        data = content if isinstance(content, bytes) else content.encode("utf-8", "backslashreplace")
        (folder / name).write_bytes(data)


def main() -> None:
    """Run from the command line; exit code 1 if anything broke."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").split("\n", 1)[0])
    parser.add_argument("--minutes", type=float, default=60.0, help="how long (default: 60)")
    parser.add_argument("--jobs", type=int, default=2, help="processes at a time (default: 2)")
    parser.add_argument(
        "--start", type=int, default=int(time.time()), help="where the cases start (default: the time)"
    )
    parser.add_argument(
        "--kind", choices=list(kinds.KINDS), action="append", default=[], help="this kind; may be given again"
    )
    parser.add_argument("--seed", type=int, help="with --kind: this one case, here")
    parser.add_argument("--out", type=Path, default=Path("out/deep"), help="folder for what breaks")
    given = parser.parse_args()
    if given.seed is not None:
        if len(given.kind) != 1:
            parser.error("--seed goes with one --kind")
        kinds.run(given.kind[0], given.seed)
        return
    tally = run(given.minutes, given.jobs, given.start, given.kind, given.out)
    print(tally.table())
    print(
        f"\nstart {given.start}; what broke is in {given.out}"
        if tally.broken
        else f"\nstart {given.start}; nothing broke"
    )
    sys.exit(1 if tally.broken else 0)


if __name__ == "__main__":
    main()
