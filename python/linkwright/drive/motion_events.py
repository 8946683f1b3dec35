r"""What happens on the way of a motion in time, and the extremes of its speed and acceleration.

Between the ends of the steps the motion is a polynomial in the share z of the step, whose derivative at both
ends is the acceleration itself. Extremes are sought among the ends and the zeros of that polynomial's
derivatives, so they are as exact as the motion.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np
from numpy.polynomial import polynomial

from linkwright.drive.transient import End, Transient
from linkwright.kernel.arrays import Floats
from linkwright.kernel.public import public
from linkwright.linkages.whole_cycle import over_whole_motion
from linkwright.machine.machine import Machine
from linkwright.machine.program.compiled import compile_machine

# How close the end of a step is to a kink that it was ended at [rad]: the solver lands within 1e-3 of the
# root of its accuracy, which is at most 1e-2.
_AT_KINK = 1e-4

# A jump of the acceleration, over its largest size: less is its change over the steps beside a kink.
_JUMP = 1e-3

# Shares of a step at which it is looked for the step with the extreme.
_LOOK = np.linspace(0.0, 1.0, 17)

_ENDS = {
    End.TIME: "end of the time",
    End.TURNS: "end of the revolutions",
    End.DOES_NOT_START: "does not start",
    End.STARTS_BACKWARDS: "is driven backwards at the start",
    End.STALL: "stall",
    End.REVERSAL: "standstill, then driven backwards",
}


class MotionEvent(NamedTuple):
    """Something that happens at one instant of a motion.

    Attributes
    ----------
    kind : str
        ``"start"``, ``"kink"``, ``"jump of the acceleration"``, ``"standstill"``, or how the motion ends.
    time : float
        [s].
    crank_angle : float
        Counted on over the revolutions [rad].
    speed : float
        Of the crank [rad/s].
    acceleration_before, acceleration_after : float or None
        Of the crank [rad/s²]; None where there is no before or after.
    torque_drive, torque_load : float or None
        Where the motion ends, at the crank [N·m]; at rest, what the drive gives and what the loads need.
    """

    kind: str
    time: float
    crank_angle: float
    speed: float
    acceleration_before: float | None = None
    acceleration_after: float | None = None
    torque_drive: float | None = None
    torque_load: float | None = None


class MotionExtreme(NamedTuple):
    """An extreme of a motion in time.

    Attributes
    ----------
    quantity : str
        ``"speed"`` or ``"acceleration"`` of the crank.
    kind : str
        ``"minimum"`` or ``"maximum"``.
    value : float
        [rad/s or rad/s²].
    time : float
        [s].
    crank_angle : float
        Counted on over the revolutions [rad].
    """

    quantity: str
    kind: str
    value: float
    time: float
    crank_angle: float


@public
def motion_events(machine: Machine, motion: Transient) -> tuple[MotionEvent, ...]:
    """Events of a motion in time: start, kinks of the loads, jumps, standstill, end.

    Parameters
    ----------
    machine : Machine
        The machine that moves.
    motion : Transient

    Returns
    -------
    tuple of MotionEvent
        By time. A kink is an angle at which a load or the mechanism begins another law, such as the knot of a
        table or a dead centre under dry friction; if the acceleration jumps there, it is such a jump.
    """
    before, after = sides(motion)
    scale = float(np.abs([before, after]).max()) if len(before) else 0.0
    away = _from_kink(motion.crank_angle, *_kinks(machine))
    events = [_event(motion, 0, "start", None, _at(after, 0))]
    sense = np.sign(motion.crank_angle[-1] - motion.crank_angle[0])
    for first, last in _passages(motion, away):
        # A short step may lead over the kink itself: what comes after is read behind it.
        behind = next((k for k in range(first, last + 1) if sense * away[k] > 0), last)
        jumps = abs(after[behind] - before[first - 1]) > _JUMP * scale
        is_kink = abs(away[first]) < _AT_KINK and not _at_full_turn(motion.crank_angle[first])
        kind = "jump of the acceleration" if jumps else "kink" if is_kink else ""
        kind = "standstill" if motion.speed[first] == 0 else kind
        if kind:
            events.append(_event(motion, first, kind, float(before[first - 1]), float(after[behind])))
    end = _event(motion, len(motion.time) - 1, _ENDS[motion.end], _at(before, -1), None)
    return (*events, end._replace(torque_drive=motion.torque_drive_end, torque_load=motion.torque_load_end))


@public
def motion_extremes(motion: Transient) -> tuple[MotionExtreme, ...]:
    """Extremes of speed and acceleration of the crank, as accurate as the motion.

    Parameters
    ----------
    motion : Transient

    Returns
    -------
    tuple of MotionExtreme
        Minimum and maximum of the speed, then of the acceleration; none if the machine does not move.
    """
    if len(motion.time) < 2:
        return ()
    speed = motion.between.coefficients(1)
    step = np.diff(motion.time)
    acceleration = polynomial.polyder(speed.T).T / step[:, None]
    speed[:, 0] = motion.speed[:-1]
    extremes = []
    for name, curves in (("speed", speed), ("acceleration", acceleration)):
        for kind, sign in (("minimum", -1.0), ("maximum", 1.0)):
            value, k, z = largest(sign * curves)
            time = float(motion.time[k] + z * step[k])
            extremes.append(
                MotionExtreme(name, kind, sign * value + 0.0, time, float(motion.at([time])[0][0]))
            )
    return tuple(extremes)


def course(motion: Transient, intervals: int) -> tuple[Floats, Floats, Floats, Floats]:
    """t [s], φ [rad], ω [rad/s], ε [rad/s²] at equal intervals, (intervals + 1,); one instant if at rest."""
    if len(motion.time) < 2:
        return motion.time, motion.crank_angle, motion.speed, motion.acceleration
    time = np.linspace(motion.time[0], motion.time[-1], intervals + 1)
    return time, *states(motion, time)


def states(motion: Transient, time: Floats) -> tuple[Floats, Floats, Floats]:
    """Angle [rad], speed [rad/s] and acceleration [rad/s²] at times of a motion that moves, (n,) each."""
    k = np.clip(np.searchsorted(motion.time, time, side="right") - 1, 0, len(motion.time) - 2)
    step = np.diff(motion.time)[k]
    z = (time - motion.time[k]) / step
    rates = polynomial.polyder(motion.between.coefficients(1).T)[:, k]
    return *motion.at(time), polynomial.polyval(z, rates, tensor=False) / step


def sides(motion: Transient) -> tuple[Floats, Floats]:
    """Acceleration at the end and at the start of every step [rad/s²]; at a kink the two differ."""
    step = np.diff(motion.time)
    rates = polynomial.polyder(motion.between.coefficients(1).T).T / step[:, None] if len(step) else None
    if rates is None:
        return np.empty(0), np.empty(0)
    return rates.sum(axis=1), rates[:, 0]


def largest(curves: Floats) -> tuple[float, int, float]:
    """The largest value of polynomials by powers, (k, degree + 1), on [0, 1]: value, polynomial, place."""
    looked = polynomial.polyval(_LOOK, curves.T)
    # Between two places a polynomial rises above them by an eighth of the square of their distance times its
    # second derivative at most, and that is at most the sum of the sizes of its coefficients.
    bend = np.abs(polynomial.polyder(curves.T, 2)).sum(axis=0)
    hidden = bend * (_LOOK[1] - _LOOK[0]) ** 2 / 8
    best = float(looked.max())
    candidates = np.flatnonzero(looked.max(axis=1) + hidden >= best)
    return max((_peak(curves[k], int(k)) for k in candidates), key=lambda curve: curve[0])


def _peak(curve: Floats, k: int) -> tuple[float, int, float]:
    """The largest value of one polynomial on [0, 1]."""
    slope = polynomial.polytrim(polynomial.polyder(curve))
    roots = polynomial.polyroots(slope) if len(slope) > 1 else np.empty(0)
    # A double zero of the slope may come out as a pair with small imaginary parts: both ends stay candidates.
    places = np.array([0.0, 1.0, *(root.real for root in roots if 0 < root.real < 1)])
    values = polynomial.polyval(places, curve)
    at = int(np.argmax(values))
    return float(values[at]), k, float(places[at])


def _passages(motion: Transient, away: Floats) -> Iterator[tuple[int, int]]:
    """Ends of steps inside the motion; those at one kink together, as the first and the last of them."""
    count, k = len(motion.time) - 1, 1
    while k < count:
        last, start = k, motion.crank_angle[k]
        while (
            abs(away[k]) < _AT_KINK
            and last + 1 < count
            and abs(motion.crank_angle[last + 1] - start) < _AT_KINK
        ):
            last += 1
        if abs(motion.crank_angle[k] - motion.crank_angle[0]) > _AT_KINK:
            yield k, last
        k = last + 1


def _kinks(machine: Machine) -> tuple[Floats, float]:
    """Crank angles at which the equation of motion has kinks, and the cycle of these [rad]."""
    compiled = compile_machine(machine).first()
    compiled = over_whole_motion(compiled) or compiled
    return compiled.kinks(), compiled.cycle


def _from_kink(angles: Floats, kinks: Floats, cycle: float) -> Floats:
    """How far angles are past the next kink of any cycle, negative before it [rad]; (n,)."""
    if not len(kinks):
        return np.full(len(angles), np.inf)
    away = np.mod(angles[:, None] - kinks[None, :] + 0.5 * cycle, cycle) - 0.5 * cycle
    return np.take_along_axis(away, np.abs(away).argmin(axis=1)[:, None], axis=1)[:, 0]


def _at_full_turn(angle: float) -> bool:
    """Whether an angle is the origin from which kinks are counted, which is no kink itself."""
    return abs((angle + np.pi) % (2 * np.pi) - np.pi) < _AT_KINK


def _event(motion: Transient, k: int, kind: str, before: float | None, after: float | None) -> MotionEvent:
    time, angle, speed = (float(curve[k]) for curve in (motion.time, motion.crank_angle, motion.speed))
    return MotionEvent(kind, time, angle, speed, before, after)


def _at(values: Floats, k: int) -> float | None:
    return float(values[k]) if len(values) else None
