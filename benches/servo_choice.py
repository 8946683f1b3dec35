"""How long does it take to judge 5000 servo motors with 40 gearboxes for an axis?"""

from __future__ import annotations

from typing import Any

import numpy as np
from common import Row, seconds

import linkwright as lw
from linkwright.axes.axis import servo_axis
from linkwright.axes.choice import choose_servo
from linkwright.axes.model.axis_catalogue import CatalogueGearbox, CatalogueServo
from linkwright.axes.model.axis_gearbox import AxisGearbox
from linkwright.axes.model.servo_motor import ServoMotor

MOTORS, GEARBOXES = 5000, 40

CARRIAGE = """
format = 1
name = "carriage"
[master]
cycle_time = "0.5 s"
[axes.A]
sections = [
    { swing = "180 deg", angle = "140 deg" },
    { angle = "40 deg" },
    { swing = "-180 deg", angle = "140 deg" },
]
[mechanism.cranks.A]
radius = "120 mm"
[mechanism.sliders.carriage]
crank = "A"
rod = "400 mm"
[bodies]
carriage = { mass = "12 kg" }
"carriage.rod" = { mass = "1.5 kg" }
[loads]
guide = { kind = "dry", on = "carriage", force = "40 N" }
"""


def rows(quick: bool) -> list[Row]:
    """Seconds for all pairs on one core."""
    cycle = servo_axis(lw.loads(CARRIAGE)).cycle
    motors, gearboxes = servos(), gears()
    time = seconds([lambda: choose_servo(cycle, motors, gearboxes)], repeats=3 if quick else 5)[0]
    passing = len(choose_servo(cycle, motors, gearboxes).order)
    note = f"{MOTORS} motors with {GEARBOXES} gearboxes over {len(cycle.time)} samples; {passing} pairs pass"
    return [Row("choice of a servo motor", "s", time, target=1.0, aim="at most", note=note)]


def servos() -> list[CatalogueServo]:
    """Motors of half to fifty newton metres, drawn with a fixed seed."""
    draw = np.random.default_rng(4)
    return [CatalogueServo(f"M{n}", ServoMotor.model_validate(entries(draw)), 1.0) for n in range(MOTORS)]


def entries(draw: Any) -> dict[str, Any]:
    """One motor with curves of three and four points."""
    torque, top = 10 ** draw.uniform(-0.3, 1.7), draw.choice([300.0, 450.0, 600.0])
    return {
        "inertia": 1e-5 * torque**1.4 * 10 ** draw.uniform(-0.3, 0.3),
        "continuous": {"speed": (0, 0.5 * top, top), "torque": (1.1 * torque, torque, 0.4 * torque)},
        "peak": {
            "speed": (0, 0.55 * top, 0.75 * top, top),
            "torque": (3 * torque, 3 * torque, 2 * torque, 1.2 * torque),
        },
    }


def gears() -> list[CatalogueGearbox]:
    """Ratios of 3 to 100."""
    return [
        CatalogueGearbox(f"G{n}", AxisGearbox(ratio=float(ratio), efficiency=0.95, inertia=2e-5))
        for n, ratio in enumerate(np.geomspace(3, 100, GEARBOXES))
    ]
