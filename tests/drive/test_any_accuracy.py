"""One machine, one motion: the accuracy that is asked for does not decide whether there is an answer."""

from __future__ import annotations

import re

import numpy as np
import pytest

import linkwright as lw
from linkwright import ConvergenceError

# A shaper with a limited motor: from the balance Newton's method finds the motion on some meshes alone.
SHAPER = """
format = 1
name = "Shaper with a limited motor"
[drive.motor]
kind = "dc"
torque_stall = 1672.9558985163528
speed_no_load = 115.14747703471802
inertia = 0.025672464661521184
torque_max = 16.868291834980795
[drive.gearbox]
ratio = 3.0
efficiency = 0.95
[mechanism.cranks.A]
radius = 0.19112368438373467
[mechanism.points]
D = { x = 0.4445429385517161 }
[mechanism.slotted_levers.L]
pin = "A"
pivot = "D"
length = 0.9556184219186734
[mechanism.rigid_points.K]
link = "L"
along = 0.7644947375349387
[mechanism.sliders.E]
crank = "K"
rod = 1.5289894750698774
offset = 0.7644947375349387
through = "D"
[bodies]
E = { mass = 15.319047815869585 }
A = { mass = 6.8122403812574, inertia = 0.001663229141738987 }
[loads.d]
kind = "force_position"
on = "E"
position = [
  -1.5289894750698774, 0.0, 0.19112368438373467, 0.38224736876746934, 0.573371053151204, 1.720113159453612,
]
forward = [0.0, 0.0, 1328.3843529218502, 0.0, 28.90614741265782, 0.0]
return = [1.0, 1.0, 1.0, 1.0, 1.0, 1.0]
[loads.fan]
kind = "formula"
on = "A"
torque = "-c*omega*abs(omega)"
constants = { c = 0.0448533563192348 }
"""

# A yoke under a soft sign two ten-thousandths of a radian wide at the dead centres.
YOKE = """
format = 1
name = "Yoke with soft friction"
[drive.motor]
kind = "table"
speed = [0.0, 24.187583806659465, 31.098322037133602, 34.55369115237067, 41.4644293828448]
torque = [21.719734852659624, 20.27175252914898, 28.95964647021283, 0.0, -14.479823235106416]
inertia = 6.6900620458422
[drive.gearbox]
ratio = 10.0
efficiency = 0.95
[mechanism.cranks.A]
radius = 0.16894538151107322
[mechanism.yokes.E]
pin = "A"
[bodies]
E = { mass = 5.687759620074418 }
A = { mass = 2.3232641385197415, inertia = 0.00042711301042290463 }
[loads.d]
kind = "formula"
on = "E"
force = "-F*tanh(v/0.00010038184116341449)"
constants = { F = 32.96546057963524 }
[loads.fan]
kind = "formula"
on = "A"
torque = "-c*omega*abs(omega)"
constants = { c = 0.06372341255478396 }
"""


def test_every_accuracy_has_the_motion_and_a_batch_too() -> None:
    machine = lw.loads(SHAPER)
    finest = lw.steady_state(machine, accuracy=1e-12).speed_max
    for accuracy in (1e-6, 1e-7, 1e-8, 1e-9, 1e-10):
        assert lw.steady_state(machine, accuracy=accuracy).speed_max == pytest.approx(finest, rel=1e-6)
    rows = lw.steady_states(machine, {"bodies.E.mass": np.full(2, lw.get(machine, "bodies.E.mass"))})
    assert (rows.status == 0).all()
    assert rows.speed_max == pytest.approx(finest, rel=1e-7)


def test_a_peak_within_a_soft_sign_is_the_same_in_a_batch() -> None:
    """To the 1e-6 that batches promise of peaks: read where the series has its top, it was 4.4e-6 low."""
    machine = lw.loads(YOKE)
    alone = lw.steady_state(machine, accuracy=1e-12)
    rows = lw.steady_states(machine, {"bodies.E.mass": np.full(2, lw.get(machine, "bodies.E.mass"))})
    assert rows.acceleration_max == pytest.approx(alone.acceleration_max, rel=1e-6)
    assert rows.acceleration_min == pytest.approx(alone.acceleration_min, rel=1e-6)


# A crank that idles under a motor with a table: it passes the kink of its table, and of the gearbox, where
# the torque changes its sign.
IDLE = """
format = 1
name = "Idling yoke"
[drive.motor]
kind = "table"
speed = [0.0, {low}, {peak}, {idle}, {fast}]
torque = [{torque}, {torque}, {most}, 0.0, {brake}]
inertia = {inertia}
[drive.gearbox]
ratio = 30.0
efficiency = 0.95
[mechanism.cranks.A]
radius = 0.129
[mechanism.yokes.E]
pin = "A"
[bodies]
E = {{ mass = {mass} }}
A = {{ mass = 0.438, inertia = 0.00744 }}
"""


def idling(random: np.random.Generator) -> lw.Machine:
    """One whose motor changes ε by up to 1e6 per rad²/s² of ½ω²."""
    idle, torque = 10 ** random.uniform(1, 2.5), 10 ** random.uniform(1, 5)
    speeds = {"low": 0.7 * idle, "peak": 0.9 * idle, "idle": idle, "fast": 1.2 * idle}
    torques = {"torque": torque, "most": 1.4 * torque, "brake": -torque}
    masses = {"inertia": 10 ** random.uniform(-4, 1), "mass": 10 ** random.uniform(0, 3)}
    return lw.loads(IDLE.format(**speeds, **torques, **masses))


def test_extremes_beside_a_kink_of_a_steep_motor() -> None:
    """A step ends on the kink: on which side its last stage lies to rounding counts for the acceleration."""
    random, names = np.random.default_rng(1), ("acceleration_min", "acceleration_max")
    for number in range(150):
        machine = idling(random)
        best = lw.steady_state(machine, accuracy=1e-12)
        size = max(*(abs(getattr(best, name)) for name in names), 1e-4 * best.speed_max**2)
        for accuracy in (1e-7, 1e-9, 1e-10, 1e-11):
            motion = lw.steady_state(machine, accuracy=accuracy)
            # Each is off by no more than it says; the factor allows for what both say being an estimate.
            told = 2.5 * (max(motion.accuracy, accuracy) + best.accuracy) * size
            for name in names:
                assert abs(getattr(motion, name) - getattr(best, name)) <= told, (number, name, accuracy)


# A speed controller: the full torque up to the speed that is wanted, and the full brake above it.
CONTROLLED = """
format = 1
name = "Rocker under a speed controller"
[drive.motor]
kind = "table"
inertia = 8.95222534682408e-06
speed = [0.0, {low}, 122.61576206758242, {high}]
torque = [0.015917580739390248, 0.015917580739390248, 0.0, -0.015917580739390248]
[drive.gearbox]
ratio = 3.0
efficiency = 0.9
reverse = "same"
[mechanism.points]
P = {{ x = -0.0959711764732497, y = 0.3407535204045866 }}
[mechanism.cranks.A]
radius = 0.08983606790420712
[mechanism.rockers.R]
crank = "A"
pivot = "P"
coupler = 0.23076310911831346
rocker = 0.25612772715830323
assembly = "right"
[bodies]
A = {{ inertia = 1.6522213457252124e-05 }}
"R.rocker" = {{ inertia = 0.0007018443528230996 }}
"R.coupler" = {{ mass_per_length = 0.15746368042543368 }}
[loads]
friction = {{ kind = "dry", on = "R.rocker", torque = 0.005140104113344058 }}
gravity = {{ kind = "gravity" }}
"""


def controlled(band: float) -> lw.Machine:
    idle = 122.61576206758242
    return lw.loads(CONTROLLED.format(low=idle * (1 - band), high=idle * (1 + band)))


def test_a_controller_with_a_narrow_band_is_no_refusal() -> None:
    """The narrower, the nearer to the motion of the narrowest; to that comes the motion in time too."""
    bands = np.geomspace(1e-2, 1e-4, 41)
    speeds = np.array([lw.steady_state(controlled(band)).speed[0] for band in bands])
    followed = lw.transient(controlled(bands[-1]), speed=34.0, turns=30, accuracy=1e-9)
    assert followed.speed[-1] == pytest.approx(speeds[-1], rel=1e-6)
    assert (np.abs(speeds / speeds[-1] - 1) <= bands).all()


def test_what_is_not_found_is_looked_at_in_time() -> None:
    """A band of a millionth is too narrow for some: what is said then is the motion of a wider one."""
    wide = lw.steady_state(controlled(1e-3))
    told = 0
    for band in np.geomspace(1e-5, 1e-8, 13):
        try:
            steady = lw.steady_state(controlled(band))
        except ConvergenceError as error:
            told += 1
            low, high = re.findall(r"settles between ([\d.]+) and ([\d.]+) rad/s", str(error))[0]
        else:
            low, high = steady.speed_min, steady.speed_max
        assert [float(low), float(high)] == pytest.approx([wide.speed_min, wide.speed_max], rel=2e-4)
    assert told
