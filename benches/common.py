"""What all benches share: a row, interleaved timing, memory that is kept, facts about the machine."""

from __future__ import annotations

import ctypes
import os
import platform
import subprocess
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from importlib import metadata
from pathlib import Path
from typing import Any, Literal

ROOT = Path(__file__).parents[1]

Act = Callable[[], Any]

# Aims in times and rates are for a processor on which the four-bar by hand takes so long a position [ns].
PACE = 4.5

# So many times worse than its aim no row may be: a kernel that is no longer inlined is some 25 times slower.
FLOOR = 8.0


@dataclass(frozen=True)
class Row:
    """One line of the table.

    Attributes
    ----------
    case : str
        What was asked.
    unit : str
        Of ``product`` and ``peer``.
    product, peer : float or None
        Measured; None where there is nothing to compare with.
    peer_name : str
        What a user would use instead.
    ratio : float or None
        How many times better the product is than the peer.
    target : float or None
        What is aimed at; None for a row that only informs.
    aim : str
        Which number the target is for.
    note : str
        What one needs to know to read the row.
    pace : float or None
        What the processor did meanwhile: nanoseconds of the four-bar by hand a position (`peers/kernels.py`).
    """

    case: str
    unit: str
    product: float | None
    peer_name: str = ""
    peer: float | None = None
    ratio: float | None = None
    target: float | None = None
    aim: Literal["ratio", "at least", "at most"] = "ratio"
    note: str = ""
    pace: float | None = None

    @property
    def paced(self) -> float | None:
        """The product's number at the processor speed that times and rates are aimed at; None for ratios."""
        if self.pace is None or self.product is None or self.target is None or self.aim == "ratio":
            return None
        slower = self.pace / PACE
        return self.product / slower if self.aim == "at most" else self.product * slower

    @property
    def is_met(self) -> bool | None:
        """Whether the target is met, at its processor speed; None without target or without measurement."""
        return self._is_within(1.0)

    @property
    def is_sound(self) -> bool:
        """Whether the product is not so far from the target that a kernel must have come apart."""
        return self._is_within(FLOOR) is not False

    def _is_within(self, factor: float) -> bool | None:
        value = self.ratio if self.aim == "ratio" else self.product if self.paced is None else self.paced
        if self.target is None or value is None:
            return None
        return value <= self.target * factor if self.aim == "at most" else value * factor >= self.target


def faster(
    case: str, product: float, peer_name: str, peer: float, *, target: float | None = None, note: str = ""
) -> Row:
    """A row of two times in milliseconds, from seconds; the target is for their ratio."""
    return Row(case, "ms", 1e3 * product, peer_name, 1e3 * peer, peer / product, target, "ratio", note)


def seconds(acts: Sequence[Act], *, repeats: int, shortest: float = 0.02) -> list[float]:
    """Minimum time of each act, all taking turns so that a busy machine disturbs them alike.

    Parameters
    ----------
    acts : sequence of callable
        What is timed.
    repeats : int
        How many measurements of each.
    shortest : float
        An act is repeated within a measurement until this long [s].

    Returns
    -------
    list of float
        Seconds for one call of each act.
    """
    calls = [_calls(act, shortest) for act in acts]
    times: list[list[float]] = [[] for _ in acts]
    for _ in range(repeats):
        for act, n, found in zip(acts, calls, times, strict=True):
            found.append(_once(act, n) / n)
    return [min(found) for found in times]


def _calls(act: Act, shortest: float) -> int:
    """How often an act fits into the shortest measurement; the first call, which warms up, does not count."""
    act()
    return max(1, round(shortest / max(_once(act, 1), 1e-9)))


def _once(act: Act, n: int) -> float:
    start = time.perf_counter()
    for _ in range(n):
        act()
    return time.perf_counter() - start


# Blocks of memory up to this stay with the process, and so does what is free at the end of its heap [bytes].
KEPT = 1 << 30


def keep_memory() -> bool:
    """Let the process keep what it has freed; False where its allocator has no such setting.

    glibc gives large blocks back to the system and gets them again page by page, until it has seen larger
    ones freed: arrays of NumPy then take up to four times as long in a fresh process as in one in which
    other cases ran before.
    """
    mallopt = getattr(ctypes.CDLL(None), "mallopt", None) if os.name == "posix" else None
    if mallopt is None:
        return False
    # M_MMAP_THRESHOLD and M_TRIM_THRESHOLD of malloc.h.
    return all([mallopt(-3, KEPT), mallopt(-1, KEPT)])


def is_installed(package: str) -> bool:
    """Whether an optional peer is there."""
    return version(package) is not None


def version(package: str) -> str | None:
    """Version of an installed package; None if it is not installed."""
    try:
        return metadata.version(package)
    except metadata.PackageNotFoundError:
        return None


def facts() -> dict[str, Any]:
    """What the numbers depend on: processor, cores, load, versions."""
    names = ("linkwright", "numpy", "scipy", "exudyn", "pylinkage", "numba", "opentorsion")
    return {
        "processor": _processor(),
        "cores": len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count(),
        "load_average": round(os.getloadavg()[0], 2) if hasattr(os, "getloadavg") else None,
        "system": platform.platform(),
        "python": platform.python_version(),
        "commit": _commit(),
        "date": time.strftime("%Y-%m-%d %H:%M"),
        "versions": {name: version(name) for name in names},
    }


def _processor() -> str:
    """Name of the processor and its widest vector instructions."""
    path = Path("/proc/cpuinfo")
    if not path.exists():
        return platform.processor()
    lines = dict(line.split("\t: ", 1) for line in path.read_text().splitlines() if "\t: " in line)
    found = {key.strip(): value for key, value in lines.items()}
    flags = found.get("flags", "").split()
    width = next((name for name in ("avx512f", "avx2", "sse2") if name in flags), "")
    return f"{found.get('model name', platform.processor())} ({width})"


def _commit() -> str:
    command = ["git", "-C", str(ROOT), "describe", "--always", "--dirty"]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    return done.stdout.strip()
