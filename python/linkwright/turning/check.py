"""What can be seen of a turning-moment diagram at once, and what it consists of."""

from __future__ import annotations

from collections.abc import Iterator

from linkwright.kernel.findings import Findings
from linkwright.kernel.reader.numbers import quantity
from linkwright.machine.machine import Machine
from linkwright.turning.diagram import turning_moment

# Kind of torque → words.
_TORQUES = {"constant": "constant torque", "formula": "formula", "table": "torque table"}


def check_diagram(machine: Machine, findings: Findings) -> Iterator[str]:
    """Whether driver and load balance over a cycle."""
    findings.of(turning_moment, machine, n=1)
    yield "turning-moment diagram: balance of driver and load over a cycle"


def diagram_summary(machine: Machine) -> Iterator[tuple[str, str]]:
    """What drives a shaft, and what resists."""
    described = machine.turning_moment
    if described is None:
        return
    if described.areas:
        words = f"{len(described.areas)} areas between driver and load"
    else:
        torques = {"driver": described.driver, "load": described.load}
        kinds = {name: "constant" if torque is None else torque.kind for name, torque in torques.items()}
        words = ", ".join(f"{name} {_TORQUES[kind]}" for name, kind in kinds.items())
    turns = "one revolution" if described.turns == 1 else f"{described.turns:.5g} revolutions"
    yield "turning moment", f"{words}; cycle of {turns}, {quantity(described.speed, 'rad/s')}"
