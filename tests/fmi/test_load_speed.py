"""A load with a speed of its own behind a coupling: closed forms, and the same torque by a formula."""

from __future__ import annotations

import itertools
from pathlib import Path

import numpy as np
import pytest
from conftest import Unpacked
from fmus import opened, simulated
from sizes import DEEP

import linkwright as lw

VERSIONS = ("2.0", "3.0")
# Torque of the coupling per difference of speeds [N m s/rad], and speed of the load [rad/s].
COUPLING, LOAD = 40.0, 12.0
FORMULA = [
    'loads.coupling.kind="formula"',
    'loads.coupling.on="A1"',
    f'loads.coupling.torque="{COUPLING}*({LOAD} - omega)"',
]
COUPLED = {"load_coupling": COUPLING, "load_speed": LOAD}

ROTOR = """format = 1
name = "Rotor"
[drive]
motor = { kind = "dc", speed_no_load = "1000 rpm", torque_stall = "50 N m" }
flywheel = { inertia = 3.0 }
[mechanism]
cranks.A = { radius = "100 mm" }
"""


def test_two_rotors_agree_on_a_speed(unpacked: Unpacked, tmp_path: Path) -> None:
    """A rotor and a load that the tool integrates approach a common speed at the rate c/J₁ + c/J₂."""
    path = tmp_path / "rotor.toml"
    path.write_text(ROTOR, encoding="utf-8")
    own, of_load, coupling, start, stop = 3.0, 2.0, 1.5, 10.0, 1.0
    differences = []
    for count in (100, 200):
        times, load = np.linspace(0.0, stop, count + 1), 0.0
        with opened(unpacked(lw.read(path))) as unit:
            unit.start({"motor_on": False, "crank_speed": start, "load_coupling": coupling})
            for begin, end in itertools.pairwise(times):
                before = load
                # Half a step ahead, so that the load is held at the middle of the step.
                middle = before - unit.get("torque_coupling")[0] / of_load * (end - begin) / 2
                unit.set({"load_speed": middle})
                angle = unit.get("crank_angle")[0]
                unit.step(float(begin), float(end - begin))
                turned = unit.get("crank_angle")[0] - angle
                load = before + coupling * (turned - middle * (end - begin)) / of_load
                unit.set({"load_speed": load})
            (found,) = unit.get("crank_speed")
        common = own * start / (own + of_load)
        assert own * found + of_load * load == pytest.approx(own * start, rel=1e-10)
        decay = np.exp(-coupling * (1 / own + 1 / of_load) * stop)
        differences.append(found - (common + (start - common) * decay))
    # Held over a step, the speed of the load costs an error of second order.
    assert abs(differences[1]) < 1e-4
    assert differences[0] / differences[1] == pytest.approx(4.0, rel=0.05)


@pytest.mark.parametrize("version", VERSIONS)
def test_it_is_the_torque_of_a_formula(version: str, unpacked: Unpacked) -> None:
    """Run up with a load at 12 rad/s, a machine moves as one whose file has the torque c (ω_L − ω)."""
    machine = lw.read("roller_two_carts")
    times = np.linspace(0.0, 1.2, 7)
    expected = lw.transient(lw.read("roller_two_carts", FORMULA), duration=1.2, accuracy=1e-12).at(times)
    with opened(unpacked(machine, version)) as unit:
        unit.start(COUPLED, tolerance=1e-11)
        found = np.array(unit.run(list(times), "crank_angle", "crank_speed")).T
    assert np.abs(found[0] - expected[0]).max() < 1e-8 * 2 * np.pi
    assert np.abs(found[1] - expected[1]).max() < 1e-8 * expected[1].max()


def test_an_elastic_drive_and_another_solver(unpacked: Unpacked) -> None:
    """CVode follows an elastic drive with a load at its own speed as co-simulation does."""
    folder = unpacked("elastic_coupling_of_carts")
    names, values = ["crank_angle", "torque_coupling"], {"load_coupling": COUPLING, "load_speed": LOAD}
    with opened(folder) as unit:
        unit.start(values, tolerance=1e-12)
        own = np.array(unit.run(list(np.linspace(0.0, 0.5, 6)), *names))
    found = simulated(folder, "ModelExchange", 0.5, 0.1, names, relative_tolerance=1e-9, start_values=values)
    at = np.searchsorted(found["time"], np.linspace(0.0, 0.5, 6) - 1e-9)
    assert np.abs(found["crank_angle"][at] - own[:, 0]).max() < 1e-5
    assert np.abs(found["torque_coupling"][at] - own[:, 1]).max() < 1e-4 * COUPLING * LOAD


def test_a_stiff_coupling_takes_the_crank_along(unpacked: Unpacked) -> None:
    """With a coupling of 1e7 N m s/rad the crank turns at the speed of the load; T_c is what that takes."""
    with opened(unpacked("roller_two_carts")) as unit:
        unit.start({"load_coupling": 1e7, "load_speed": LOAD})
        unit.step(0.0, 0.7)
        angle, speed, torque = unit.get("crank_angle", "crank_speed", "torque_coupling")
    # It slips by torque over coupling.
    assert speed == pytest.approx(LOAD - torque / 1e7, rel=1e-12)
    assert angle == pytest.approx(0.7 * LOAD, abs=1e-3)


@pytest.mark.parametrize("name", ["roller_two_carts", "elastic_coupling_of_carts"])
def test_derivatives_by_the_coupling(name: str, unpacked: Unpacked) -> None:
    """By ω_L the acceleration changes with c/J, by c with (ω_L − ω)/J, by ω with −c/J; T_c times J."""
    unknowns = ["crank_acceleration", "torque_coupling"]
    with opened(unpacked(name), exchange=True) as unit:
        unit.start({"crank_angle": 0.9, "crank_speed": 8.5, **COUPLED})
        inverse = unit.along(["crank_acceleration"], "external_torque")[0]
        assert unit.along(unknowns, "load_speed") == pytest.approx([COUPLING * inverse, COUPLING], rel=1e-14)
        slip = LOAD - 8.5
        assert unit.along(unknowns, "load_coupling") == pytest.approx([slip * inverse, slip], rel=1e-14)
        by_speed = unit.along(unknowns, "crank_speed")
        assert by_speed[1] == -COUPLING
        unit.set({"load_coupling": 0.0})
        free = unit.along(["crank_acceleration"], "crank_speed")[0]
        assert by_speed[0] == pytest.approx(free - COUPLING * inverse, rel=1e-12)


@pytest.mark.deep
@pytest.mark.parametrize(
    "name", ["roller_one_cart", "elastic_coupling_of_carts", *["press_line_two_motors"] * DEEP]
)
def test_outputs_depend_on_what_they_name_alone(name: str, unpacked: Unpacked) -> None:
    """By a state or an input that the description does not name, an output has the derivative zero."""
    machine = lw.read(name)
    variables = lw.fmu(machine).variables
    outputs = [v for v in variables if v.depends is not None and not v.is_bool]
    assert len(outputs) > 4
    with opened(unpacked(machine), exchange=True) as unit:
        states = [v.name for v in variables if v.is_state]
        unit.start({"crank_angle": 0.9, "crank_speed": 8.5, **COUPLED})
        for known in [*states, "external_torque", "brake_torque", "load_speed"]:
            rates = unit.along([output.name for output in outputs], known)
            named = [output.name for output, rate in zip(outputs, rates, strict=True) if rate != 0.0]
            stated = [output.name for output in outputs if known in (output.depends or ())]
            assert set(named) <= set(stated), known


def test_a_negative_coupling_is_refused(unpacked: Unpacked) -> None:
    """A coupling below zero would drive itself: an error and a message, and the motion goes on."""
    log: list[str] = []
    with opened(unpacked("roller_two_carts"), logged=log) as unit:
        unit.start()
        with pytest.raises(Exception, match=r"(?i)set"):
            unit.set({"load_coupling": -1.0})
        assert "-1.0, expected a number from 0.0 to" in log[-1]
        unit.step(0.0, 0.1)
