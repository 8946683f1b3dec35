"""Derivatives of elastic motions with kinks of their own, loose links or further mechanisms; multipliers."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from loose_drives import random_loose_drive
from mounted_trains import random_train
from numpy.random import Generator
from sizes import random_cases
from test_elastic_gradient import differences
from test_loose_links import rattling
from test_mounted_trains import line_shaft

import linkwright as lw
from linkwright.machine.write import dumps

# Relative change of all entries between which differences are taken: farther off is another motion.
STEP = 2e-5


def require_derivatives(
    machine: lw.Machine, rng: Generator, number: int = 0, entries: list[str] | None = None
) -> lw.Gradient:
    """All numbers along a random direction of all entries against differences, but where derivatives tie."""
    gradient = lw.gradient(machine, ["elastic_motion"], entries)
    # Entries that change nothing may stand at the end of their range.
    counts = np.nan_to_num(gradient.derivatives).any(axis=0)
    change = {
        name: rng.uniform(-1, 1) * count for name, count in zip(gradient.variables, counts, strict=True)
    }
    by = np.array([change[name] * x for name, x in zip(gradient.variables, gradient.at, strict=True)])
    expected, error = differences(machine, change, gradient.responses, STEP)
    scale = np.maximum(np.abs(gradient.derivatives * by).max(axis=1), np.abs(expected))
    off = np.abs(gradient.derivatives @ by - expected)
    wrong = [
        (name, float(gap / size))
        for name, gap, size, noise in zip(gradient.responses, off, scale, error, strict=True)
        if gap > 1e-5 * size + 30 * noise and name not in gradient.ties
    ]
    assert not wrong, (number, wrong)
    return gradient


def test_derivatives_of_loose_drives_are_those_of_differences() -> None:
    """All numbers, multiplier included, by all entries at once; a derivative that is missing is rare."""
    missing = motions = 0
    for number, rng in random_cases(4802, 1, 60, also=(3,)):
        loose = random_loose_drive(rng)
        try:
            gradient = require_derivatives(loose.machine, rng, number)
        except (lw.SteadyStateError, lw.ConvergenceError):
            # What is refused is looked at in test_loose_links.
            continue
        motions += 1
        missing += "elastic_motion.multiplier_max" not in gradient.responses
    assert missing <= motions // 10


def test_multipliers_of_trains_have_the_derivatives_of_differences() -> None:
    """Two motors and two cranks at ratios of 1, 2 and ½: kinks of the second crank move with the motion."""
    for n, (number, rng) in enumerate(random_cases(4810, 2, 30)):
        train = random_train(rng, (1.0, 2.0, 0.5)[n % 3])
        # Ratios of gears are those of whole numbers of teeth; drives of presses do not count.
        left_out = ("train.gears.", ".drive.")
        entries = [name for name in lw.addresses(train.machine) if not any(x in name for x in left_out)]
        gradient = require_derivatives(train.machine, rng, number, entries)
        assert "elastic_motion.multiplier_max" in gradient.responses


def test_a_kink_of_the_law_moves_the_multiplier_and_not_the_motion() -> None:
    """Of a rattling shaft: by the backlash alone, against a difference of two motions."""
    machine = rattling(stiffness=2e4, damping=40.0, backlash=0.01)
    entry, response = "drive.crankshaft.backlash", "elastic_motion.multiplier_max"
    gradient = lw.gradient(machine, [response], [entry])

    def multiplier(share: float) -> float:
        return lw.elastic_motion(
            lw.replace(machine, {entry: 0.01 * (1 + share)}), accuracy=1e-12, n=4
        ).multiplier_max

    slope = (multiplier(1e-5) - multiplier(-1e-5)) / (2e-5 * 0.01)
    assert slope != 0
    assert gradient.derivatives[0, 0] == pytest.approx(slope, rel=1e-5)


def test_entries_of_mounted_machines_have_derivatives(tmp_path: Path) -> None:
    """A rod, a mass and a load of each press, by their addresses in the train, against differences."""
    machine = line_shaft(tmp_path)
    below = ("bodies.S.mass", "mechanism.sliders.S.rod", "mechanism.cranks.A.radius", "loads.oil.damping")
    names = [f"train.mechanisms.press{k}.machine.{name}" for k in (1, 2) for name in below]
    gradient = require_derivatives(machine, np.random.default_rng(4840), entries=names)
    assert gradient.variables == tuple(names)
    assert gradient.derivatives.any(axis=0).all()


def test_a_mass_on_the_faster_crank_counts_by_the_revolutions_of_the_first(tmp_path: Path) -> None:
    """Work per revolution is that of the first crank, whichever mechanism the entry belongs to."""
    machine = line_shaft(tmp_path)
    text = {"train.gears": {"pair": {"between": ["c2", "x"], "teeth": [20, 40]}}}
    text["train.discs.x"] = {"inertia": 0.5}
    faster = lw.loads(dumps(machine), text | {"train.mechanisms.press1.on": "x"})
    name = "train.mechanisms.press2.machine.loads.oil.damping"
    gradient = lw.gradient(faster, ["elastic_motion.energy_load", "elastic_motion.period"], [name])
    expected, error = differences(faster, {name: 1.0}, gradient.responses, 1e-4)
    found = gradient.derivatives[:, 0] * gradient.at[0]
    assert (np.abs(found - expected) <= 1e-6 * np.abs(expected) + 30 * error).all()


def test_overrides_reach_into_the_file_of_a_mounted_machine(tmp_path: Path) -> None:
    """`train.mechanisms.NAME.machine.bodies.S.mass` changes that machine alone; faults name it."""
    line_shaft(tmp_path)
    address = "train.mechanisms.press2.machine.bodies.S.mass"
    machine = lw.read(tmp_path / "line.toml", [f"{address}=80 kg"])
    assert lw.get(machine, address) == 80.0
    assert lw.get(machine, address.replace("press2", "press1")) == 60.0
    with pytest.raises(lw.MachineFileError, match=rf"--set {address}=-1: bodies\.S\.mass\n.*found:    -1"):
        lw.read(tmp_path / "line.toml", [f"{address}=-1"])
    with pytest.raises(lw.InputError, match=r'"press1", "press2"'):
        lw.read(tmp_path / "line.toml", [f"{address.replace('press2', 'press3')}=80"])
