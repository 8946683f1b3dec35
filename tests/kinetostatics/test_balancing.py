"""Counterweights: Berkof and Lowen's closed form, harmonics of the slider-crank, and what remains."""

from __future__ import annotations

import numpy as np
import pytest
from zoo import animal

import linkwright as lw
from linkwright import (
    InputError,
    MachineError,
    ShapeError,
    balance,
    envelope,
    forces,
    harmonics,
    load_cases,
    partial_balance,
)
from linkwright.kinetostatics.balancing import four_bar_moments
from linkwright.kinetostatics.motion import motion_at

FOUR_BAR = "four-bar with coupler point"

ENGINE = """
format = 1
name = "engine"
[mechanism.cranks.A]
radius = 0.05
[mechanism.sliders.S]
crank = "A"
rod = 0.2
[bodies]
S = { mass = 1.2 }
pin = { on = "A", mass = 0.8, inertia = 0, along = 0.05 }
"""


def test_least_squares_are_those_of_berkof_and_lowen() -> None:
    machine = animal(FOUR_BAR)
    found = balance(machine, ["A", "R.rocker"], speed=5.0, radius=0.1)
    expected = four_bar_moments(machine, "R")
    for each in found.counterweights:
        moment = each.moment * np.exp(1j * each.angle)
        assert moment == pytest.approx(expected[each.link], rel=1e-10)
        assert each.mass * each.radius == pytest.approx(each.moment, rel=1e-14)
    before, after = found.measures()["shaking_force"]
    assert before > 5
    assert after < 1e-10 * before


def test_balanced_centre_of_mass_rests() -> None:
    """With counterweights by hand, in a machine file of its own, no force of inertia is left."""
    moments = four_bar_moments(animal(FOUR_BAR), "R")
    bodies = dict(animal(FOUR_BAR).bodies)
    for link, u in moments.items():
        bodies[f"c_{link[0]}"] = lw.Machine.model_fields["bodies"].annotation.__args__[1](
            on=link, mass=abs(u) / 0.2, inertia=0.0, along=0.2 * u.real / abs(u), across=0.2 * u.imag / abs(u)
        )
    machine = animal(FOUR_BAR).with_entries({"bodies": bodies})
    result = forces(machine, speed=5.0, acceleration=3.0)
    assert np.abs(result.contributions["inertia"].shaking_force).max() < 1e-10


def test_counterweight_on_one_link_is_the_best_one() -> None:
    """No counterweight nearby does better, and it does not depend on the constant speed."""
    machine = animal(FOUR_BAR)
    found = balance(machine, ["A"], speed=5.0, radius=0.1)
    best = found.measures()["shaking_force"][1]
    assert 0 < best < found.measures()["shaking_force"][0]
    for key in ("along", "across"):
        for change in (-1e-2, 1e-2):
            address = f"bodies.counterweight_A.{key}"
            value = lw.get(found.machine, address) + change
            near = lw.replace(found.machine, {address: value})
            force = forces(near, speed=5.0).contributions["inertia"].shaking_force
            assert np.sqrt((force[:-1] ** 2).sum(axis=1).mean()) > best
    other = balance(machine, ["A"], speed=9.0, radius=0.1)
    assert other.counterweights[0].moment == pytest.approx(found.counterweights[0].moment, rel=1e-10)


def test_harmonics_of_the_slider_crank() -> None:
    """First and second harmonic of the reciprocating force: m r ω² and m r ω² (λ + λ³/4 + 15 λ⁵/128)."""
    result = forces(lw.loads(ENGINE), speed=100.0)
    found = harmonics(result.crank_angle, result.shaking_force, 6)
    lam = 0.25
    r_omega2 = 0.05 * 1e4
    second = lam + lam**3 / 4 + 15 * lam**5 / 128
    # The series goes on with λ⁷.
    assert found.cosine[1, 0] == pytest.approx((1.2 + 0.8) * r_omega2, rel=1e-12)
    assert found.cosine[2, 0] == pytest.approx(1.2 * r_omega2 * second, rel=2e-5)
    assert found.amplitude[3, 0] < 1e-9
    # Across the guide what turns is left.
    assert found.sine[1, 1] == pytest.approx(0.8 * r_omega2, rel=1e-12)
    assert found.amplitude[2:, 1].max() < 1e-9


@pytest.mark.parametrize("share", [0.0, 0.5, 1.0])
def test_partial_balance_shifts_the_first_harmonic(share: float) -> None:
    """(1 − k) m r ω² along the guide, k m r ω² across."""
    found = partial_balance(lw.loads(ENGINE), "S", share=share, speed=100.0)
    assert found.counterweights[0].moment == pytest.approx((0.8 + share * 1.2) * 0.05, rel=1e-12)
    left = harmonics(found.after.crank_angle, found.after.shaking_force, 2)
    assert left.cosine[1, 0] == pytest.approx((1 - share) * 1.2 * 500, abs=1e-9)
    assert left.sine[1, 1] == pytest.approx(-share * 1.2 * 500, abs=1e-9)


def test_wrong_links_are_named() -> None:
    with pytest.raises(MachineError, match=r"R\.coupler(.|\n)*A, R\.rocker"):
        balance(animal(FOUR_BAR), ["R.coupler"], speed=1.0)
    with pytest.raises(InputError, match="radius"):
        balance(animal(FOUR_BAR), ["A"], speed=1.0, radius=-1.0)
    with pytest.raises(MachineError, match="pin of a crank"):
        partial_balance(lw.loads(ENGINE), "T")
    with pytest.raises(ShapeError, match="whole revolutions"):
        harmonics(np.array([0.0, 0.1, 0.3]), np.zeros(3))


def test_mean_over_time_of_an_uneven_revolution() -> None:
    """Few even angles give the mean speed, 2π over the period, though the speed varies by a fifth."""
    dc = '[drive.motor]\nkind = "dc"\nspeed_no_load = 50.0\ntorque_stall = 10.0\ninertia = 0.002\n'
    oil = '[loads.oil]\nkind = "viscous"\non = "A"\ndamping_torsional = 0.2\n'
    machine = lw.loads(ENGINE + dc + oil)
    steady = lw.steady_state(machine, n=90)
    assert steady.unevenness > 0.15
    # The solver's own accuracy; chords over uneven times err by 1e-4.
    found = motion_at(machine, steady).mean(steady.speed)
    assert found == pytest.approx(2 * np.pi / steady.period, rel=1e-8)


def test_envelope_has_peak_and_means() -> None:
    result = forces(lw.loads(ENGINE), speed=100.0)
    rows = {row.name: row for row in envelope(result)}
    # The largest force of inertia is at the far dead centre: (m_r (1 + λ) + m_t) r ω².
    row = rows["shaking_force"]
    assert row.peak == pytest.approx((1.2 * 1.25 + 0.8) * 500, rel=1e-12)
    assert row.peak_angle in (0.0, pytest.approx(2 * np.pi))
    assert rows["torque_drive"].mean == pytest.approx(0, abs=1e-9)
    torque = result.torque_drive[:-1]
    assert rows["torque_drive"].rms == pytest.approx(np.sqrt(np.mean(torque**2)), rel=1e-12)
    assert rows["S"].unit == "N"


def test_load_cases_stand_side_by_side() -> None:
    machine = animal("slider-crank with offset")
    found = load_cases(machine, {"as is": {}, "idle": {"loads.dry.force": 0.0}}, speed=3.0)
    share = found["as is"].contributions["loads.dry"].torque_drive
    difference = found["as is"].torque_drive - found["idle"].torque_drive
    np.testing.assert_allclose(difference, share, rtol=0, atol=1e-11)
    with pytest.raises(InputError, match="at least one"):
        load_cases(machine, {})
