"""Third transfer functions, poses, laws of the driver, and motion over time."""

from __future__ import annotations

import json
from itertools import pairwise

import numpy as np
import pytest

import linkwright as lw
from linkwright import AssemblyError, InputError, ShapeError
from linkwright.kernel.numerics.taylor import Taylor
from linkwright.linkages.law import (
    FormulaLaw,
    FunctionLaw,
    PolynomialLaw,
    RampLaw,
    TableLaw,
    as_law,
    constant_speed,
)

# One of each dyad, gear, planet, rack, cable and a bar, all in one machine.
ALL = """
format = 1
name = "one of each"
[mechanism.points]
D = { x = 0.4, y = 0 }
P = { x = 0, y = -0.3 }
[mechanism.cranks.A]
radius = 0.1
[mechanism.rockers.R]
crank = "A"
pivot = "D"
coupler = 0.35
rocker = 0.3
[mechanism.rigid_points.K]
link = "R.coupler"
along = 0.2
across = 0.1
[mechanism.sliders.S]
crank = "K"
rod = 0.6
through = "O"
[mechanism.sliders.T]
crank = "A"
rod = 0.5
on = "R.rocker"
[mechanism.slotted_levers.L]
pin = "A"
pivot = "P"
offset = 0.02
[mechanism.yokes.Y]
pin = "A"
[mechanism.gears.G]
pivot = "D"
meshes = "A"
size = 2
size_other = 1
[mechanism.racks.Z]
gear = "R.rocker"
radius = 0.05
[mechanism.cables.H]
link = "R.rocker"
radius = 0.1
length = 1.0
"""


def four_bar(
    crank: float = 0.1, coupler: float = 0.35, rocker: float = 0.3, ground: float = 0.4
) -> lw.Machine:
    return lw.loads(f"""
        format = 1
        name = "four-bar"
        [mechanism.points]
        D = {{ x = {ground}, y = 0 }}
        [mechanism.cranks.A]
        radius = {crank}
        [mechanism.rockers.R]
        crank = "A"
        pivot = "D"
        coupler = {coupler}
        rocker = {rocker}
        """)


# -- third transfer functions --------------------------------------------------------------------------------


def test_third_derivatives_against_differences() -> None:
    """Second derivatives differenced over 2h err by h²/6 of the fifth, and by rounding over h."""
    machine, phi, h = lw.loads(ALL), np.linspace(0.1, 6.2, 23), 1e-4
    exact = lw.kinematics(machine, phi, third=True)
    before, after = (lw.kinematics(machine, phi + step) for step in (-h, h))
    compared = 0
    for part in ("points", "links", "slides"):
        for name, each in getattr(exact, part).items():
            low, high = getattr(before, part)[name].d2, getattr(after, part)[name].d2
            size = 1 + np.abs(each.d3).max()
            np.testing.assert_allclose(each.d3, (high - low) / (2 * h), atol=2e-6 * size, err_msg=name)
            compared += 1
    assert compared == 26


def test_third_derivatives_in_closed_form() -> None:
    """A crank's pin, and a Scotch yoke: x = r cos φ, so x‴ = r sin φ."""
    phi = np.linspace(0, 6, 50)
    motion = lw.kinematics(lw.loads(ALL), phi, third=True)
    np.testing.assert_allclose(
        motion.points["A"].d3, 0.1 * np.stack([np.sin(phi), -np.cos(phi)], -1), atol=1e-15
    )
    np.testing.assert_allclose(motion.slides["Y"].d3, 0.1 * np.sin(phi), atol=1e-15)
    np.testing.assert_allclose(motion.links["G"].d3, 0, atol=1e-15)
    # In-line slider-crank: s = r cos φ + w, w² = l² − r² sin² φ, and w‴ from (w²)‴ = 2 w w‴ + 6 w′ w″.
    slider = lw.loads(
        'format=1\nname="s"\n[mechanism.cranks.A]\nradius=0.1\n[mechanism.sliders.S]\ncrank="A"\nrod=0.3\n'
    )
    found = lw.kinematics(slider, phi, third=True).slides["S"]
    s, c = np.sin(phi), np.cos(phi)
    w = np.sqrt(0.09 - 0.01 * s**2)
    w1 = -0.01 * s * c / w
    w2 = (-0.01 * (c**2 - s**2) - w1**2) / w
    w3 = (0.08 * s * c - 6 * w1 * w2) / (2 * w)
    np.testing.assert_allclose(found.d3, 0.1 * s + w3, atol=1e-14)


def test_third_derivatives_through_a_change_point() -> None:
    phi = np.linspace(0, 2 * np.pi, 33)
    found = lw.kinematics(four_bar(0.1, 0.4, 0.1, 0.4), phi, third=True)
    # A parallelogram: the rocker turns as the crank. The series of twelve terms loses some digits three
    # times.
    np.testing.assert_allclose(found.links["R.rocker"].d3, 0, atol=1e-6)


def test_third_derivatives_only_where_asked_for() -> None:
    assert lw.kinematics(four_bar(), [0.0]).points["R"].d3 is None
    many = lw.replace(four_bar(), {"mechanism.rockers.R.coupler": np.array([0.35, 0.36])})
    with pytest.raises(ShapeError, match="one machine"):
        lw.kinematics(many, [0.0], third=True)


# -- poses ---------------------------------------------------------------------------------------------------


def test_pose_is_one_angle_of_the_kinematics() -> None:
    machine, omega, epsilon = lw.loads(ALL), 3.0, -2.0
    found = lw.pose(machine, 1.2, speed=omega, acceleration=epsilon)
    motion = lw.kinematics(machine, [1.2])
    for name, each in motion.points.items():
        pose = found.points[name]
        np.testing.assert_allclose(pose.position, each.position[0])
        np.testing.assert_allclose(pose.velocity, each.d1[0] * omega)
        np.testing.assert_allclose(pose.acceleration, each.d2[0] * omega**2 + each.d1[0] * epsilon)
    assert found.slides["S"].velocity == motion.slides["S"].d1[0] * omega
    assert found.links["R.rocker"].position == motion.links["R.rocker"].angle[0]
    assert set(found.transmission_angles) == {"R", "S", "T", "L", "Y"}
    json.dumps(found.to_dict(), allow_nan=False)


def test_pose_near_a_limit() -> None:
    limited = four_bar(0.3, 0.2, 0.25, 0.4)
    limit = np.arccos((0.3**2 + 0.4**2 - 0.45**2) / (2 * 0.3 * 0.4))
    assert lw.pose(limited, 0.9 * limit).near_limit == ()
    assert lw.pose(limited, limit - 1e-4).near_limit == ("R",)
    with pytest.raises(AssemblyError, match=r"at crank angle 90.00°.*78\.58°"):
        lw.pose(limited, np.pi / 2)
    with pytest.raises(InputError, match="finite"):
        lw.pose(limited, np.nan)


# -- laws ----------------------------------------------------------------------------------------------------

T = np.linspace(0.05, 1.95, 20)


@pytest.mark.parametrize(
    "law",
    [
        PolynomialLaw((1.0, 2.0, -0.5, 0.3, 0.1)),
        constant_speed(3.0, 0.5),
        RampLaw(2.0, angle=1.5, start=0.2),
        RampLaw(1.0, speed=4.0, shape="4-5-6-7"),
        FunctionLaw(
            lambda t: 2 * np.sin(3 * t**2) ** 2 + np.cos(t**3) * t / (1 + t**2) - np.exp(-t) * np.sqrt(1 + t)
        ),
        FunctionLaw(lambda t: np.where(t < 1, t**3, 3 * t - 2)),
        FormulaLaw("2*pi*t + 0.1*sin(5*t)^2 + tanh(t)*atan(t)"),
        FormulaLaw("where(t < 1, t^2, 2*t - 1) + max(0.33, t, 2*t) + atan2(t, 2)"),
    ],
)
def test_laws_are_their_own_derivatives(law) -> None:
    h = 1e-5
    # Away from the pieces' ends at 0 and 1.
    t = T[np.abs(T - 1) > 2 * h]
    rates, slopes = law.at(t), (law.at(t + h) - law.at(t - h)) / (2 * h)
    np.testing.assert_allclose(rates[1:], slopes[:3], rtol=1e-7, atol=1e-7)


def test_ramps_begin_and_end_at_rest() -> None:
    law = RampLaw(2.0, angle=1.5, start=0.2)
    np.testing.assert_allclose(law.at(np.array([-1.0, 0.0, 2.0, 9.0]))[0], [0.2, 0.2, 1.7, 1.7], atol=1e-14)
    np.testing.assert_allclose(law.at(np.array([0.0, 2.0]))[1:3], 0, atol=1e-13)
    run_up = RampLaw(2.0, speed=4.0)
    # Half the turning of the final speed while it rises.
    np.testing.assert_allclose(run_up.at(np.array([2.0, 3.0]))[0], [4.0, 8.0], atol=1e-13)
    np.testing.assert_allclose(run_up.at(np.array([2.0, 3.0]))[1], 4.0, atol=1e-13)


def test_table_law_against_scipy() -> None:
    interpolate = pytest.importorskip("scipy.interpolate")
    t, phi = np.array([0.0, 0.3, 1.0, 1.4, 2.0]), np.array([0.0, 1.0, 0.5, 2.0, 3.0])
    spline = interpolate.CubicSpline(t, phi, bc_type="natural")
    found = TableLaw(t, phi).at(T)
    for k in range(4):
        np.testing.assert_allclose(found[k], spline(T, k), atol=1e-11)


def test_functions_of_taylor_series() -> None:
    """Each function's third derivative against that of its closed form at one point."""
    x = Taylor.variable(np.array([0.4]))
    cases = {
        np.tan: lambda t: (4 * np.sin(t) ** 2 + 2) / np.cos(t) ** 4,
        np.log: lambda t: 2 / t**3,
        np.sqrt: lambda t: 0.375 * t**-2.5,
        np.exp: np.exp,
        np.sinh: np.cosh,
        np.cosh: np.sinh,
        np.arcsin: lambda t: (1 + 2 * t * t) / (1 - t * t) ** 2.5,
        np.arccos: lambda t: -(1 + 2 * t * t) / (1 - t * t) ** 2.5,
        np.arctan: lambda t: (6 * t * t - 2) / (1 + t * t) ** 3,
        np.square: lambda t: 0.0,
        np.absolute: lambda t: 0.0,
        np.tanh: lambda t: (4 * np.sinh(t) ** 2 - 2) / np.cosh(t) ** 4,
    }
    for function, third in cases.items():
        assert function(x).derivatives[3, 0] == pytest.approx(third(0.4), rel=1e-13, abs=1e-15), function
    assert (2**x).derivatives[3, 0] == pytest.approx(np.log(2) ** 3 * 2**0.4, rel=1e-13)
    assert (1 / x - x).derivatives[1, 0] == pytest.approx(-1 / 0.16 - 1)
    assert abs(-x).derivatives[:2, 0] == pytest.approx([0.4, 1.0])


@pytest.mark.parametrize(
    ("make", "words"),
    [
        (lambda: as_law(3), "a law, a function"),
        (lambda: RampLaw(0.0, angle=1.0), "duration above zero"),
        (lambda: RampLaw(1.0), "either an angle or a speed"),
        (lambda: TableLaw([0, 1], [0, 1]), "at least 3"),
        (lambda: TableLaw([0, 1, 1], [0, 1, 2]), "1 s followed by 1 s"),
        (lambda: FunctionLaw(np.floor).at(T), "without a known derivative"),
        (lambda: FormulaLaw("phi + t"), "phi"),
        (lambda: FormulaLaw("2*"), "character 3"),
    ],
)
def test_wrong_laws_are_told(make, words: str) -> None:
    with pytest.raises(InputError, match=words):
        make()


# -- motion --------------------------------------------------------------------------------------------------


def test_motion_is_the_derivative_of_itself() -> None:
    """Fourth-order differences of a path of 2000 points against its exact rates."""
    t = np.linspace(0, 2, 2001)
    found = lw.motion(lw.loads(ALL), lambda t: 3 * np.sin(t) ** 2 + t, t)
    h, compared = t[1] - t[0], 0
    for part in (found.points, found.links, found.slides):
        for name, path in part.items():
            chain = (path.position, path.velocity, path.acceleration, path.jerk)
            for value, rate in pairwise(chain):
                slope = (8 * (value[3:-1] - value[1:-3]) - (value[4:] - value[:-4])) / (12 * h)
                size = 1 + np.abs(rate).max()
                np.testing.assert_allclose(slope, rate[2:-2], atol=1e-7 * size, err_msg=name)
                compared += 1
    assert compared == 3 * 26
    assert found.curves()["K.x.jerk"] is not None
    assert found.to_dict(curves=True)["speed"][0] == 1.0


def test_motion_within_limits() -> None:
    limited = four_bar(0.3, 0.2, 0.25, 0.4)
    limit = float(np.arccos((0.3**2 + 0.4**2 - 0.45**2) / (2 * 0.3 * 0.4)))
    t = np.linspace(0, 3, 61)
    inside = lw.motion(limited, lambda t: 0.99 * limit * np.sin(t), t)
    assert np.isfinite(inside.points["R"].jerk).all()
    with pytest.raises(AssemblyError, match=r"t = 1\.3715") as told:
        lw.motion(limited, constant_speed(1.0), t)
    assert told.value.crank_angle == pytest.approx(limit, abs=1e-10)
    # A peak beyond the limit between two of the times is seen too.
    with pytest.raises(AssemblyError, match="passes the limit of R"):
        lw.motion(limited, lambda t: limit * 1.001 * np.sin(t), np.array([0.0, 1.2, 1.9, 2.5]))
    # One revolution on, and in the range from below.
    lw.motion(limited, lambda t: 2 * np.pi + 0.5 * np.sin(t), t)
    with pytest.raises(ShapeError, match="increase"):
        lw.motion(limited, constant_speed(1.0), [0.0, 0.0])
    with pytest.raises(ShapeError, match="no finite"):
        lw.motion(four_bar(), lambda t: np.log(t), t)


def test_period_of_gears() -> None:
    assert lw.period_turns(four_bar()) == 1
    assert lw.period_turns(lw.loads(ALL)) == 2


def test_pose_near_the_pivot_of_a_slotted_lever() -> None:
    """Rounding of the pin's place counts in accelerations as the cube of crank over distance."""
    parts = "mechanism.points.P = { x = 0.2, y = 0 }\nmechanism.cranks.A.radius = 0.2\n"
    lever = 'mechanism.slotted_levers.L = { pin = "A", pivot = "P", length = 0.5 }\n'
    machine = lw.loads(f'format = 1\nname = "lever"\n{parts}{lever}')
    # The lever bisects the angle to the crank: ψ = φ/2 + 90°.
    for angle, near in ((1.0, ()), (0.02, ("L",)), (1e-3, ("L",))):
        pose = lw.pose(machine, angle)
        assert pose.near_limit == near
        assert pose.links["L"].velocity == pytest.approx(0.5, abs=1e-7)
        assert pose.links["L"].acceleration == pytest.approx(0.0, abs=1e-6)
    for angle in (0.0, 1e-5, -1e-4, 2 * np.pi):
        with pytest.raises(AssemblyError, match="its pin passes through its pivot"):
            lw.pose(machine, angle)
