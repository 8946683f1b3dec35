"""Machines of a batch are assembled as each of them is alone, or the batch is refused with the row."""

from __future__ import annotations

import numpy as np
import pytest

import linkwright as lw
from linkwright import FindingError, InputError

MOTOR = """
[drive]
motor = { kind = "dc", speed_no_load = 30, torque_stall = 400, inertia = 0.05 }
"""

# A joint on two bars, whose side of the line between their ends its given place tells.
DYAD = f"""
format = 1
name = "Joint on two bars"
mechanism.points.P = {{ x = 0.3, y = 0.05 }}
mechanism.cranks.A.radius = 0.08
mechanism.joints.C = {{ x = 0.2, y = 0.2 }}
mechanism.bars.coupler = {{ start = "A", end = "C", length = 0.25 }}
mechanism.bars.rocker = {{ start = "P", end = "C", length = 0.2 }}
bodies.C = {{ mass = 8 }}
loads.gravity = {{ kind = "gravity" }}
loads.drag = {{ kind = "viscous", on = "C", damping = 40 }}
{MOTOR}"""

# A plate on three bars: its joints are found together, from their given places.
PLATE = f"""
format = 1
name = "Plate on three bars"
[mechanism]
points.TP = {{ x = 0.1169, y = -0.0318 }}
points.TQ = {{ x = 0.2523, y = -0.0146 }}
cranks.A = {{ radius = 0.0274, phase = -1.81 }}
rigid_points.E = {{ link = "plate", along = 0.0257, across = 0.0514 }}
bars.left = {{ start = "TP", end = "C", length = 0.1176 }}
bars.right = {{ start = "TQ", end = "D", length = 0.1233 }}
bars.plate = {{ start = "C", end = "D", length = 0.1576 }}
bars.rod = {{ start = "A", end = "E", length = 0.1519 }}
joints.C = {{ x = 0.1199, y = 0.0942 }}
joints.D = {{ x = 0.2654, y = 0.1027 }}
[bodies]
C.mass = 20
[loads]
gravity = {{ kind = "gravity" }}
drag = {{ kind = "viscous", on = "D", damping = 200 }}
{MOTOR}"""


def alone(machine: lw.Machine, entries: dict[str, np.ndarray], row: int) -> float | None:
    """The maximum speed of one machine by itself; None if it has no answer."""
    try:
        own = lw.replace(machine, {address: float(column[row]) for address, column in entries.items()})
        return lw.steady_state(own).speed_max
    except FindingError:
        return None


def agrees(machine: lw.Machine, entries: dict[str, np.ndarray]) -> int:
    rows = lw.steady_states(machine, entries)
    for row, status in enumerate(rows.status):
        speed = alone(machine, entries, row)
        assert (status == 0) == (speed is not None), row
        if speed is not None:
            # What a batch is computed to.
            assert rows.speed_max[row] == pytest.approx(speed, rel=1e-7), row
    return int((rows.status == 0).sum())


def test_each_row_has_the_side_that_its_place_tells() -> None:
    """Drawn above and below the line of its ends, with masses and without."""
    machine = lw.loads(DYAD)
    heights = np.array([0.2, -0.2, 0.3, -0.1])
    assert agrees(machine, {"mechanism.joints.C.y": heights}) == 4
    masses = np.array([8.0, 9.0, 10.0, 11.0])
    assert agrees(machine, {"mechanism.joints.C.y": heights, "bodies.C.mass": masses}) == 4
    speeds = lw.steady_states(machine, {"mechanism.joints.C.y": heights}).speed_max
    assert abs(speeds[0] - speeds[1]) > 1e-6 * speeds[0]
    assert speeds[0] == speeds[2]


BARS = [f"mechanism.bars.{name}.length" for name in ("left", "right", "plate", "rod")]


def test_rows_of_a_group_are_assembled_as_each_alone() -> None:
    machine, random = lw.loads(PLATE), np.random.default_rng(8)
    answered = 0
    for spread in (0.02, 0.1, 0.3, 0.6) * 4:
        entries = {bar: lw.get(machine, bar) * random.uniform(1 - spread, 1 + spread, 3) for bar in BARS}
        try:
            answered += agrees(machine, entries)
        except (InputError, FindingError):
            # Refused, or the first does not move.
            continue
    assert answered >= 10


def test_a_group_that_is_assembled_otherwise_is_refused_with_its_row() -> None:
    machine = lw.loads(PLATE)
    lengths = ([0.1176, 0.375919], [0.1233, 0.452694], [0.1576, 0.036684], [0.1519, 0.351815])
    entries = {bar: np.array(length) for bar, length in zip(BARS, lengths, strict=True)}
    assert alone(machine, entries, 1) is not None
    with pytest.raises(InputError, match="row 1: the joints C and D have another assembly mode"):
        lw.steady_states(machine, entries)


@pytest.mark.parametrize("others", [{}, {"bodies.C.mass": np.array([20.0, 20.0])}])
def test_places_of_the_joints_of_a_group_are_refused_by_name(others: dict[str, np.ndarray]) -> None:
    machine = lw.loads(PLATE)
    with pytest.raises(InputError, match=r"mechanism\.joints\.D: its position selects the assembly mode"):
        lw.steady_states(machine, {"mechanism.joints.D.x": np.array([0.2654, 0.05]), **others})
