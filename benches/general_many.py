"""What does generality cost? A six-bar linkage from a file against a four-bar kernel by hand."""

from __future__ import annotations

import ctypes
import shutil
import subprocess
import tempfile
from collections.abc import Callable
from pathlib import Path

import numpy as np
from common import ROOT, Row, seconds

import linkwright as lw

HERE = Path(__file__).parent

# Angles in a call: as many as the core does in one thread, so that both have one.
N_ANGLES = 1024

# A Stephenson III chain has two dyads and a coupler point between them.
DYADS = 2


def rows(quick: bool) -> list[Row]:
    """Rates per dyad on one thread."""
    case, peer = "six-bar from a file, rate per dyad", "four-bar by hand, rustc"
    kernel = compiled()
    if kernel is None:
        return [Row(case, "ns", None, peer, None, None, 7.0, "at most", note="rustc is not installed")]
    phi = np.linspace(0, 2 * np.pi, N_ANGLES, endpoint=False)
    ours, theirs = np.empty((1, 6, N_ANGLES)), np.empty((6, N_ANGLES))
    machine = lw.read(HERE / "six_bar.toml")

    def product() -> object:
        return lw.motions(machine, phi, points=["S"], out=ours)

    def peer_call() -> None:
        kernel(phi, theirs)

    peer_call()
    off = np.abs(lw.motions(machine, phi, points=["R"])[0] - theirs).max()
    assert off < 1e-12, f"product and kernel differ by {off:g}"
    times = seconds([product, peer_call], repeats=7 if quick else 21, shortest=0.05)
    per_dyad, by_hand = times[0] / N_ANGLES / DYADS, times[1] / N_ANGLES
    note = (
        f"{N_ANGLES} angles a call, one thread, joint with two derivatives; the call from Python is included"
    )
    ratio = by_hand / per_dyad
    return [Row(case, "ns", 1e9 * per_dyad, peer, 1e9 * by_hand, ratio, 7.0, "at most", note)]


def compiled() -> Callable[[np.ndarray, np.ndarray], None] | None:
    """The kernel as a function of angles and result; None without a compiler."""
    if shutil.which("rustc") is None:
        return None
    folder = Path(tempfile.mkdtemp())
    library = folder / "libfour_bar.so"
    source = HERE / "peers" / "four_bar.rs"
    flags = ["-C", "opt-level=3", "-C", "target-cpu=native", "-C", "panic=abort", "--crate-type", "cdylib"]
    subprocess.run(["rustc", *flags, "-o", library, source], check=True, cwd=ROOT)
    call = ctypes.CDLL(str(library)).four_bar
    pointer = ctypes.POINTER(ctypes.c_double)
    call.argtypes = [ctypes.c_size_t, pointer, pointer]

    def run(phi: np.ndarray, out: np.ndarray) -> None:
        call(len(phi), phi.ctypes.data_as(pointer), out.ctypes.data_as(pointer))

    return run
