r"""The worm-type rotator of a sucker-rod string: a lever on the hanger, pulled by a link from the beam.

| letter of paper 4 | is | key |
| --- | --- | --- |
| r, L, k, k_1 | crank, pitman, arms of the beam | `R`, `P`, `C`, `A` of the pumping unit |
| l_K | free cable at the top of the stroke | `cable` of the pumping unit |
| l_3 | saddle bearing to the link's pin on the beam | `pin_distance` |
| l_4 | link | `link_length` |
| l_5 | lever | `lever_length` |

With Y the depth of the hanger below the saddle and φ_3 the angle of the front arm above the horizontal, the
distance l_d from the pin to the hanger is

.. math::

    l_d^2 = (Y + l_3\sin\varphi_3)^2 + (k_1 - l_3\cos\varphi_3)^2, \qquad
    \frac{d\,l_d^2}{d\varphi_3} = -2\,(k_1 - l_3\cos\varphi_3)\,Y,

so for :math:`l_3 < k_1` it falls steadily while the beam rises: its extremes are those of the beam, m at the
top and M at the bottom.

In the continuous regime link and lever are in line at both ends, :math:`l_5 = (M-m)/2`, :math:`l_4 =
(M+m)/2`. In the intermittent regime the lever rocks through a wanted swing; of the lengths that give it,
those are taken with which the angle between lever and diagonal l_d swings evenly about 90°, where the link
pulls best: :math:`l_5 = (M-m)/(2\sin\tfrac{s}{2})`, :math:`l_4^2 = M m + l_5^2` with s the swing against the
diagonal.

References
----------
.. [1] Paper 4, equations (3) to (7); the derivative of l_d and the lengths for a swing are derived here.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Annotated, Any, Literal, NamedTuple, Self, TypeVar

import numpy as np
from pydantic import Field, model_validator
from pydantic_core import InitErrorDetails

from linkwright.machine.base import Description, fault, raise_faults
from linkwright.machine.element import PositiveLength
from linkwright.machine.pumping_unit import PumpingUnit
from linkwright.units import ANGLE, FRACTION, RATIO, TORQUE, Bound, Quantity, not_negative, positive

P = TypeVar("P", bound=Description)

# Names of the parts that a rotator expands into.
PIN, ROTATOR = "rotator_pin", "rotator"
LINK, LEVER = f"{ROTATOR}.coupler", f"{ROTATOR}.rocker"

# A lever that swings through half a turn comes into line with its link.
_SWING = Bound(
    " between 0 and 180 deg,",
    {"exclusiveMinimum": 0, "exclusiveMaximum": np.pi},
    lambda value: 0 < value < np.pi,
)


class RodRotator(Description):
    """A rotator of the rod string on the hanger of a pumping unit."""

    regime: Literal["continuous", "intermittent"] = Field(
        description="Whether the lever turns all round in each stroke, or rocks and works through a clutch."
    )
    pin_distance: PositiveLength = Field(
        description="Saddle bearing to the link's pin on the front arm, l_3."
    )
    link_length: PositiveLength | None = Field(
        None, description="Length l_4 of the link. Without it, that which suits the regime."
    )
    lever_length: PositiveLength | None = Field(
        None, description="Length l_5 of the lever. Without it, that which suits the regime."
    )
    swing: Annotated[float, Quantity(ANGLE, _SWING)] | None = Field(
        None, description="Wanted swing of the lever in the intermittent regime. Without it, 90 deg."
    )
    assembly: Literal["left", "right"] = Field(
        "left", description="Side of the joint of link and lever, seen from the pin to the hanger."
    )
    worm_ratio: Annotated[float, positive(RATIO)] | None = Field(
        None, description="Turns of the worm for a turn of the rod string."
    )
    worm_efficiency: Annotated[float, Quantity(RATIO, FRACTION)] = Field(
        1.0, description="Of the worm gear, worm driving."
    )
    string_torque: Annotated[float, not_negative(TORQUE)] | None = Field(
        None, description="Torque that it takes to turn the rod string."
    )
    clutch: Literal["upstroke", "downstroke"] = Field(
        "downstroke",
        description="Stroke in which the lever takes the worm along, in the intermittent regime.",
    )

    @model_validator(mode="after")
    def _entries_fit(self) -> Self:
        """Report entries that do not go together."""
        raise_faults("RodRotator", self._faults())
        return self

    def _faults(self) -> Iterator[InitErrorDetails]:
        given = [self.link_length is not None, self.lever_length is not None]
        if self.swing is not None and (self.regime == "continuous" or any(given)):
            remedy = "a swing is wanted of an intermittent rotator without given lengths"
            yield fault("swing", found=self.swing, expected="nothing", remedy=remedy)
        if given[0] != given[1]:
            key = "lever_length" if given[0] else "link_length"
            yield fault(key, expected="a length: link_length and lever_length are given together")


class Lengths(NamedTuple):
    """Lengths of a rotator.

    Attributes
    ----------
    link, lever : float
        l_4 and l_5 [m].
    """

    link: Any
    lever: Any


def diagonal(unit: PumpingUnit, rotator: RodRotator, front: Any) -> tuple[Any, Any]:
    """Distance from the pin to the hanger along x, and the hanger below the pin.

    Parameters
    ----------
    unit : PumpingUnit
        The unit.
    rotator : RodRotator
        The rotator.
    front : float or ndarray, shape (n,)
        Angle of the front arm above the horizontal [rad].

    Returns
    -------
    tuple
        l_dx and l_dy of paper 4 [m]; x points to the well.
    """
    top = unit.front_angle(unit.psi_top)
    l_3 = rotator.pin_distance
    depth = unit.cable + unit.A * (top - front)
    return unit.A - l_3 * np.cos(front), depth + l_3 * np.sin(front)


def diagonal_extremes(unit: PumpingUnit, rotator: RodRotator) -> tuple[Any, Any]:
    """Least and greatest distance from the pin to the hanger, m at the top and M at the bottom [m]."""
    ends = (unit.front_angle(psi) for psi in (unit.psi_top, unit.psi_bottom))
    top, bottom = (np.hypot(*diagonal(unit, rotator, end)) for end in ends)
    return top, bottom


def lengths(unit: PumpingUnit, rotator: RodRotator) -> Lengths:
    """Link and lever, given or made for the unit and the regime.

    Parameters
    ----------
    unit : PumpingUnit
        The unit.
    rotator : RodRotator
        The rotator.

    Returns
    -------
    Lengths
        l_4 and l_5 [m].
    """
    if rotator.link_length is not None:
        return Lengths(rotator.link_length, rotator.lever_length)
    m, M = diagonal_extremes(unit, rotator)
    if rotator.regime == "continuous":
        return Lengths(0.5 * (M + m), 0.5 * (M - m))
    return _rocking(m, M, _swing_on_diagonal(unit, rotator))


def _rocking(m: Any, M: Any, swing: Any) -> Lengths:
    """Lengths whose lever swings against the diagonal evenly about 90°."""
    lever = 0.5 * (M - m) / np.sin(0.5 * swing)
    return Lengths(np.sqrt(M * m + lever**2), lever)


def _swing_on_diagonal(unit: PumpingUnit, rotator: RodRotator) -> Any:
    """Swing against the diagonal for the wanted swing of the lever: the diagonal swings too.

    The lever swings from one end of the stroke to the other, but for small swings, where it turns back on
    the way: there the swing is corrected until it fits.
    """
    wanted = np.pi / 2 if rotator.swing is None else rotator.swing
    unit, rotator = _as_columns(unit), _as_columns(rotator)
    share = np.linspace(0.0, 1.0, _SAMPLES)
    bottom, top = (unit.front_angle(psi) for psi in (unit.psi_bottom, unit.psi_top))
    dx, dy = diagonal(unit, rotator, bottom + (top - bottom) * share)
    distance = np.hypot(dx, dy)
    # From the vertical toward the beam, the diagonal leans by atan(l_dx/l_dy); with the well to the right
    # that is counter-clockwise. Seen from there, the lever turns clockwise from the diagonal for a joint on
    # the left.
    is_left = (rotator.assembly == "left") != unit.is_mirrored
    lean = np.arctan2(dx, dy) * (1.0 if is_left else -1.0)
    goal = np.asarray(wanted)[..., None]
    swing = goal + lean[..., -1:] - lean[..., :1]
    for _ in range(_CORRECTIONS):
        known = _rocking(distance[..., -1:], distance[..., :1], swing)
        gamma = np.arccos((distance**2 + known.lever**2 - known.link**2) / (2 * distance * known.lever))
        miss = goal - _spread(lean - gamma)
        if np.abs(miss).max() < _CLOSE:
            break
        swing = swing + miss
    return swing[..., 0] if np.ndim(swing) > 1 else float(swing[0])


# Places over the stroke at which the lever's angle is looked at; a parabola between them errs by 1e-13.
_SAMPLES = 2001

# Corrections of a swing, each leaving a fraction of the last error, and the error that is rounding [rad].
_CORRECTIONS = 60
_CLOSE = 1e-14


def _as_columns(part: P) -> P:
    """The description with arrays over machines as columns, so that places over a stroke stand in rows."""
    arrays = {name: value[:, None] for name, value in part if isinstance(value, np.ndarray)}
    return part.with_entries(arrays) if arrays else part


def _spread(angle: Any) -> Any:
    """Greatest less least of each row of smooth values, an extreme between samples by the parabola there."""
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
