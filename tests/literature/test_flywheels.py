"""Flywheels of textbooks.

R. S. Khurmi, J. K. Gupta, Theory of Machines, 2005, chapter 16; and, numbers from memory, S. S. Rattan,
Theory of Machines, chapter 13; R. L. Norton, Design of Machinery, 11.11; J. E. Shigley, C. R. Mischke,
Mechanical Engineering Design, example 16-6.
"""

from __future__ import annotations

import math

import numpy as np
import pytest

import linkwright as lw
from linkwright import InputError
from linkwright.turning.diagram import TurningMomentDiagram
from linkwright.turning.tables import turning_tables

RPM = math.pi / 30


def diagram(**entries: object) -> TurningMomentDiagram:
    return lw.turning_moment(
        lw.Machine.model_validate({"format": 1, "name": "flywheel", "turning_moment": entries})
    )


def test_example_16_1() -> None:
    """6.5 t at a radius of gyration of 1.8 m, 56 kN m, 120 rpm: 121 and 119 rpm are printed."""
    found = diagram(speed="120 rpm", areas=[56, -56], area_scale="1 kJ", inertia=6500 * 1.8**2)
    assert found.speed_max is not None
    assert found.speed_min is not None
    assert round(found.speed_max / RPM) == 121
    assert round(found.speed_min / RPM) == 119


def test_example_16_4() -> None:
    """36 kg at 150 mm, 1800 rpm, areas in mm² at 5 N m and 5° a millimetre: 1.49 % is printed."""
    areas = [295, -685, 40, -340, 960, -270]
    scale = 5 * math.radians(5)
    found = diagram(speed="1800 rpm", areas=areas, area_scale=scale, inertia=36 * 0.15**2)
    # Printed: 985 mm², 430 N m.
    assert found.energy_fluctuation / scale == pytest.approx(985, rel=1e-12)
    assert found.energy_fluctuation == pytest.approx(430, abs=0.5)
    assert found.unevenness == pytest.approx(0.0149, abs=5e-5)


def test_example_16_2() -> None:
    """A multicylinder engine by its areas, 600 N m and 3° a mm, ± 1.5 %: 5404 N m and 183 kg are printed."""
    found = diagram(
        speed="600 rpm",
        areas=[52, -124, 92, -140, 85, -72, 107],
        area_scale=600 * math.radians(3),
        unevenness=0.03,
        radius_of_gyration="500 mm",
    )
    assert found.energy_fluctuation / (600 * math.radians(3)) == pytest.approx(172, rel=1e-12)
    # 31.42 N m a square millimetre in the book, π/60·600 here.
    assert found.energy_fluctuation == pytest.approx(5404, abs=1.0)
    assert found.flywheel_mass is not None
    # The book rounds the speed to 31.42 m/s and the energy to 29.6 m before it divides.
    assert found.flywheel_mass == pytest.approx(183, abs=0.7)


THREE = {"kind": "table", "angle": "0, 60, 180 deg", "torque": "0, 90, 0 N m"}


def test_example_16_7() -> None:
    """Three cylinders, triangles of 90 N m at 60°, 600 rpm, 12 kg at 80 mm.

    4.24 kW, 4 %, 2.78 % and 293 rad/s² are printed.
    """
    one = {**THREE, "angle": "0, 60, 180, 360 deg", "torque": "0, 90, 0, 0 N m"}
    found = diagram(speed="600 rpm", inertia=12 * 0.08**2, driver={**one, "phases": "0, 120, 240 deg"})
    assert found.power_mean == pytest.approx(4.24e3, abs=5)
    # 11.78 N m is printed; the areas of the triangles are exact.
    assert found.energy_fluctuation == pytest.approx(math.pi * 3.75, rel=1e-12)
    assert found.unevenness == pytest.approx(0.04, abs=0.002)
    assert found.energy_coefficient == pytest.approx(0.0278, abs=5e-5)
    assert found.acceleration_max == pytest.approx(293, abs=0.5)
    # The same diagram, added up by hand.
    by_hand = diagram(
        speed="600 rpm",
        inertia=12 * 0.08**2,
        driver={
            "kind": "table",
            "angle": "0, 60, 120, 180, 240, 300, 360 deg",
            "torque": "45, 90, 45, 90, 45, 90, 45 N m",
        },
    )
    assert found.energy_fluctuation == pytest.approx(by_hand.energy_fluctuation, rel=1e-12)


def test_even_cylinders_leave_the_orders_of_their_number() -> None:
    """Σ cos(k(φ − 2πi/n)) is n cos kφ where n divides k, else 0."""
    wave = "+".join(f"{a}*cos({k}*phi)" for k, a in ((1, 70), (2, 50), (3, 30), (4, 20), (5, 10)))
    common: dict[str, object] = {"speed": "300 rpm", "inertia": 2.0}
    four = diagram(
        **common, driver={"kind": "formula", "torque": f"100+{wave}", "phases": "0, 90, 180, 270 deg"}
    )
    left = diagram(**common, driver={"kind": "formula", "torque": "400+80*cos(4*phi)"})
    assert four.energy_fluctuation == pytest.approx(left.energy_fluctuation, rel=1e-12)
    assert four.energy_fluctuation == pytest.approx(40, rel=1e-12)


def test_a_cylinder_beyond_the_cycle_is_refused() -> None:
    with pytest.raises(InputError, match="720 deg"):
        diagram(speed="300 rpm", inertia=2.0, driver={**THREE, "phases": "0, 240, 480 deg"})


def test_two_stroke_engine() -> None:
    """1000 + 300 sin 2θ − 500 cos 2θ N m, 250 rpm, 400 kg, 0.4 m: printed 26.18 kW, 1.33 %, 9.11 rad/s²."""
    found = diagram(
        speed="250 rpm",
        inertia=400 * 0.4**2,
        driver={"kind": "formula", "torque": "1000 + 300*sin(2*phi) - 500*cos(2*phi)"},
    )
    assert found.power_mean == pytest.approx(26.18e3, abs=5)
    # Printed 583.1 N m.
    assert found.energy_fluctuation == pytest.approx(583.1, abs=0.05)
    assert found.unevenness == pytest.approx(0.0133, abs=5e-5)
    assert found.acceleration_max == pytest.approx(9.11, abs=5e-3)
    assert found.acceleration_min == pytest.approx(-9.11, abs=5e-3)
    # At 60° the excess accelerates the flywheel with 7.965 rad/s².
    k = np.abs(np.degrees(found.crank_angle) - 60).argmin()
    excess = found.torque_driver[k] - found.torque_load[k]
    assert excess / found.inertia == pytest.approx(7.965, abs=5e-3)


def test_machine_with_a_torque_of_its_own() -> None:
    """5000 + 600 sin 2θ N m against 5000 + 500 sin θ, 500 kg at 0.4 m, 150 rpm: 1204 N m, 6.1 %, 3.46 rad/s².

    Accelerations are at roots of 2400 cos²θ − 500 cos θ − 1200 = 0: 35° and, for the largest retardation,
    127.6° are printed.
    """
    found = diagram(
        speed="150 rpm",
        inertia=500 * 0.4**2,
        driver={"kind": "formula", "torque": "5000 + 600*sin(2*phi)"},
        load={"kind": "formula", "torque": "5000 + 500*sin(phi)"},
    )
    assert found.energy_fluctuation == pytest.approx(1204, abs=0.5)
    assert found.unevenness == pytest.approx(0.061, abs=5e-4)
    # The excess is odd about 180°, where the book ends: the maximum of the whole revolution is the maximum
    # retardation turned round.
    assert found.acceleration_min_angle is not None
    assert found.acceleration_max_angle is not None
    assert math.degrees(found.acceleration_min_angle) == pytest.approx(127.6, abs=0.05)
    assert math.degrees(found.acceleration_max_angle) == pytest.approx(360 - 127.6, abs=0.05)
    k = np.abs(np.degrees(found.crank_angle) - 35).argmin()
    excess = found.torque_driver[k] - found.torque_load[k]
    assert excess / found.inertia == pytest.approx(3.46, abs=5e-3)
    # Nothing is left after the last area, and the table says so.
    areas = next(table for table in turning_tables(found) if table.name == "areas")
    assert areas.rows[-1][-1] == "0 J"


def test_four_stroke_gas_engine() -> None:
    """20 kW at 300 rpm, triangles of expansion and compression, 3 to 1, ± 2 %: 255.2 kg m² is printed.

    The work of a cycle is 8000 J, of which expansion gives 12 000 J: a triangle of height 24 000/π N m.
    """
    expansion, compression = 24000 / math.pi, -8000 / math.pi
    found = diagram(
        speed="300 rpm",
        cycle="720 deg",
        unevenness="4 %",
        driver={
            "kind": "table",
            "angle": "0, 180, 270, 360, 450, 540, 720 deg",
            "torque": [0, 0, compression, 0, expansion, 0, 0],
        },
    )
    assert found.energy_cycle == pytest.approx(8000, rel=1e-12)
    assert found.power_mean == pytest.approx(20e3, rel=1e-12)
    # Closed form: the triangle above the mean, (11/12)² of its area.
    assert found.energy_fluctuation == pytest.approx(12000 * (11 / 12) ** 2, rel=1e-12)
    # Printed 10 081 N m and 255.2 kg m²; the book rounds the torques to 7638, 637 N m before.
    assert found.energy_fluctuation == pytest.approx(10081, abs=3)
    assert found.flywheel_inertia == pytest.approx(255.2, abs=0.3)


def test_example_16_8() -> None:
    """20000 + 9500 sin 2θ − 5700 cos 2θ N m at 180 rpm: 377 kW, 3121 kg m², 3.044 rad/s² are printed."""
    found = diagram(
        speed="180 rpm",
        unevenness="1 %",
        driver={"kind": "formula", "torque": "20000 + 9500*sin(2*phi) - 5700*cos(2*phi)"},
    )
    assert found.power_mean == pytest.approx(377e3, abs=500)
    # Printed 11 078 N m.
    assert found.energy_fluctuation == pytest.approx(11078, abs=1.0)
    # The book takes ω as 18.85 rad/s.
    assert found.flywheel_inertia == pytest.approx(3121, abs=3.0)
    # At 45° the excess is 9500 N m.
    assert 9500 / found.flywheel_inertia == pytest.approx(3.044, abs=0.003)


# Torque of a four-stroke engine of one cylinder each 15° [lbf in].
SHIGLEY = (
    *(0, 2800, 2090, 2430, 2160, 1840, 1590, 1210, 1066, 803, 532, 184, 0, -107, -206, -280, -323, -310),
    *(-242, -126, -8, 89, 125, 85, 0, -85, -125, -89, 8, 126, 242, 310, 323, 280, 206, 107, 0, -107, -206),
    *(-292, -355, -371, -362, -312, -272, -274, -548, -760, 0),
)


def test_shigley_16_6() -> None:
    """At 250 rpm, C_s = 0.1: 268 lbf in, 3531 lbf in, 51.5 lbf s² in, 27.5 and 24.9 rad/s are printed."""
    pound_inch = 4.4482216152605 * 0.0254
    found = diagram(
        speed="250 rpm",
        cycle="720 deg",
        unevenness=0.1,
        driver={
            "kind": "table",
            "angle": [math.radians(15 * k) for k in range(49)],
            "torque": [f"{torque} in lb" for torque in SHIGLEY],
        },
    )
    # Sum of the ordinates, trapezoids: 3363 lbf in over 4π.
    assert found.torque_mean == pytest.approx(sum(SHIGLEY) / 48 * pound_inch, rel=1e-12)
    assert found.torque_mean / pound_inch == pytest.approx(268, abs=0.5)
    # The book integrates from one ordinate to another, here from crossing to crossing: 1.5 % more.
    assert found.energy_fluctuation / pound_inch == pytest.approx(3531, rel=0.02)
    assert found.flywheel_inertia / pound_inch == pytest.approx(51.5, rel=0.02)
    assert found.speed_max == pytest.approx(27.5, abs=0.05)
    assert found.speed_min == pytest.approx(24.9, abs=0.05)


def test_norton_four_bar() -> None:
    """Areas that are read to five digits and add up to 1.54 lbf in: 261.05 lbf in, 2.088 lbf s² in."""
    found = diagram(
        speed="50 rad/s", unevenness=0.05, areas=[200.73, -261.05, 153.88, -92.02], area_scale="1 in lb"
    )
    pound_inch = 4.4482216152605 * 0.0254
    assert found.energy_fluctuation / pound_inch == pytest.approx(261.05, abs=0.005)
    assert found.flywheel_inertia / pound_inch == pytest.approx(2.088, abs=0.0005)
    assert found.accuracy == pytest.approx(1.54 / 261.05, rel=1e-6)
    assert "0.174 J are left, 0.59 %" in found.warnings[0]


def test_rattan_torque_over_three_revolutions() -> None:
    """800 N m rising to 3000 N m in half a revolution, constant, falling, constant: 109.08 kW at 500 rpm."""
    found = diagram(
        speed="500 rpm",
        cycle="3 rev",
        inertia=375.0,
        load={
            "kind": "table",
            "angle": "0, 0.5, 1.5, 2.5, 3 rev",
            "torque": "800, 3000, 3000, 800, 800 N m",
        },
    )
    assert found.torque_mean == pytest.approx(6250 / 3, rel=1e-12)
    assert found.power_mean == pytest.approx(109.08e3, abs=10)
    # The trapezium above the mean: 916.7 N m high, one revolution wide above, wider below by its slopes.
    high = 3000 - 6250 / 3
    width = 2 * math.pi * (1 + 0.5 * high / 2200 / 2 + high / 2200 / 2)
    assert found.energy_fluctuation == pytest.approx(high * width, rel=1e-12)


def test_rattan_punching_machine() -> None:
    """Six holes of 40 mm a minute in 35 mm, 8 N m/mm², stroke 95 mm, 20 m/s, 3 %: 3.519 kW and 2392 kg."""
    work, share = 8.0 * math.pi * 40 * 35, 35 / 190
    speed = 2 * math.pi * 6 / 60
    found = diagram(
        speed="6 rpm",
        unevenness="3 %",
        radius_of_gyration=20 / speed,
        load={
            "kind": "table",
            "between": "steps",
            "angle": [0.0, 2 * math.pi * share],
            "torque": [work / (2 * math.pi * share), 0.0],
        },
    )
    assert found.power_mean == pytest.approx(3519, abs=0.5)
    assert found.energy_fluctuation == pytest.approx(work * (1 - share), rel=1e-12)
    assert found.flywheel_mass == pytest.approx(2392, abs=0.5)


def test_press_with_a_cycle_in_time() -> None:
    """720 holes an hour, 15 kN m in 2 s each, flywheel of 0.5 m from 225 to 200 rpm: 3 kW and 618 kg are
    printed (Khurmi and Gupta, chapter 16, from memory).
    """
    speed = 212.5 * 2 * math.pi / 60
    found = diagram(
        speed=speed,
        cycle=5 * speed,
        unevenness=25 / 212.5,
        radius_of_gyration=0.5,
        load={
            "kind": "table",
            "between": "steps",
            "angle": [0.0, 2 * speed],
            "torque": [15000 / (2 * speed), 0.0],
        },
    )
    assert found.power_mean == pytest.approx(3000, rel=1e-12)
    assert found.energy_fluctuation == pytest.approx(9000, rel=1e-12)
    assert found.flywheel_mass == pytest.approx(618, abs=0.5)


def test_khurmi_torque_over_three_revolutions() -> None:
    """750 N m rising to 3000 N m in half a revolution, constant for one, falling, constant for one, at 250
    rpm with 500 kg at 0.6 m: 49.125 kW (with ω as 26.2 rad/s) and 7.1 % are printed (from memory).
    """
    found = diagram(
        speed="250 rpm",
        cycle="3 rev",
        inertia=500 * 0.6**2,
        load={
            "kind": "table",
            "angle": "0, 0.5, 1.5, 2, 3 rev",
            "torque": "750, 3000, 3000, 750, 750 N m",
        },
    )
    assert found.power_mean * 26.2 / found.speed_mean == pytest.approx(49125, rel=1e-9)
    assert found.unevenness == pytest.approx(0.071, abs=0.001)


def test_khurmi_three_crank_engine() -> None:
    """5000 + 1500 sin 3θ N m, 1000 kg m², 300 rpm: 157.1 kW, 0.1 % and, against 5000 + 600 sin θ, 1656.5 N m
    and 0.168 % are printed (from memory).
    """
    common: dict[str, object] = {
        "speed": "300 rpm",
        "inertia": 1000.0,
        "driver": {"kind": "formula", "torque": "5000 + 1500*sin(3*phi)"},
    }
    steady = diagram(**common)
    assert steady.power_mean == pytest.approx(157.1e3, abs=50)
    assert steady.energy_fluctuation == pytest.approx(1000, rel=1e-12)
    assert steady.unevenness == pytest.approx(0.001, abs=5e-5)
    resisted = diagram(**common, load={"kind": "formula", "torque": "5000 + 600*sin(phi)"})
    assert resisted.energy_fluctuation == pytest.approx(1656.5, abs=0.2)
    assert resisted.unevenness == pytest.approx(0.00168, abs=5e-6)


def test_khurmi_double_acting_steam_engine() -> None:
    """Triangles of 2000 and 1500 N m at 80° of each stroke, 100 rpm, 1.75 m, ± 0.75 %: 875 N m are printed.

    Of each triangle the part above the mean is a similar one.
    """
    found = diagram(
        speed="100 rpm",
        unevenness="1.5 %",
        radius_of_gyration="1.75 m",
        driver={
            "kind": "table",
            "angle": "0, 80, 180, 260, 360 deg",
            "torque": "0, 2000, 0, 1500, 0 N m",
        },
    )
    assert found.torque_mean == pytest.approx(875, rel=1e-12)
    excess = 0.5 * math.pi * 2000 * (1125 / 2000) ** 2
    assert found.energy_fluctuation == pytest.approx(excess, rel=1e-12)
    assert found.energy_coefficient == pytest.approx(excess / (1750 * math.pi), rel=1e-12)
    assert found.flywheel_mass == pytest.approx(excess / (1.75**2 * (100 * RPM) ** 2 * 0.015), rel=1e-12)


def test_khurmi_riveting_machine() -> None:
    """3 kW, 10 kJ in one second each, 150 kg at 0.6 m, 300 rpm before: 257.6 rpm after, 18 rivets a minute
    are printed (from memory).
    """
    before, inertia = 300 * RPM, 150 * 0.6**2
    after = math.sqrt(before**2 - 2 * 7000 / inertia)
    speed = 0.5 * (before + after)
    cycle = 10 / 3
    found = diagram(
        speed=speed,
        cycle=cycle * speed,
        inertia=inertia,
        load={
            "kind": "table",
            "between": "steps",
            "angle": [0.0, speed],
            "torque": [10000 / speed, 0.0],
        },
    )
    assert found.power_mean == pytest.approx(3000, rel=1e-12)
    assert 60 / cycle == pytest.approx(18)
    assert found.energy_fluctuation == pytest.approx(7000, rel=1e-12)
    assert found.speed_max == pytest.approx(before, rel=1e-12)
    assert found.speed_min is not None
    assert found.speed_min / RPM == pytest.approx(257.6, abs=0.05)
