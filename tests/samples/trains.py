"""Trains for tests: texts of machine files, and the matrices of a train written down by themselves."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

import linkwright as lw
from linkwright.torsion import FreeVibration

Floats = NDArray[np.float64]
Shaft = tuple[str, str, float]
# Ends, ratio, stiffness of the mesh.
Gear = tuple[str, str, float, float | None]


def text(discs: Mapping[str, float], shafts: Sequence[Shaft], gears: Sequence[Gear] = ()) -> str:
    lines = ["format = 1", 'name = "A train"', "[train.discs]"]
    lines += [f"{name} = {{ inertia = {J!r} }}" for name, J in discs.items()]
    lines += ["[train.shafts]"]
    lines += [
        f's{n} = {{ between = ["{a}", "{b}"], stiffness = {k!r} }}' for n, (a, b, k) in enumerate(shafts)
    ]
    lines += ["[train.gears]"]
    for n, (a, b, ratio, k) in enumerate(gears):
        mesh = "" if k is None else f", stiffness = {k!r}"
        lines.append(f'g{n} = {{ between = ["{a}", "{b}"], ratio = {ratio!r}{mesh} }}')
    return "\n".join(lines) + "\n"


def train(discs: Mapping[str, float], shafts: Sequence[Shaft], gears: Sequence[Gear] = ()) -> FreeVibration:
    return lw.free_vibration(lw.loads(text(discs, shafts, gears)))


def omega(found: FreeVibration) -> Floats:
    """Natural frequencies [rad/s]."""
    return 2 * np.pi * found.natural_frequencies


def matrices(
    discs: Mapping[str, float], shafts: Sequence[Shaft], gears: Sequence[Gear] = ()
) -> tuple[Floats, Floats]:
    """J and K in the angles of the discs themselves; all meshes elastic."""
    place = {name: n for n, name in enumerate(discs)}
    K = np.zeros((len(discs), len(discs)))
    links = [(a, b, 1.0, k) for a, b, k in shafts] + list(gears)
    for a, b, ratio, k in links:
        # Twist at the first end: θ_a − i θ_b, without what is held.
        row = np.zeros(len(discs))
        if a != "ground":
            row[place[a]] = 1.0
        if b != "ground":
            row[place[b]] = -ratio
        K += k * np.outer(row, row)
    return np.diag(list(discs.values())), K


def mode_numbers(found: FreeVibration, names: Sequence[str]) -> Floats:
    """Natural frequencies and amplitudes by the names that their derivatives have."""
    values = []
    for name in names:
        _, quantity, mode, *disc = name.split(".")
        row = getattr(found, quantity)[int(mode)]
        values.append(row[found.discs.index(disc[0])] if disc else row)
    return np.array(values)
