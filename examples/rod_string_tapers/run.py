"""How long must each size of a tapered rod string be for all of them to be loaded alike?"""

from pathlib import Path

import numpy as np
from scipy.optimize import root

import linkwright as lw


def given(machine: lw.Machine) -> np.ndarray:
    """Lengths of the sections of the file."""
    return np.array([section.length for section in machine.rod_string.sections])


def loading(machine: lw.Machine, lengths: np.ndarray) -> np.ndarray:
    """Stress range of each section over what the Goodman diagram permits."""
    entries = {f"rod_string.sections.{n}.length": float(length) for n, length in enumerate(lengths)}
    return lw.rod_string(lw.replace(machine, entries), accuracy=3e-3).stress.loading


def equal(machine: lw.Machine) -> np.ndarray:
    """Lengths at which every section is loaded alike, of the same depth."""
    start = given(machine)
    depth = start.sum()

    def differences(upper: np.ndarray) -> np.ndarray:
        return np.diff(loading(machine, depth * np.append(upper, 1 - upper.sum())))

    upper = root(differences, start[:-1] / depth, tol=1e-3).x
    return depth * np.append(upper, 1 - upper.sum())


def study(machine: lw.Machine) -> dict[str, float]:
    """Largest loading of the string of the file, and of that with equal ones; its lengths."""
    lengths = equal(machine)
    found = {f"length_{n}": length for n, length in enumerate(lengths, start=1)}
    before, after = (loading(machine, each) for each in (given(machine), lengths))
    return {"before": before.max(), "after": after.max(), "spread": np.ptp(after), **found}


def figure(machine: lw.Machine):
    """Loading of each section, before and after."""
    from matplotlib.figure import Figure

    drawing = Figure(figsize=(7, 4), layout="constrained")
    axes, places = drawing.subplots(), np.arange(3)
    axes.bar(places, 100 * loading(machine, given(machine)), 0.4, label="lengths of the file")
    axes.bar(places + 0.4, 100 * loading(machine, equal(machine)), 0.4, label="equal loading")
    axes.set(xticks=places + 0.2, xticklabels=["1 in", "⅞ in", "¾ in"], ylabel="Goodman loading [%]")
    axes.legend()
    return drawing


if __name__ == "__main__":
    example = lw.read(Path(__file__).parent / "machine.toml")
    for name, value in study(example).items():
        print(f"{name:10} {value:.6g}")
    figure(example).savefig(Path(__file__).parent / "figure.png", dpi=120)
