"""Which inertia and which friction does a press have that coasts to rest?

The record is simulated: 118 kg m², 310 N and 5 N m s/rad, with noise of 0.3 rpm. That the mass of the ram is
known makes them known: without it the record tells their ratios alone.
On the command line: linkwright fit study.toml
"""

from functools import cache
from pathlib import Path

import numpy as np

import linkwright as lw

HERE = Path(__file__).parent


@cache
def fitted():
    """The numbers that explain the record best."""
    return lw.fit(lw.read_study(HERE / "study.toml"), lw.read_record(HERE / "run_down.csv"))


def study(machine: lw.Machine) -> dict[str, float]:
    """How far numbers are from those of the record, in half widths of their intervals; the noise."""
    found, known = fitted(), {"flywheel": 118.0, "guide": 310.0, "bearings": 5.0}
    misses = {
        f"{name}_off": abs(found.values[name] - value) / (found.intervals[name][1] - found.values[name])
        for name, value in known.items()
    }
    return misses | {"flywheel": found.values["flywheel"], "noise_rpm": found.noise["speed"] * 30 / np.pi}


def figure(machine: lw.Machine):
    """Record, fitted motion, residuals."""
    from linkwright.studies.figures import fit_figure

    return fit_figure(fitted())


if __name__ == "__main__":
    example = lw.read(HERE / "machine.toml")
    for name, value in study(example).items():
        print(f"{name:32} {value:.6g}")
    figure(example).savefig(HERE / "figure.png", dpi=120)
    print(f"{HERE / 'figure.png'}")
