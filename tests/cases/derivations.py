"""Right answers of the cases by closed forms, and what their mistakes give; Linkwright is not used.

A function has the name of its case, ``NAME.toml``, and gives for each number that the case shows the right
value and that of the mistake, None where the mistake gives none.
"""

from __future__ import annotations

import cmath
import math
from collections.abc import Callable
from math import acos, asin, atan, atan2, cos, pi, sin, sqrt

Answers = list[tuple[float, float | None]]


def _joint(a: float, b: float, c: float, d: float, angle: float, side: int) -> complex:
    """Joint of a four-bar linkage, on the left (1) or right (-1) of the line from pin to pivot."""
    pin = cmath.rect(a, angle)
    line = d - pin
    f = abs(line)
    p = (f**2 + b**2 - c**2) / (2 * f)
    return pin + line / f * complex(p, side * sqrt(b**2 - p**2))


def mirrored_branch() -> Answers:
    right, mirrored = (_joint(0.5, 1.2, 0.8, 1.0, math.radians(300), side) for side in (1, -1))
    return [(right.real, mirrored.real), (right.imag, mirrored.imag)]


def change_point() -> Answers:
    folded = [_joint(0.1, 0.3, 0.1, 0.3, math.radians(200), side) - 0.3 for side in (1, -1)]
    right = math.radians(200 - 360)
    # One of the two is the parallelogram.
    mirrored = max((cmath.phase(arm) for arm in folded), key=lambda angle: abs(angle - right))
    return [(right, mirrored)]


def open_dyad() -> Answers:
    limit = acos((0.2**2 + 0.4**2 - (0.25 + 0.15) ** 2) / (2 * 0.2 * 0.4))
    return [(limit, None), (2 * pi - limit, None)]


def redundant_bar() -> Answers:
    return [(0.1 * sin(math.radians(200)), None)]


def planet_speed() -> Answers:
    carrier = 2 * pi
    return [(carrier * (1 + 40 / 20), carrier * 40 / 20)]


def angle_of_a_lever() -> Answers:
    x, y = 0.1 * cos(math.radians(150)) - 0.03, 0.1 * sin(math.radians(150))
    return [(atan2(y, x), atan(y / x))]


def peak_piston_velocity() -> Answers:
    r, rod, speed = 0.05, 0.15, 20 * pi

    def velocity(angle: float) -> float:
        return speed * (
            r * sin(angle) + r**2 * sin(angle) * cos(angle) / sqrt(rod**2 - (r * sin(angle)) ** 2)
        )

    # Golden section on the one peak between the dead centres; flat there, so half the digits suffice.
    low, high = 0.0, pi
    share = (sqrt(5) - 1) / 2
    while high - low > 1e-9:
        first, second = high - share * (high - low), low + share * (high - low)
        low, high = (low, second) if velocity(first) > velocity(second) else (first, high)
    return [(velocity(low), speed * r)]


def time_ratio() -> Answers:
    r, rod, e = 0.1, 0.3, 0.08
    stroke = sqrt((rod + r) ** 2 - e**2) - sqrt((rod - r) ** 2 - e**2)
    slow = pi + asin(e / (rod - r)) - asin(e / (rod + r))
    return [(stroke, 2 * r), (slow / (2 * pi - slow), 1.0)]


def torque_at_constant_speed() -> Answers:
    mass, r, rod, speed, angle = 2.0, 0.05, 0.15, 20 * pi, pi / 4
    root = sqrt(rod**2 - (r * sin(angle)) ** 2)
    first = -r * sin(angle) - r**2 * sin(2 * angle) / (2 * root)
    second = -r * cos(angle) - r**2 * cos(2 * angle) / root - (r**2 * sin(2 * angle)) ** 2 / (4 * root**3)
    return [(mass * first * second * speed**2, 0.0)]


def dry_friction() -> Answers:
    return [(500 * 4 * 0.1 / (2 * pi), 0.0)]


def inertia_through_a_gearbox() -> Answers:
    return [(2 + 15**2 * 0.02, 2 + 15 * 0.02)]


def _two_discs(one: float, two: float, stiffness: float) -> float:
    """Natural frequency of two discs on a shaft [rad/s]."""
    return sqrt(stiffness * (1 / one + 1 / two))


def radians_and_hertz() -> Answers:
    omega = _two_discs(2, 3, 100e3)
    return [(omega / (2 * pi), omega)]


def stiffness_per_degree() -> Answers:
    per_radian = 100 * 180 / pi
    return [(_two_discs(2, 3, per_radian) / (2 * pi), _two_discs(2, 3, 100) / (2 * pi))]


def half_order() -> Answers:
    omega = _two_discs(1, 2, 10e3)
    return [(omega, omega), (omega / 0.5, None)]


def cam_offset() -> Answers:
    prime, e, lift, over = 0.05, 0.005, 0.02, pi / 2

    def largest(offset: float) -> float:
        start = sqrt(prime**2 - offset**2)
        # So many samples leave a hundred-millionth of the flat maximum.
        shares = [n / 40000 for n in range(40001)]
        return max(
            atan(
                (lift / over * (1 - cos(2 * pi * x)) - offset)
                / (start + lift * (x - sin(2 * pi * x) / (2 * pi)))
            )
            for x in shares
        )

    return [(largest(e), largest(-e))]


def unequal_limits() -> Answers:
    low, high = 0.0999, 0.1003
    # The mistake takes 0.2 mm on both sides of the nominal radius.
    return [(low + high, 0.2), (2 * low, 2 * 0.0998), (2 * high, 2 * 0.1002)]


# In the order of the page.
CASES: tuple[Callable[[], Answers], ...] = (
    *(mirrored_branch, change_point, open_dyad, redundant_bar, angle_of_a_lever, planet_speed),
    *(peak_piston_velocity, time_ratio, torque_at_constant_speed, dry_friction, inertia_through_a_gearbox),
    *(radians_and_hertz, stiffness_per_degree, half_order, cam_offset, unequal_limits),
)
