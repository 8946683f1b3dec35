"""Fatigue of crankshafts by IACS UR M53: factors and stresses by hand, forces of rods by their torque."""

import math
from pathlib import Path

import numpy as np
import pytest

import linkwright as lw
from linkwright import MachineFileError
from linkwright.torsion import Cylinder, firing_angles, piston_positions, running_gears, throw_reduction
from linkwright.torsion.model.engine.crank_concentration import (
    ThrowRatios,
    bore_bending,
    bore_torsion,
    journal_bending,
    journal_shear,
    pin_bending,
    torsion,
)
from linkwright.torsion.response.crank_bending import bending, pin_forces, rod_places, shear

SPEED = 157.0
PLAIN = ThrowRatios(s=0.0, w=0.5, b=1.5, r=0.05, r_G=0.05, r_T=0.05, d_G=0.0, d_H=0.0, t=0.0, d_O=0.1)


@pytest.fixture(scope="module")
def machine() -> lw.Machine:
    return lw.replace(lw.read("v8_diesel"), {"train.run.points": 8, "train.run.orders_max": 3.0})


def test_factors_by_hand() -> None:
    """Each printed factor worked out at w = 1/2, b = 3/2, s = 0, so that powers are few.

    f(s, w) = −4.1883 + 14.6002 − 19.398125 + 11.493175 − 2.5026, and so on.
    """
    of_overlap = 0.00435 + (9.5440 - 29.1740 + 39.835375 - 24.073075 + 5.330725)
    of_overlap += -3.8399 + 12.5222 - 17.639275 + 10.8791 - 2.44895
    web, width, radius = 2.1790 * 0.5**0.7171, 0.6840 - 0.01155 + 0.331425, 0.2081 * 0.05**-0.5231
    expected = 2.6914 * of_overlap * web * width * radius * 0.9993 * 0.9978
    assert pin_bending(PLAIN) == pytest.approx(expected, rel=1e-12)
    of_overlap = (-1.7625 + 1.49105 - 0.3819) + (5.1169 - 2.90445 + 0.784775)
    of_overlap += -2.1567 + 1.16485 - 0.3238
    web, width, radius = 2.2422 * 0.5**0.7548, 0.5616 + 0.17955 + 0.2646, 0.1908 * 0.05**-0.5568
    expected = 2.7146 * of_overlap * web * width * radius * 1.0012 * 1.0022
    assert journal_bending(PLAIN) == pytest.approx(expected, rel=1e-12)
    expected = 3.0128 * 1.0786 * 0.5 / 0.53215 * 0.5331 * 0.05**-0.2038 * 0.9937
    assert journal_shear(PLAIN) == pytest.approx(expected, rel=1e-12)
    expected = 0.8 * 0.05**-0.2205 * (7.8955 - 15.981 + 12.03345 - 2.892375) * 0.5**-0.145
    assert torsion(PLAIN, 0.05) == pytest.approx(expected, rel=1e-12)
    assert bore_bending(0.1) == pytest.approx(3 - 0.588 + 0.346)
    assert bore_torsion(0.1) == pytest.approx(4 - 0.6 + 0.3)
    recessed = PLAIN._replace(t=0.1, s=0.25)
    assert recessed.recess == pytest.approx(1 + 0.1 * 2.6)
    # A far overlap counts as −0.5, and a recess that would lower the stress not at all.
    assert PLAIN._replace(s=-2.0).overlap == -0.5
    assert PLAIN._replace(s=-2.0, t=0.1).recess == 1.0


def test_factors_are_one_at_their_reference() -> None:
    """The rule's factors of single sizes are scaled to 1 at one throw: b = 1.49, r = 0.05, no bores.

    A wrong coefficient would not be.
    """
    for size, of in (("b", 1.49), ("r", 0.0498), ("d_G", 0.0), ("d_H", 0.0)):
        base = PLAIN._replace(**{size: of})
        scaled = {
            "b": 0.6840 - 0.0077 * of + 0.1473 * of**2,
            "r": 0.2081 * max(of, 1e-9) ** -0.5231,
            "d_G": 0.9993,
            "d_H": 0.9978,
        }[size]
        # Rounding of the printed coefficients.
        assert scaled == pytest.approx(1.0, abs=3e-3)
        assert base.outside == ()


def test_forces_make_the_torque(machine: lw.Machine) -> None:
    """Tangential forces times radius: the torque of the gas by virtual work, and that of inertia, −½J′ω²."""
    assert machine.train is not None
    engine = machine.train.engine
    assert engine is not None
    cylinders = [Cylinder(engine.bore, engine.strokes, x) for x in piston_positions(engine)]
    fires, _ = firing_angles(engine.places, engine.firing_order, engine.cycle)
    for n, on in enumerate(pin_forces(engine, SPEED)):
        turned = on.crank_angle + engine.throws[n]
        torque = throw_reduction(engine.radius, running_gears(engine), turned).inertia_torque(SPEED)
        for c, place in enumerate(engine.places):
            if place.throw == n:
                gas = engine.gas.cycle_pressure(cylinders[place.bank], np.array([SPEED]))
                angle = on.crank_angle - fires[c]
                over = gas.at(angle - cylinders[place.bank].top)[0][0] - gas.crankcase_pressure
                torque = torque - over * cylinders[place.bank].area * cylinders[place.bank].motion(angle)[1]
        own = engine.radius * on.forces.imag.sum(axis=0)
        np.testing.assert_allclose(own, torque, rtol=0, atol=1e-9 * np.abs(torque).max())


def test_bending_of_a_beam(machine: lw.Machine) -> None:
    """A force in the middle gives F L/4 there, and F/2 in both webs; two rods lie beside each other."""
    assert machine.train is not None
    engine = machine.train.engine
    assert engine is not None
    assert engine.throw is not None
    throw = engine.throw
    L, force = throw.length, np.array([[1000.0 + 0j]])
    middle = np.array([L / 2])
    assert bending(throw, middle, force, L / 2)[0] == pytest.approx(250 * L)
    assert bending(throw, middle, force, L / 4)[0] == pytest.approx(125 * L)
    assert shear(throw, middle, force, True)[0] == shear(throw, middle, force, False)[0] == pytest.approx(500)
    np.testing.assert_allclose(rod_places(engine, throw), [0.0635, 0.1065], rtol=1e-12)


def test_acceptability_by_hand(machine: lw.Machine) -> None:
    """From the nominal stresses on, in N/mm² and mm as the rule is printed."""
    (found,) = lw.crankshaft_fatigue(machine)
    f, nominal = found.factors, found.bending_nominal / 1e6
    tau, shear_stress = found.torsion_pin / 1e6, found.shear_nominal / 1e6
    modulus = math.pi / 16 * (88**4 - 26**4) / 88
    assert tau == pytest.approx(found.torque * 1e3 / modulus, rel=1e-12)
    pin, journal, bore = found.places
    expected = math.sqrt((f["α_B"] * nominal + 10) ** 2 + 3 * (f["α_T"] * tau) ** 2)
    assert pin.equivalent / 1e6 == pytest.approx(expected, rel=1e-12)
    strength = 1.05 * (0.42 * 800 + 39.3) * (0.264 + 1.073 * 88**-0.2 - 15 / 4900 + 196 / 800 / math.sqrt(5))
    assert pin.strength / 1e6 == pytest.approx(strength, rel=1e-12)
    bent = f["β_B"] * nominal + f["β_Q"] * shear_stress + 10
    twisted = f["β_T"] * found.torque * 1e3 / (math.pi / 16 * 110**3)
    assert journal.equivalent / 1e6 == pytest.approx(math.hypot(bent, math.sqrt(3) * twisted), rel=1e-12)
    assert found.bore_nominal is not None
    bent, twisted = f["γ_B"] * found.bore_nominal / 1e6, f["γ_T"] * tau
    expected = bent / 3 * (1 + 2 * math.sqrt(1 + 9 / 4 * (twisted / bent) ** 2))
    assert bore.equivalent / 1e6 == pytest.approx(expected, rel=1e-12)
    assert found.acceptability == min(place.acceptability for place in found.places)
    study = lw.torsion_study(machine)
    assert study.results()["fatigue"][0]["acceptability"] == found.acceptability
    # The misfire of one cylinder counts.
    assert found.cylinder
    assert study.forced is not None
    row = study.forced.shafts.index(found.shaft)
    assert found.torque > study.forced.shaft_torque_vibratory[row].max()


def test_too_weak_a_crankshaft_is_a_finding(machine: lw.Machine) -> None:
    weak = lw.replace(machine, {"train.engine.fatigue.additional_bending": 1.5e8})
    study = lw.torsion_study(weak)
    assert not study.fatigue[0].is_acceptable
    assert any("acceptability factor" in finding for finding in study.findings)
    assert "not sufficient" in study.operation
    thick = lw.torsion_study(lw.replace(machine, {"train.engine.fatigue.pin_fillet": 1e-3}))
    assert thick.fatigue[0].outside == ("r",)
    assert any("r outside the range of IACS UR M53" in note for note in thick.warnings)


def test_fatigue_needs_a_throw() -> None:
    ship = Path(__file__).parents[2] / "examples" / "twin_engine_ship" / "machine.toml"
    fatigue = "{ tensile_strength = 7e8, pin_fillet = 0.015, journal_fillet = 0.015 }"
    with pytest.raises(MachineFileError, match="geometry of a throw"):
        lw.read(ship, [f"train.engine.fatigue={fatigue}"])
