"""What can be seen of a train at once, and what it consists of."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from linkwright.kernel.findings import Findings
from linkwright.machine.machine import Machine
from linkwright.torsion.modes.free import free_vibration


def check_train(machine: Machine, findings: Findings) -> Iterator[str]:
    """Whether the train is connected and has natural frequencies."""
    free = findings.of(free_vibration, machine)
    # Frequencies that are no numbers: stiffnesses or inertias beyond what can be computed with.
    if free is not None and not np.isfinite(free.natural_frequencies).all():
        findings.add(
            [
                f"the train of {len(free.discs)} discs has no natural frequencies: its stiffnesses or "
                "inertias span too many orders of magnitude"
            ]
        )
    yield "train: connected, natural frequencies"


def train_summary(machine: Machine) -> Iterator[tuple[str, str]]:
    """The names of discs, shafts and gear stages."""
    if machine.train is not None:
        yield "discs", ", ".join(machine.train.discs)
        yield "shafts", ", ".join(machine.train.shafts)
        yield "gears", ", ".join([*machine.train.gears, *machine.train.planetaries])
