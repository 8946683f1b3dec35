"""Motion through change points: over several revolutions, with links of very different length, in batches."""

from __future__ import annotations

import numpy as np
import pytest

import linkwright as lw
from linkwright import AssemblyError


def four_bar(crank: float, coupler: float, rocker: float, frame: float, side: str = "left") -> lw.Machine:
    return lw.loads(f"""
        format = 1
        name = "four-bar"
        [mechanism.points]
        D = {{ x = {frame!r} }}
        [mechanism.cranks]
        A = {{ radius = {crank!r} }}
        [mechanism.rockers]
        R = {{ crank = "A", pivot = "D", coupler = {coupler!r}, rocker = {rocker!r}, assembly = "{side}" }}
        [bodies]
        "R.rocker" = {{ mass = 1 }}
    """)


@pytest.mark.parametrize("lengths", [(2, 3, 5, 4), (0.1, 0.35, 0.2, 0.25), (0.1, 0.3, 0.2, 0.2)])
@pytest.mark.parametrize("side", ["left", "right"])
def test_one_change_point_a_turn(lengths: tuple[float, ...], side: str) -> None:
    """The motion comes back after two revolutions, and is smooth: its joint and rates do not jump."""
    machine = four_bar(*lengths, side=side)
    assert lw.period_turns(machine) == 2
    angles = np.linspace(0, 4 * np.pi, 20001)
    motion = lw.kinematics(machine, angles)
    step = angles[1]
    joint, rocker = motion.points["R"], motion.links["R.rocker"]
    # A step of the trapezoidal rule errs by h³/12 times a third derivative of some hundreds of lengths.
    rise = np.diff(joint.position, axis=0) - 0.5 * step * (joint.d1[1:] + joint.d1[:-1])
    assert np.abs(rise).max() < 1e-8 * max(lengths)
    bend = np.diff(rocker.d1) - 0.5 * step * (rocker.d2[1:] + rocker.d2[:-1])
    assert np.abs(bend).max() < 1e-7


@pytest.mark.parametrize("crank", [0.1, 4e-3, 1e-3, 1e-4])
def test_short_cranks_of_a_parallelogram(crank: float) -> None:
    """ψ′ = 1 whatever the lengths; digits are lost by frame over crank, and by 1e4 outside the series."""
    machine = four_bar(crank, 0.3, crank, 0.3)
    rocker = lw.kinematics(machine, np.linspace(0, 4 * np.pi, 4001)).links["R.rocker"]
    np.testing.assert_allclose(rocker.d1, 1.0, atol=1e-12 * 0.3 / crank)
    np.testing.assert_allclose(rocker.d2, 0.0, atol=1e-10 * 0.3 / crank)


def test_masses_may_vary_where_lengths_do_not() -> None:
    machine = four_bar(0.1, 0.3, 0.1, 0.3)
    many = lw.replace(machine, {"bodies.R.rocker.mass": np.array([1.0, 2.0])})
    angles = np.linspace(0, 2 * np.pi, 37)
    alone = lw.kinematics(machine, angles).points["R"].position
    both = lw.kinematics(many, angles).points["R"].position
    np.testing.assert_allclose(both, [alone, alone], atol=1e-15)


@pytest.mark.parametrize(
    ("law", "words"),
    [
        ("sqrt(phi - 1)", "no usable value or slope at crank angle 0°"),
        ("0.5*sign(sin(phi - 1))", "jumps at crank angle 57.3°"),
        ("1/(phi - 1)", "57.3°"),
        ("exp(exp(10*phi))", "no usable value"),
    ],
)
def test_laws_that_cannot_be_followed(law: str, words: str) -> None:
    machine = four_bar(0.1, 0.3, 0.2, 0.3)
    crank = machine.mechanism.cranks["A"].with_entries({"law": law})
    mechanism = machine.mechanism.with_entries({"cranks": {"A": crank}})
    with pytest.raises(AssemblyError, match="the law of A") as caught:
        lw.reduction(machine.with_entries({"mechanism": mechanism}))
    assert words in str(caught.value)


def test_a_joint_in_line_has_no_side() -> None:
    machine = lw.loads("""
        format = 1
        name = "in line"
        [mechanism.points]
        D = { x = 0.4 }
        [mechanism.cranks]
        A = { radius = 0.1 }
        [mechanism.joints]
        E = { x = 0.5, y = 0 }
        [mechanism.bars]
        a = { start = "A", end = "E", length = 0.4 }
        b = { start = "D", end = "E", length = 0.1 }
    """)
    with pytest.raises(AssemblyError, match="in line with the points that hold it"):
        lw.closure(machine)


def test_points_carried_by_one_another_in_a_group() -> None:
    """Twelve points, each fixed to a bar that starts at the one before: the plate's corner all the same."""
    links = "\n".join(
        f"""
        [mechanism.joints.J{k}]
        x = {0.4 + 0.01 * k}
        y = 0.3
        [mechanism.bars.e{k}]
        start = "K{k}"
        end = "J{k}"
        length = 0.1
        [mechanism.bars.f{k}]
        start = "C"
        end = "J{k}"
        length = 0.5
        [mechanism.rigid_points.K{k + 1}]
        link = "e{k}"
        along = 0
        """
        for k in range(12)
    )
    machine = lw.loads(f"""
        format = 1
        name = "carried"
        [mechanism.points]
        B = {{ x = 0.75 }}
        C = {{ x = 0.9, y = 0.2 }}
        [mechanism.cranks]
        A = {{ radius = 0.05 }}
        [mechanism.joints]
        P = {{ x = 0.25, y = 0.35 }}
        Q = {{ x = 0.55, y = 0.35 }}
        [mechanism.bars]
        a = {{ start = "A", end = "P", length = 0.4 }}
        pq = {{ start = "P", end = "Q", length = 0.3 }}
        b = {{ start = "Q", end = "B", length = 0.41 }}
        c = {{ start = "K12", end = "C", length = 0.5 }}
        [mechanism.rigid_points]
        K0 = {{ link = "pq", along = 0.15, across = -0.2 }}
        {links}
    """)
    motion = lw.kinematics(machine, np.linspace(0, 2 * np.pi, 25))
    apart = motion.points["K12"].position - np.array([0.9, 0.2])
    np.testing.assert_allclose(np.hypot(*apart.T), 0.5, atol=1e-13)
