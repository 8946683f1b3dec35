"""A number that is no such quantity is refused by every function, with the name of the argument.

Not a number, infinite, beyond the range of its kind (`linkwright.kernel.units`), or of the wrong sign.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import linkwright as lw
from linkwright import InputError

ROOT = Path(__file__).parents[2]
# From -inf to inf, beyond the ranges of all kinds.
NEVER = (math.nan, math.inf, -math.inf, 1e300, -1e300)


@cache
def machine(path: str) -> lw.Machine:
    return lw.read(ROOT / path)


CART = machine("machines/roller_one_cart.toml")
CAM = machine("machines/roller_cam.toml")
V8 = machine("machines/v8_diesel.toml")
FIELD = machine("examples/topper_field/machine.toml")
COUPLER = machine("examples/hoeken_straight_line/machine.toml")
TAPPET = machine("examples/cam_polydyne/machine.toml").mechanism.cams["tappet"].lift
RISE = TAPPET.stretch(0.0, np.radians(80))
PRESS = lw.loads((ROOT / "python/linkwright/kernel/files/templates/press.toml").read_text())
FOLLOWER = lw.OneMass(0.5, 4e5, damping_ratio_frame=0.03, spring_rate=2e4, preload=250.0)
LOAD = lw.FollowerLoad(0.5, spring_rate=1e4, preload=100.0)
TURN = np.linspace(0, 2 * np.pi, 73)
COURSE = lw.cam_course(TURN, (0.01 * np.sin(TURN), 0.01 * np.cos(TURN), -0.01 * np.sin(TURN)), 30.0)

# Function, argument, further values that it cannot have, and the call.
Row = tuple[str, str, tuple[float, ...], Callable[[float], Any]]
ROWS: tuple[Row, ...] = (
    ("coupler_curve", "straight", (0, -1), lambda x: lw.coupler_curve(COUPLER, point(COUPLER), straight=x)),
    ("pose", "crank_angle", (), lambda x: lw.pose(CART, x)),
    ("pose", "speed", (), lambda x: lw.pose(CART, 1.0, speed=x)),
    ("pose", "acceleration", (), lambda x: lw.pose(CART, 1.0, acceleration=x)),
    ("steady_state", "accuracy", (0, -1, 1e-16, 0.1), lambda x: lw.steady_state(CART, accuracy=x)),
    ("transient", "angle", (), lambda x: lw.transient(CART, angle=x, duration=0.1)),
    ("transient", "speed", (), lambda x: lw.transient(CART, speed=x, duration=0.1)),
    ("transient", "duration", (0, -1), lambda x: lw.transient(CART, duration=x)),
    ("transient", "turns", (0, -1), lambda x: lw.transient(CART, turns=x)),
    ("transient", "accuracy", (0, -1, 1e-16, 0.1), lambda x: lw.transient(CART, duration=0.1, accuracy=x)),
    ("step_method", "step", (0, -1), lambda x: lw.step_method(CART, step=x)),
    ("study", "accuracy", (0, -1), lambda x: lw.study(CART, accuracy=x)),
    ("study", "step", (0, -1), lambda x: lw.study(CART, step=x)),
    ("steady_states", "accuracy", (0, -1), lambda x: lw.steady_states(CART, _cart_masses(), accuracy=x)),
    ("forces", "speed", (), lambda x: lw.forces(CART, speed=x)),
    ("forces", "acceleration", (), lambda x: lw.forces(CART, speed=1.0, acceleration=x)),
    ("forces", "pressure_angle", (-1, 1.6), lambda x: lw.forces(CART, speed=1.0, pressure_angle=x)),
    (
        "forces",
        "radius",
        (-1,),
        lambda x: lw.forces(CART, speed=1.0, friction={pin(): lw.Friction(radius=x)}),
    ),
    ("balance", "speed", (0,), lambda x: lw.balance(PRESS, [crank()], speed=x)),
    ("balance", "radius", (0, -1), lambda x: lw.balance(PRESS, [crank()], speed=1.0, radius=x)),
    ("partial_balance", "share", (-1,), lambda x: lw.partial_balance(PRESS, slider(), share=x, speed=1.0)),
    (
        "partial_balance",
        "radius",
        (0, -1),
        lambda x: lw.partial_balance(PRESS, slider(), radius=x, speed=1.0),
    ),
    ("partial_balance", "speed", (0,), lambda x: lw.partial_balance(PRESS, slider(), speed=x)),
    ("motion", "angle", (), lambda x: lw.motion(CART, ([0.0, 1.0, 2.0], [0.0, 1.0, x]), [0.0, 1.0])),
    ("motion", "law", (), lambda x: lw.motion(CART, lambda t: x * t, [0.0, 1e-9])),
    ("loaded_cam", "speed", (), lambda x: lw.loaded_cam(CAM, lw.cam_profile(CAM), x)),
    ("OneMass", "mass", (0, -1), lambda x: lw.OneMass(x, 1e5)),
    ("OneMass", "stiffness", (0, -1), lambda x: lw.OneMass(1.0, x)),
    ("OneMass", "damping_ratio", (-1,), lambda x: lw.OneMass(1.0, 1e5, damping_ratio=x)),
    ("OneMass", "damping_ratio_frame", (-1,), lambda x: lw.OneMass(1.0, 1e5, damping_ratio_frame=x)),
    ("OneMass", "spring_rate", (-1,), lambda x: lw.OneMass(1.0, 1e5, spring_rate=x)),
    ("OneMass", "preload", (), lambda x: lw.OneMass(1.0, 1e5, preload=x)),
    ("follower_vibration", "speed", (0, -1), lambda x: lw.follower_vibration(TAPPET, FOLLOWER, x)),
    ("residual_spectrum", "damping_ratio", (-1,), lambda x: lw.residual_spectrum(RISE, 2.0, damping_ratio=x)),
    (
        "residual_spectrum",
        "damping_ratio_frame",
        (-1,),
        lambda x: lw.residual_spectrum(RISE, 2.0, damping_ratio_frame=x),
    ),
    ("residual_spectrum", "share", (0, -1), lambda x: lw.residual_spectrum(RISE, 2.0, share=x)),
    ("polydyne", "speed", (0, -1), lambda x: lw.polydyne(TAPPET, FOLLOWER, x, "turn")),
    ("FollowerLoad", "mass", (-1,), lambda x: lw.FollowerLoad(x)),
    ("FollowerLoad", "spring_rate", (-1,), lambda x: lw.FollowerLoad(1.0, spring_rate=x)),
    ("FollowerLoad", "preload", (), lambda x: lw.FollowerLoad(1.0, preload=x)),
    ("FollowerLoad", "damping", (-1,), lambda x: lw.FollowerLoad(1.0, damping=x)),
    ("StemGuide", "length", (0, -1), lambda x: lw.StemGuide(x, 0.1)),
    ("StemGuide", "overhang", (), lambda x: lw.StemGuide(0.1, x)),
    ("StemGuide", "coefficient", (-1,), lambda x: lw.StemGuide(0.1, 0.1, coefficient=x)),
    ("StemGuide", "diameter", (-1,), lambda x: lw.StemGuide(0.1, 0.1, diameter=x)),
    ("ArmPivot", "coefficient", (-1,), lambda x: lw.ArmPivot(0.1, coefficient=x)),
    ("ArmPivot", "radius", (-1,), lambda x: lw.ArmPivot(0.1, radius=x)),
    ("contact_force", "friction", (-1,), lambda x: lw.contact_force(COURSE, LOAD, friction=x)),
    (
        "contact_force",
        "clearance",
        (-1,),
        lambda x: lw.contact_force(COURSE, LOAD, closure="form", clearance=x),
    ),
    ("least_preload", "speed", (0, -1), lambda x: lw.least_preload(TAPPET, LOAD, x)),
    ("least_preload", "contact", (-1,), lambda x: lw.least_preload(TAPPET, LOAD, 30.0, contact=x)),
    ("Material", "modulus", (0, -1), lambda x: lw.Material(x, 0.3)),
    ("Material", "poisson", (-1, 1), lambda x: lw.Material(2e11, x)),
    ("line_contact", "length", (0, -1), lambda x: lw.line_contact(100.0, 0.01, 0.02, x)),
    ("topper_field", "level", (0, 1, -1), lambda x: lw.topper_field(FIELD, level=x)),
    (
        "sweep_field",
        "level",
        (0, 1, -1),
        lambda x: lw.sweep_field(FIELD, {"edge_angle": [0.5, 0.6]}, level=x),
    ),
    ("length_verdict", "edge_angle", (), lambda x: lw.length_verdict(paper(), x, 0.1, 0.0)),
    ("length_verdict", "diameter", (0, -1), lambda x: lw.length_verdict(paper(), 0.5, x, 0.0)),
    ("length_verdict", "offset", (), lambda x: lw.length_verdict(paper(), 0.5, 0.1, x)),
    ("holzer_table", "frequency", (-1,), lambda x: lw.holzer_table(V8, x)),
    ("torsion_study", "holzer", (-1,), lambda x: lw.torsion_study(V8, holzer=[x])),
    ("waterfall", "highest", (0, -1), lambda x: lw.waterfall(*_record(), highest=x)),
    ("waterfall", "step", (0, -1), lambda x: lw.waterfall(*_record(), step=x)),
    ("shaft_stress", "service", (0, -1), lambda x: lw.shaft_stress(V8, service=x)),
    ("measured_speed", "noise", (0, -1), lambda x: lw.measured_speed("d", np.ones(64), 2, [1], noise=x)),
    ("engine_data", "speed", (0, -1), lambda x: lw.engine_data(engine(), x)),
    ("damped_vibration", "speed", (-1,), lambda x: lw.damped_vibration(V8, x)),
    ("campbell", "orders", (0, -1), lambda x: lw.campbell(V8, [x])),
    ("campbell", "speed_range", (-1,), lambda x: lw.campbell(V8, speed_range=(x, 200.0))),
    ("campbell", "damping_ratios", (-1,), lambda x: lw.campbell(V8, damping_ratios=x)),
    ("design_damper", "ring_inertia", (0, -1), lambda x: lw.design_damper(V8, disc(), x)),
    ("design_damper", "loss_factor", (0, -1), lambda x: _rubber(x)),
    ("scheme", "diameter", (0, -1), lambda x: lw.scheme(V8, diameter=x)),
    ("choose_motor", "reserve", (0, -1), lambda x: lw.choose_motor(CART, reserve=x)),
    ("choose_motor", "unevenness", (0, -1), lambda x: lw.choose_motor(CART, unevenness=x)),
    ("choose_motor", "inertias", (-1,), lambda x: lw.choose_motor(CART, inertias={"4A132S6U3": x})),
    ("choose_flywheel", "unevenness", (0, -1), lambda x: lw.choose_flywheel(CART, x)),
    ("crank_rocker", "swing", (0, -1, 4), lambda x: lw.crank_rocker(x)),
    ("crank_rocker", "time_ratio", (0, -1), lambda x: lw.crank_rocker(1.0, x)),
    ("crank_rocker", "frame", (0, -1), lambda x: lw.crank_rocker(1.0, frame=x)),
    ("crank_rocker", "coupler_max", (0, -1), lambda x: lw.crank_rocker(1.0, coupler_max=x)),
    ("slider_crank", "stroke", (0, -1), lambda x: lw.slider_crank(x)),
    ("slider_crank", "time_ratio", (0, -1), lambda x: lw.slider_crank(0.1, x)),
    ("slider_crank", "rod", (0, -1), lambda x: lw.slider_crank(0.1, 1.1, rod=x)),
    ("straight_line", "length", (0, -1), lambda x: lw.straight_line("hoeken", x)),
    ("straight_lines", "length", (0, -1), lambda x: lw.straight_lines(x)),
    ("write_drawing", "tolerance", (0, -1), lambda x: _written(tolerance=x)),
    ("write_drawing", "step", (0, -1), lambda x: _written(step=x)),
)


def _rubber(factor: float) -> Any:
    return lw.design_damper(V8, disc(), 0.5, kind="rubber", loss_factor=factor)


def _written(**options: float) -> Any:
    import tempfile

    with tempfile.TemporaryDirectory() as folder:
        return lw.write_drawing(folder, lw.cam_drawings(lw.cam_profile(CAM))[0], **options)


def _record() -> tuple[Any, Any, Any]:
    t = np.linspace(0, 2, 4001)
    return t, 100 * t, np.sin(100 * t)


def _cart_masses() -> dict[str, Any]:
    return {"bodies.cart.mass": [900.0, 1000.0]}


def paper() -> Any:
    from linkwright.papers.published_lengths import PAPER

    return PAPER


def point(found: lw.Machine) -> str:
    return next(iter(found.linkage.points))


def crank() -> str:
    return next(iter(PRESS.mechanism.cranks))


def slider() -> str:
    return next(iter(PRESS.mechanism.sliders))


def pin() -> str:
    return next(iter(lw.forces(CART, speed=1.0).reaction_max))


def disc() -> str:
    return next(iter(V8.train.discs))


def engine() -> Any:
    return V8.train.engine


CASES = [
    pytest.param(argument, value, call, id=f"{name}-{argument}-{value:g}")
    for name, argument, wrong, call in ROWS
    for value in (*NEVER, *wrong)
    # Either of the two ends a motion in time; without end is what the other is left out for.
    if not (argument in ("duration", "turns") and value == math.inf)
]


@pytest.mark.parametrize(("argument", "value", "call"), CASES)
def test_refused_with_the_name_of_the_argument(
    argument: str, value: float, call: Callable[[float], Any]
) -> None:
    with pytest.raises(InputError) as caught:
        call(value)
    assert argument in str(caught.value)
