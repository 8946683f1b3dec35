"""The kernels by hand, compiled for this processor (`kernels.rs`)."""

from __future__ import annotations

import ctypes
import os
import shutil
import subprocess
import tempfile
from functools import cache
from pathlib import Path
from time import perf_counter_ns
from typing import Any

import numpy as np

SOURCE = Path(__file__).with_name("kernels.rs")

THREADS = len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1

# Crank, coupler, rocker, frame [m]; coupler point along and across [m].
FOUR_BAR = (0.1, 0.35, 0.3, 0.4, 0.2, 0.1)

# Positions of a call that takes little besides its kernel, and whose results stay in the second cache.
N_PACE = 8192


def four_bars(couplers: Any, cos: Any, sin: Any, out: Any) -> Any:
    """Motions of machines that differ in their coupler.

    Parameters
    ----------
    couplers : ndarray, shape (rows,)
        Lengths of the coupler [m].
    cos, sin : ndarray, shape (n,)
        Of the crank angles.
    out : ndarray, shape (rows, 8, n)
        x, y, x′, y′, x″, y″ of the coupler point, ψ′, ψ″ of the rocker.
    """
    lengths = np.tile(FOUR_BAR, (len(couplers), 1))
    lengths[:, 1] = couplers
    rows, _, n = out.shape
    _library().four_bars(rows, _at(lengths), n, _at(cos), _at(sin), _at(out), THREADS)
    return out


def four_bar_over(phi: Any, out: Any, threads: int = THREADS) -> Any:
    """Motion of one machine over crank angles [rad]; ``out`` is (8, n)."""
    lengths = np.array(FOUR_BAR)
    _library().four_bar_over(_at(lengths), len(phi), _at(phi), _at(out), threads)
    return out


def pace() -> float:
    """Minimum time of a thread of this processor for a position of the four-bar [ns], of many."""
    phi = np.linspace(0, 2 * np.pi, N_PACE)
    out = np.empty((8, N_PACE))
    times = []
    for _ in range(500):
        start = perf_counter_ns()
        four_bar_over(phi, out, threads=1)
        times.append(perf_counter_ns() - start)
    return min(times) / N_PACE


def drives(numbers: Any, steps: int, turns: int) -> Any:
    """Speeds of slider-cranks with motor after some revolutions, over the synchronous one.

    Parameters
    ----------
    numbers : ndarray, shape (11, machines)
        See `kernels.rs`; a multiple of eight machines.
    steps, turns : int
        Steps of the method of Runge and Kutta a revolution, revolutions.
    """
    out = np.empty(numbers.shape[1])
    _library().drives(numbers.shape[1], _at(numbers), steps, turns, _at(out), THREADS)
    return out


def is_here() -> bool:
    """Whether there is a compiler."""
    return shutil.which("rustc") is not None


def _at(array: Any) -> Any:
    assert array.flags.c_contiguous
    assert array.dtype == np.float64
    return array.ctypes.data


@cache
def _library() -> Any:
    """The kernels as a library; registers as wide as the processor has them."""
    library = Path(tempfile.mkdtemp()) / "libkernels.so"
    flags = ["opt-level=3", "target-cpu=native", "panic=abort"]
    if "avx512f" in (Path("/proc/cpuinfo").read_text() if Path("/proc/cpuinfo").exists() else ""):
        flags.append("target-feature=-prefer-256-bit")
    options = [word for flag in flags for word in ("-C", flag)]
    command = ["rustc", "--edition", "2021", "-A", "non_snake_case", *options, "--crate-type", "cdylib"]
    subprocess.run([*command, "-o", library, SOURCE], check=True, capture_output=True)
    found = ctypes.CDLL(str(library))
    size, pointer = ctypes.c_size_t, ctypes.c_void_p
    found.four_bars.argtypes = [size, pointer, size, pointer, pointer, pointer, size]
    found.four_bar_over.argtypes = [pointer, size, pointer, pointer, size]
    found.drives.argtypes = [size, pointer, size, size, pointer, size]
    return found
