r"""Torque of the gearbox of a pumping unit: polished-rod load and counterbalance.

.. math::

    T(\theta) = \mathrm{TF}\,(W - B)\,\eta^{\mp 1} - M\sin(\theta + \tau)

with W the load of the polished rod, B the structural unbalance and M the maximum moment of cranks and
counterweights. An air cylinder of effect E at the polished rod takes the place of the moment:
:math:`T = \mathrm{TF}\,(W - B - E)\,\eta^{\mp 1}`. The efficiency η of the structure divides a torque that
resists and multiplies one that drives.

References
----------
.. [1] API Spec 11E, 17th ed. 1994, annexes on torque factors: net reducer torque.
.. [2] Takács, Sucker-Rod Pumping Handbook, 2015, 3.7 and 4.6: net torque, balance by equal peaks, cyclic
load factor.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import Annotated, Any

import numpy as np

from linkwright.kernel.arrays import Bools, Floats
from linkwright.kernel.errors import FindingError
from linkwright.kernel.numerics.tangent import on_lines, primal
from linkwright.kernel.numerics.turn_curve import TurnCurve
from linkwright.kernel.numerics.turn_fit import turn_curve
from linkwright.kernel.numerics.zeros import zero, zeros
from linkwright.kernel.quantities import Label
from linkwright.kernel.result import Result
from linkwright.pumping.model.polished_rod_load import PolishedRodLoad
from linkwright.pumping.model.unit import PumpingUnit

# Angles of the revolution at which the counterbalance of equal peaks is bracketed.
_ANGLES = 720

# Counterbalance beyond which none is looked for [N m or N].
_LARGEST = 1e15


@dataclass(frozen=True)
class GearTorque(Result):
    """Torque of the gearbox over one revolution."""

    crank_angle: Annotated[Floats, Label("crank angle", "φ", "rad", "0 to 2π by API.")]
    rod_load: Annotated[Floats, Label("load of the polished rod", "W", "N")]
    torque_rod: Annotated[Floats, Label("torque by the polished rod", "M_W", "N m", "At the crank.")]
    torque_counterbalance: Annotated[
        Floats, Label("torque by the counterbalance", "M_C", "N m", "At the crank, as it resists.")
    ]
    torque_net: Annotated[Floats, Label("torque of the gearbox", "M_G", "N m", "The sum of both.")]
    counterbalance: Annotated[
        float | None,
        Label(
            "maximum moment of the counterweights",
            "M",
            "N m",
            "With that of the cranks.",
            table="gear_torque",
        ),
    ]
    counterbalance_effect: Annotated[
        float | None,
        Label(
            "counterbalance effect",
            "E",
            "N",
            "At the polished rod: of the air cylinder, or of cranks and weights at a crank angle of 90°, "
            "with the structural unbalance; None where the rod does not rise there.",
            table="gear_torque",
        ),
    ]
    torque_net_up: Annotated[
        float, Label("maximum torque of the gearbox, upstroke", "M_G,up", "N m", table="gear_torque")
    ]
    torque_net_down: Annotated[
        float, Label("maximum torque of the gearbox, downstroke", "M_G,down", "N m", table="gear_torque")
    ]
    torque_net_min: Annotated[
        float,
        Label(
            "minimum torque of the gearbox",
            "M_G,min",
            "N m",
            "Below zero, the gears change flanks.",
            table="gear_torque",
        ),
    ]
    torque_net_mean: Annotated[
        float,
        Label("mean torque of the gearbox", "M_G,mean", "N m", "Over the crank angle.", table="gear_torque"),
    ]
    torque_net_rms: Annotated[
        float,
        Label(
            "root mean square torque of the gearbox",
            "M_G,rms",
            "N m",
            "Over the crank angle.",
            table="gear_torque",
        ),
    ]
    cyclic_load_factor: Annotated[
        float | None,
        Label(
            "cyclic load factor",
            "CLF",
            "",
            "Root mean square over mean; None where the mean is not positive.",
            table="gear_torque",
        ),
    ]
    torque_rated: Annotated[float | None, Label("rating of the gearbox by the designation", "", "N m")]
    load_max: Annotated[float, Label("maximum load of the polished rod", "W_max", "N", table="gear_torque")]
    load_rated: Annotated[float | None, Label("rating of the structure by the designation", "", "N")]
    load_permissible: Annotated[
        Floats | None,
        Label(
            "permissible load of the polished rod",
            "W_p",
            "N",
            "At which the gearbox has its rated torque: upper limit on the upstroke, lower limit on the "
            "downstroke; None without a rating.",
        ),
    ]
    work: Annotated[float, Label("work of the polished rod in a stroke", "A", "J", table="gear_torque")]

    @property
    def gear_load(self) -> Annotated[float | None, Label("maximum torque over the rating", "", "")]:
        """Maximum net torque over the rating of the gearbox."""
        peak = max(self.torque_net_up, self.torque_net_down)
        return None if self.torque_rated is None else peak / self.torque_rated


def effect_of_weights(unit: PumpingUnit, motion: Callable[[Floats], Any], moment: Any) -> Any:
    """Load of the polished rod that weights and structure balance with the crank at 90° [N]; None at rest.

    Takács, *Sucker-Rod Pumping Handbook*, 3.7: CBE = M sin(θ + τ)/TF + B at θ = 90°.
    """
    assert unit.load is not None
    factor = motion(np.array([0.5 * np.pi]))[1][0]
    if not primal(factor) > 0:
        return None
    return moment * np.cos(unit.load.phase) / factor + unit.structural_unbalance


@dataclass(frozen=True)
class StrokeLoad:
    """What acts on the crank at crank angles, and the counterbalance of size one."""

    unit: PumpingUnit
    load: Floats
    factor: Floats
    moment: Floats

    def rod(self, effect: float = 0.0) -> Floats:
        """Torque by the polished rod, less the effect of a cylinder."""
        resisting = self.factor * (self.load - self.unit.structural_unbalance - effect)
        return resisting * self._passed(resisting)

    def _passed(self, resisting: Floats) -> Floats:
        assert self.unit.load is not None
        efficiency = self.unit.load.efficiency
        passed: Floats = np.where(resisting > 0, 1 / efficiency, efficiency)
        return passed

    def net(self, size: float) -> Floats:
        """Net torque with a counterbalance of some size: a moment, or the effect of a cylinder."""
        if self.unit.geometry == "air_balanced":
            return self.rod(size)
        return self.rod() - size * self.moment

    def permissible(self, size: float, rated: float) -> Floats:
        """Loads at which the net torque is the rated one; infinite at the ends of the stroke.

        Takács, *Sucker-Rod Pumping Handbook*, 3.7: permissible load diagram, solved for the load.
        """
        is_air = self.unit.geometry == "air_balanced"
        resisting = rated + (0.0 if is_air else size) * self.moment
        with np.errstate(divide="ignore"):
            above = resisting / (self._passed(resisting) * self.factor)
        return self.unit.structural_unbalance + (size if is_air else 0.0) + above

    def net_slope(self, size: float) -> Floats:
        """Derivative of the net torque by the size of the counterbalance."""
        if self.unit.geometry != "air_balanced":
            return -self.moment
        resisting = self.factor * (self.load - self.unit.structural_unbalance - size)
        return -self.factor * self._passed(resisting)


def gear_torque(
    unit: PumpingUnit, motion: Callable[[Floats], Floats], ends: tuple[float, float], angles: Floats
) -> GearTorque:
    """Torque of the gearbox under the load of a unit.

    ``motion``: rise of the polished rod and its derivatives at crank angles, (3, n) [m]; ``ends``: crank
    angles at the bottom and at the top of the stroke [rad]; ``angles`` (n + 1,): crank angles of the curves
    [rad].
    """
    load = unit.load
    assert load is not None, "a unit with a load"
    is_air = unit.geometry == "air_balanced"
    given = load.counterbalance_effect if is_air else load.counterbalance
    strokes = Strokes(unit, load, motion, ends)
    size = float(given) if isinstance(given, int | float) else strokes.equal_peaks()
    up, down = strokes.curves(size)
    mean, _, work = (up.integral() + down.integral()) / (2 * np.pi)
    span = np.array([np.ptp(up.ends), np.ptp(down.ends)]) / (2 * np.pi)
    rms = float(np.sqrt(span @ [up.rms()[0] ** 2, down.rms()[0] ** 2]))
    shown, rating = stroke_load(unit, load, motion(angles), angles), unit.rating
    return GearTorque(
        crank_angle=angles,
        rod_load=shown.load,
        torque_rod=shown.rod(),
        torque_counterbalance=shown.net(size) - shown.rod(),
        torque_net=shown.net(size),
        counterbalance=None if is_air else size,
        counterbalance_effect=size if is_air else effect_of_weights(unit, motion, size),
        torque_net_up=up.extreme(+1)[0],
        torque_net_down=down.extreme(+1)[0],
        torque_net_min=min(up.extreme(-1)[0], down.extreme(-1)[0]),
        torque_net_mean=float(mean),
        torque_net_rms=rms,
        cyclic_load_factor=rms / float(mean) if mean > 0 else None,
        torque_rated=rating.torque if rating else None,
        load_max=max(up.extreme(+1, 1)[0], down.extreme(+1, 1)[0]),
        load_rated=rating.load if rating else None,
        load_permissible=shown.permissible(size, rating.torque) if rating else None,
        work=float(work) * 2 * np.pi,
    )


@dataclass(frozen=True)
class Strokes:
    """Upstroke and downstroke of a unit under its load."""

    unit: PumpingUnit
    load: PolishedRodLoad
    motion: Callable[[Floats], Floats]
    ends: tuple[float, float]

    def curves(self, size: float) -> tuple[TurnCurve, TurnCurve]:
        """Net torque, load, and torque factor times load over each stroke, with a counterbalance."""

        def of(angles: Floats) -> Floats:
            at = angles % (2 * np.pi)
            stroke = stroke_load(self.unit, self.load, self.motion(at), at)
            return np.stack([stroke.net(size), stroke.load, stroke.load * stroke.factor])

        up, down = self.spans
        return turn_curve(of, up, "torque of the gearbox"), turn_curve(of, down, "torque of the gearbox")

    @cached_property
    def spans(self) -> tuple[Floats, Floats]:
        """Crank angles of each stroke from end to end, with those between at which the load has a corner."""
        bottom = self.ends[0]
        top = bottom + (self.ends[1] - bottom) % (2 * np.pi)
        up, down = (
            np.unique([start, *self._corners(start, end), end])
            for start, end in ((bottom, top), (top, bottom + 2 * np.pi))
        )
        return up, down

    def _corners(self, start: float, end: float) -> Floats:
        if self.load.angle is not None:
            corners = start + (np.array(self.load.angle) - start) % (2 * np.pi)
            return corners[(corners > start) & (corners < end)]
        places = np.array([place for place in self.load.position or () if 0.0 < place < 1.0])

        def beyond(angles: Floats) -> Floats:
            return np.asarray(self.motion(angles % (2 * np.pi))[0] / self.unit.stroke - places)

        return zeros(beyond, np.full(len(places), start), np.full(len(places), end))[0]

    def equal_peaks(self) -> float:
        """The counterbalance with which both strokes have equal peaks: bracketed by samples, then exact.

        More counterbalance lowers the peak of the upstroke and raises that of the downstroke.
        """
        fine: Floats = np.linspace(0.0, 2 * np.pi, _ANGLES, endpoint=False)
        turn = stroke_load(self.unit, self.load, self.motion(fine), fine)
        is_up = (fine - self.ends[0]) % (2 * np.pi) <= (self.ends[1] - self.ends[0]) % (2 * np.pi)
        guess = equal_peaks(turn, is_up)

        def excess(size: Floats) -> Floats:
            up, down = self.curves(float(size[0]))
            return np.array([up.extreme(+1)[0] - down.extreme(+1)[0]])

        reach = np.array([1e-4 * (abs(guess) or 1.0)])
        while excess(guess - reach) <= 0 or excess(guess + reach) >= 0:
            reach *= 4.0
        return float(zeros(excess, guess - reach, guess + reach)[0][0])


def stroke_load(unit: PumpingUnit, load: PolishedRodLoad, motion: Floats, angles: Floats) -> StrokeLoad:
    """Load and torques at crank angles."""
    travel, factor, _ = motion
    force = _force(load, angles, travel / unit.stroke, factor)
    return StrokeLoad(unit, force, factor, np.sin(angles + load.phase))


def _force(load: PolishedRodLoad, angles: Floats, position: Floats, factor: Floats) -> Floats:
    if load.angle is not None:
        assert load.force is not None
        by_angle: Floats = on_lines(angles, load.angle, load.force, period=2 * np.pi)
        return by_angle
    assert load.position is not None
    assert load.up is not None
    assert load.down is not None
    up, down = (on_lines(position, load.position, values) for values in (load.up, load.down))
    by_place: Floats = np.where(factor >= 0, up, down)
    return by_place


def equal_peaks(turn: StrokeLoad, is_up: Bools) -> float:
    """The counterbalance of equal peaks by samples of both strokes; `is_up`: those of the upstroke."""

    def excess(size: float) -> float:
        net = turn.net(size)
        return float(net[is_up].max() - net[~is_up].max())

    reach = 1.0
    while excess(-reach) <= 0 or excess(reach) >= 0:
        reach *= 2.0
        if reach > _LARGEST:
            raise FindingError(
                "no counterbalance gives both strokes equal peaks of torque: with this phase of the "
                "counterweights (pumping_unit.load.phase) their moment does not fall in one stroke and rise "
                "in the other"
            )
    return zero(excess, -reach, reach)
