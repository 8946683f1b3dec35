"""A million variants of two carts from the command line to Parquet, against the core and joblib."""

from __future__ import annotations

import os
import resource
import subprocess
import sys
import tempfile
import time
from pathlib import Path
from typing import Any

import machines
from common import Row, is_installed
from steady_many import NARROW, variants

import linkwright as lw

N, N_QUICK = 1_000_000, 50_000

# Machines of a batch of the core, which is a file of the sweep.
CHUNK = 10_000

# Memory that the process may take at most [MB].
PERMITTED = 1000.0

# Machines that SciPy does in each process.
SHARE = 12

STUDY = """
machine = "{machine}"

[variables.phase]
address = "mechanism.cranks.A2.phase"
range = ["87 deg", "93 deg"]

[variables.mass1]
address = "bodies.cart1.mass"
range = ["950 kg", "1050 kg"]

[variables.mass2]
address = "bodies.cart2.mass"
range = ["950 kg", "1050 kg"]

[variables.force]
address = ["loads.rolling1.force", "loads.rolling2.force"]
range = ["3384 N", "3740 N"]

[responses]
delta = "steady_state.unevenness"
H = "steady_state.dynamism"
k_p = "steady_state.motion_coefficient"

[sweep]
method = "sobol"
rows = {rows}
chunk = {chunk}
"""


def rows(quick: bool) -> list[Row]:
    """Time of the whole process over that of the core's batches; its memory; machines a second by joblib."""
    n = N_QUICK if quick else N
    whole, memory = swept(n)
    alone = batches(n)
    note = f"{n} rows; aim: the process takes 1.3 times as long as the core at most"
    case = "sweep to Parquet"
    return [
        Row(case, "s", whole, "batches of the core alone", alone, alone / whole, 1 / 1.3, note=note),
        Row(case, "MB", memory, "permitted", PERMITTED, PERMITTED / memory, 1.0, note="largest memory"),
        against_joblib(n / whole, case),
    ]


def swept(n: int) -> tuple[float, float]:
    """Seconds and largest memory [MB] of the command."""
    with tempfile.TemporaryDirectory() as folder:
        study = Path(folder) / "study.toml"
        study.write_text(STUDY.format(machine="roller_two_carts", rows=n, chunk=CHUNK))
        command = [
            sys.executable,
            "-m",
            "linkwright",
            "sweep",
            str(study),
            "--out",
            str(Path(folder) / "out"),
        ]
        start = time.perf_counter()
        subprocess.run(command, check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        return time.perf_counter() - start, 1e-3 * resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss


def batches(n: int) -> float:
    """Seconds that the core takes for as many machines in batches of a file each."""
    machine, entries = machines.two_carts(), variants(CHUNK, *NARROW)
    lw.steady_states(machine, entries)
    start = time.perf_counter()
    for _ in range(n // CHUNK):
        lw.steady_states(machine, entries)
    return time.perf_counter() - start


def against_joblib(rate: float, case: str) -> Row:
    """Machines a second by SciPy in as many processes as processors, measured on a share of them."""
    if not is_installed("joblib") or not is_installed("scipy"):
        return Row(case, "machines/s", rate, "joblib or SciPy is not installed")
    from joblib import Parallel, delayed

    processes = os.cpu_count() or 1
    drawn = [values[: SHARE * processes].tolist() for values in variants(SHARE * processes, *NARROW).values()]
    with Parallel(n_jobs=processes) as pool:
        pool(delayed(by_scipy)(*row[:4]) for row in list(zip(*drawn, strict=True))[:processes])
        start = time.perf_counter()
        pool(delayed(by_scipy)(*row[:4]) for row in zip(*drawn, strict=True))
        theirs = len(drawn[0]) / (time.perf_counter() - start)
    note = f"{len(drawn[0])} machines in {processes} processes"
    return Row(case, "machines/s", rate, "joblib + SciPy", theirs, rate / theirs, note=note)


def by_scipy(phase: float, mass_1: float, mass_2: float, force: float) -> Any:
    """One machine."""
    from peers import two_carts

    return two_carts.steady(two_carts.Drive(mass_1, mass_2, force, phase), 10.2).speed_min
