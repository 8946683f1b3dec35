r"""Link and lever of a rotator, given or made for the unit and the regime.

In the continuous regime link and lever are in line at both ends of the stroke, :math:`l_5 = (M-m)/2`,
:math:`l_4 = (M+m)/2`, with m and M the extremes of the distance l_d from the pin to the hanger
(`rod_rotator`). In the intermittent regime the lever rocks through a required swing; of the lengths that give
it, those are taken with which the angle γ between lever and diagonal l_d swings evenly about 90°, where the
link pulls best: :math:`l_5 = (M-m)/(2\sin\tfrac{s}{2})`, :math:`l_4^2 = M m + l_5^2` with s the swing against
the diagonal. The diagonal swings too, so not every swing can be had: s = 180° would give the shortest lever,
and no lever is longer than the diagonal at its longest, or it would reach above the beam's pin.

Where entries carry derivatives, s follows them so that the swing S of the lever stays the required one,

.. math:: \mathrm d s = \frac{\mathrm d S_\mathrm{required} - \mathrm d S|_s}{\partial S/\partial s},

with S between fixed places of the stroke, those at which the lever turns back (envelope theorem).

References
----------
.. [1] Paper 4, equations (3) to (7); the lengths for a swing are derived here.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple, TypeVar

import numpy as np

from linkwright.kernel.arrays import Floats
from linkwright.kernel.description.base import Description
from linkwright.kernel.errors import AssemblyError
from linkwright.kernel.numerics.implicit import solution_along
from linkwright.kernel.numerics.tangent import (
    Tangent,
    lifted,
    plain,
    primal,
    variables_of,
)
from linkwright.kernel.numerics.turn_fit import turn_curve
from linkwright.pumping.model.rod_rotator import ROTATOR, RodRotator, diagonal, diagonal_extremes
from linkwright.pumping.model.unit import PumpingUnit

P = TypeVar("P", bound=Description)

# Places over the stroke at which the lever's angle is examined; a parabola between them errs by 1e-13. A
# first look takes every sixteenth: its error of 1e-8 only moves the ends of an interval that is searched.
_SAMPLES = 2001
_EVERY = 16

# Maximum swing against the diagonal [rad]: at 180° link and lever are in line at both ends of the stroke and
# may go on either way. A thousandth less keeps the joint a fifty-thousandth of the lever's length from there.
_SHORT_OF_LINE = np.pi - 1e-3

# Maximum swing that can be asked for, rounded as it is reported [deg].
_MOST = 179.99

# Swings against the diagonal at which the first look finds between which two the wanted one is.
_LOOKS = 65

# Steps of the false position, which gains a digit and more in each, and the error that is rounding [rad].
_STEPS = 60
_CLOSE = 1e-14


class Lengths(NamedTuple):
    """Lengths of a rotator."""

    # link, lever: l_4 and l_5 [m].
    link: Any
    lever: Any


def lengths(unit: PumpingUnit, rotator: RodRotator) -> Lengths:
    """Link and lever, given or made for the unit and the regime [m]."""
    if rotator.link_length is not None:
        return Lengths(rotator.link_length, rotator.lever_length)
    m, M = diagonal_extremes(unit, rotator)
    varies = bool(np.ndim(M)) or isinstance(rotator.swing, np.ndarray)
    if not varies and not unit.reaches_ends:
        raise AssemblyError(
            "the lengths of the rotator follow from the ends of the stroke, which the pumping unit does not "
            "reach: its crank cannot rotate fully; change R, P, C or the place of the saddle bearing",
            element=ROTATOR,
        )
    if rotator.regime == "continuous":
        link, lever = 0.5 * (M + m), 0.5 * (M - m)
    else:
        n = variables_of((m, M, rotator.swing))
        lever = _rocking_lever(unit, rotator, varies=varies) if n is None else _lever_along(unit, rotator, n)
        link = np.sqrt(M * m + lever**2)
    if varies:
        has_none = ~(unit.reaches_ends & (lever > 0))
        return Lengths(*(np.where(has_none, np.nan, length) for length in (link, lever)))
    if not lever > 0:
        raise _no_room(*map(primal, (m, M)))
    return Lengths(plain(link), plain(lever))


def required(rotator: RodRotator) -> Any:
    """The swing that the lever is to have [rad]."""
    return np.pi / 2 if rotator.swing is None else rotator.swing


def _rocking_lever(unit: PumpingUnit, rotator: RodRotator, varies: bool) -> Any:
    """Lever that rocks through the required swing [m]; NaN in the rows of a batch that have none."""
    stroke = LeverStroke.of(unit, rotator)
    lever = stroke.lever(_swing(stroke, rotator, varies=varies))[:, 0]
    return lever if varies else float(lever[0])


def _lever_along(unit: PumpingUnit, rotator: RodRotator, n: int) -> Any:
    """The same of one machine with derivatives by n variables."""
    still = _still(unit), _still(rotator)
    stroke = LeverStroke.of(*still)
    swing = _swing(stroke, still[1], varies=False)
    lever, product = float(stroke.lever(swing)[0, 0]), float((stroke.bottom * stroke.top)[0, 0])
    shares = turning_shares(*still, lever, product)
    angles = LeverStroke.of(*still, shares).angle(lever, product)[0]
    places = np.array([0.0, shares[angles.argmax()], shares[angles.argmin()], 1.0])

    def spread(stroke: LeverStroke, swing: Any) -> Any:
        angle = stroke.angle(stroke.lever(swing), stroke.bottom * stroke.top)
        return angle[:, 1:2] - angle[:, 2:3]

    moved = LeverStroke.of(unit, rotator, places)
    late = lifted(spread(moved, swing) - required(rotator), n)
    slope = spread(LeverStroke.of(*still, places), Tangent(swing, np.ones((1, 1, 1)))).d
    return moved.lever(solution_along(swing, late, slope[..., 0]))[0, 0]


def _swing(stroke: LeverStroke, rotator: RodRotator, varies: bool) -> Any:
    """Swing against the diagonal with which the lever has the required one, (rows, 1) [rad]; or NaN."""
    wanted = np.atleast_1d(required(rotator))
    swings, spread = stroke.first_look()
    if not varies and np.isnan(spread).all():
        raise _no_room(stroke.top[0, 0], stroke.bottom[0, 0])
    # Rows are machines; a number that they share stands in one row.
    goal = np.broadcast_to(wanted, np.broadcast_shapes(wanted.shape, spread.shape[:1]))[:, None]
    crossed = (spread[:, :-1] - goal) * (spread[:, 1:] - goal) <= 0
    if not varies and not crossed.any():
        raise _unattainable(rotator, float(goal[0, 0]), stroke, spread)
    # Of several swings against the diagonal the largest, which has the shortest lever.
    last = _LOOKS - 2 - crossed[:, ::-1].argmax(axis=1)[:, None]
    swings = np.broadcast_to(swings, (len(last), _LOOKS))
    low, high = (np.take_along_axis(swings, last + k, axis=1) for k in (0, 1))
    swing = _false_position(lambda s: stroke.spread(s) - goal, low, high)
    return np.where(crossed.any(axis=1, keepdims=True), swing, np.nan)


def _no_room(m: float, M: float) -> AssemblyError:
    return AssemblyError(
        f"no link and lever fit the rotator: its pin is {M:.4g} m from the hanger at the bottom of the "
        f"stroke, {m:.4g} m at the top, and must come nearer all the way up; choose a "
        "rod_rotator.pin_distance below pumping_unit.A",
        element=ROTATOR,
    )


def _unattainable(rotator: RodRotator, wanted: float, stroke: LeverStroke, spread: Any) -> AssemblyError:
    M, m = float(stroke.bottom[0, 0]), float(stroke.top[0, 0])
    low, high = _range(spread)
    turned = _range(LeverStroke(stroke.distance, -stroke.lean).first_look()[1])
    other = "right" if rotator.assembly == "left" else "left"
    fits = turned[0] <= np.degrees(wanted) <= turned[1]
    remedy = f'assembly = "{other}"' if fits else "a rod_rotator.swing between these or another pin_distance"
    return AssemblyError(
        f"no lever of the rotator swings through {np.degrees(wanted):.6g}°: levers from {0.5 * (M - m):.4g} "
        f"m, in line with the link at both ends of the stroke, to {M:.4g} m, the maximum distance from the "
        f"beam's pin to the hanger, swing through {low:.2f}° to {high:.2f}°; choose {remedy}",
        element=ROTATOR,
    )


def _range(spread: Any) -> tuple[float, float]:
    """Minimum and maximum swing of the lever [deg], rounded inward so that both are attainable."""
    low, high = (100 * np.degrees(float(extreme(spread))) for extreme in (np.nanmin, np.nanmax))
    return float(np.ceil(low) / 100), min(float(np.floor(high) / 100), _MOST)


class LeverStroke(NamedTuple):
    """Places over the stroke from bottom to top, (rows, places)."""

    distance: Any  # l_d [m]
    lean: Any  # angle of the diagonal, in the sense in which the lever turns away from it [rad]

    @classmethod
    def of(cls, unit: PumpingUnit, rotator: RodRotator, share: Any = None) -> LeverStroke:
        """The stroke of each unit at shares of the way from bottom to top, evenly if none are given."""
        unit, rotator = _as_columns(unit), _as_columns(rotator)
        share = np.linspace(0.0, 1.0, _SAMPLES) if share is None else share
        bottom, top = (unit.front_angle(psi) for psi in (unit.psi_bottom, unit.psi_top))
        dx, dy = np.atleast_2d(*diagonal(unit, rotator, bottom + (top - bottom) * share))
        # From the vertical toward the beam, the diagonal leans by atan(l_dx/l_dy); with the well to the
        # right that is counter-clockwise. Seen from there, the lever turns clockwise from the diagonal for a
        # joint on the left.
        is_left = (rotator.assembly == "left") != unit.is_mirrored
        return cls(np.hypot(dx, dy), np.arctan2(dx, dy) * (1.0 if is_left else -1.0))

    @property
    def bottom(self) -> Any:
        """M, (rows, 1) [m]."""
        return self.distance[:, :1]

    @property
    def top(self) -> Any:
        """m, (rows, 1) [m]."""
        return self.distance[:, -1:]

    def lever(self, swing: Any) -> Any:
        """l_5 for swings against the diagonal, (rows, 1) [m]."""
        return 0.5 * (self.bottom - self.top) / np.sin(0.5 * swing)

    def spread(self, swing: Any) -> Any:
        """Swing of the lever for swings against the diagonal, (rows, 1) [rad]."""
        return _spread(self.angle(self.lever(swing), self.bottom * self.top))

    def angle(self, lever: Any, excess: Any) -> Any:
        """Angle of a lever l_5, in the sense of `lean` [rad]; ``excess``: l_4² − l_5² [m²]."""
        # Beyond ±1 by rounding alone: l_d is between l_4 − l_5 and l_4 + l_5.
        cosine = (self.distance**2 - excess) / (2 * self.distance * lever)
        return self.lean - np.arccos(np.clip(cosine, -1.0, 1.0))

    def first_look(self) -> tuple[Any, Any]:
        """Swings against the diagonal, and of the lever, (rows, looks) [rad]; NaN where l_d does not fall."""
        falls = (np.diff(self.distance) < 0).all(axis=1, keepdims=True)
        # A row without lengths is followed with a diagonal that falls, and left out afterwards.
        distance = np.where(falls, self.distance, np.linspace(2.0, 1.0, self.distance.shape[1]))
        stroke = LeverStroke(distance[:, ::_EVERY], self.lean[:, ::_EVERY])
        least = 2 * np.arcsin(0.5 * (1 - stroke.top / stroke.bottom))
        swings = least + (_SHORT_OF_LINE - least) * np.linspace(0.0, 1.0, _LOOKS)
        spread = np.concatenate([stroke.spread(swings[:, k : k + 1]) for k in range(_LOOKS)], axis=1)
        return swings, np.where(falls, spread, np.nan)


def _false_position(function: Callable[[Any], Any], low: Any, high: Any) -> Any:
    """Root between two bounds in each row, (rows, 1), by the Illinois false-position method."""
    # Dowell, Jarratt, A modified regula falsi method, BIT 11 (1971) 168–174.
    at_low, at_high = function(low), function(high)
    middle = high
    for _ in range(_STEPS):
        slope = np.where(at_high == at_low, 1.0, at_high - at_low)
        middle = np.clip(high - at_high * (high - low) / slope, np.minimum(low, high), np.maximum(low, high))
        value = function(middle)
        if not (np.abs(value) > _CLOSE).any():
            break
        # The last place stays, with that on the other side of the root; one that stays twice counts half.
        turns = value * at_high < 0
        low, at_low = np.where(turns, high, low), np.where(turns, at_high, 0.5 * at_low)
        high, at_high = middle, value
    return middle


def turning_shares(unit: PumpingUnit, rotator: RodRotator, lever: float, excess: float) -> Floats:
    """Shares of the stroke at which a rocking lever turns back, with 0 and 1; as of `LeverStroke.angle`."""

    def slope(share: Floats) -> Floats:
        stroke = LeverStroke.of(unit, rotator, Tangent(share, np.ones((len(share), 1))))
        rate: Floats = stroke.angle(lever, excess).d[..., 0]
        return rate

    return zeros_of_stroke(slope)


def zeros_of_stroke(slope: Callable[[Floats], Floats]) -> Floats:
    """Shares of the stroke at which a slope, (1, n), changes its sign, with both ends."""
    inside = turn_curve(slope, np.array([0.0, 1.0]), "lever of the rotator").crossings()
    return np.concatenate([[0.0], inside, [1.0]])


def _still(part: P) -> P:
    along = {name: value.value for name, value in part if isinstance(value, Tangent)}
    return part.with_entries(along) if along else part


def _as_columns(part: P) -> P:
    """The description with arrays over machines as columns, so that places over a stroke stand in rows."""
    arrays = {name: value[:, None] for name, value in part if isinstance(value, np.ndarray)}
    return part.with_entries(arrays) if arrays else part


def _spread(angle: Any) -> Any:
    """Peak-to-peak value of each row of smooth values, an extreme between samples by the parabola there."""
    ends = []
    for sign in (1.0, -1.0):
        values = sign * angle
        best = np.clip(values.argmax(axis=-1), 1, values.shape[-1] - 2)[..., None]
        left, middle, right = (np.take_along_axis(values, best + off, axis=-1) for off in (-1, 0, 1))
        curvature, slope = left - 2 * middle + right, 0.5 * (right - left)
        inside = (curvature < 0) & (np.abs(slope) <= np.abs(curvature))
        vertex = middle - 0.5 * slope**2 / np.where(inside, curvature, 1.0)
        ends.append(np.where(inside, vertex, values.max(axis=-1, keepdims=True)))
    return ends[0] + ends[1]
