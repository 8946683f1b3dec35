"""What becomes of a sweep on two workers if one of them is killed?

2048 rows here; a million with rows = 1_000_000 and chunk = 10_000 in the study, on the command line:
linkwright sweep study.toml --workers 2 --out rows
"""

import multiprocessing
import time
from functools import cache
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np

import linkwright as lw

HERE = Path(__file__).parent


@cache
def swept():
    """Times [s] and rows done; the files, and those of one process that nothing stops."""
    plan, told, began = lw.read_study(HERE / "study.toml"), [], time.monotonic()

    def watch(done: int, total: int, rate: float) -> None:
        told.append((time.monotonic() - began, done))
        if len(told) == 3:
            multiprocessing.active_children()[0].kill()

    with TemporaryDirectory() as folder:
        lw.sweep(plan, f"{folder}/two", workers=2, watch=watch)
        lw.sweep(plan, f"{folder}/one")
        parts = [sorted(Path(folder, name).iterdir()) for name in ("two", "one")]
        return told, *({(part.name, part.read_bytes()) for part in of} for of in parts)


def study(machine: lw.Machine) -> dict[str, float]:
    """Rows that were computed, files, and how many of these differ from those of one process."""
    told, two, one = swept()
    return {"rows": float(told[-1][1]), "files": float(len(two)), "files_that_differ": float(len(two ^ one))}


def figure(machine: lw.Machine):
    """Rows done over the time, with the loss of the worker."""
    from matplotlib.figure import Figure

    times, rows = np.transpose(swept()[0])
    drawing = Figure(figsize=(7, 3.6), layout="constrained")
    axes = drawing.subplots()
    axes.step(times, rows, where="post", color="#0072b2")
    axes.axvline(times[2], color="#d55e00", linestyle="--", label="a worker is killed")
    axes.set(xlabel="time [s]", ylabel="rows that are written", ylim=(0, None))
    axes.legend(frameon=False)
    return drawing


if __name__ == "__main__":
    for name, value in study(lw.read(HERE / "machine.toml")).items():
        print(f"{name:28} {value:.6g}")
    figure(lw.read(HERE / "machine.toml")).savefig(HERE / "figure.png", dpi=120)
