r"""Speeds barred from continuous operation of shafts: barred, and passed quickly, or not to be passed at all.

A range is barred where a shaft's vibratory stress is above what is permitted in continuous operation. Its
bounds are where the two are equal, sought with the response itself. About a critical speed :math:`n_c`
classification societies ask for at least :math:`16 n_c/(18 - \lambda) \le n \le (18 - \lambda) n_c/16`, λ
being its ratio to the speed of service. Critical is where the stress peaks: damping, dampers above all, has
it beside the speed at which an order meets a natural frequency without damping. Where the stress is also
above what is permitted in transient passage, the range may not even be passed.

References
----------
.. [1] IACS, UR M68, 2021, M68.5: barred speed ranges. The tolerance of the tachometer comes on top.
.. [2] Korean Register, Rules for the Classification of Steel Ships, part 5, chapter 4, 206.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Annotated

import numpy as np

from linkwright.kernel.arrays import Bools, Floats
from linkwright.kernel.public import public
from linkwright.kernel.quantities import About, Label
from linkwright.kernel.result import Result
from linkwright.machine.machine import Machine
from linkwright.torsion.limits.criteria import (
    PASSING_STRESS,
    VIBRATORY_STRESS,
    Criterion,
    Exceedance,
    peaks_on,
)
from linkwright.torsion.limits.survey import Survey, survey
from linkwright.torsion.model.permitted_stress import barred_speeds

# Even speeds at which a range is examined for the peaks in it.
_POINTS = 100


_NOT_PASSABLE = (
    "Lowest and highest speed of each part in which the stress is above what is permitted in transient "
    "passage [rad/s]."
)


@dataclass(frozen=True)
class BarredRange(Result):
    """Speeds at which a shaft is stressed more than is permitted in continuous operation.

    Stresses are infinite at a resonance without any damping; what nothing is said of is NaN.
    """

    shaft: Annotated[str, About("The shaft.")]
    speed_min: Annotated[
        float,
        Label(
            "lower end of the barred range",
            "ω_min",
            "rad/s",
            "Above what is permitted in continuous operation.",
        ),
    ]
    speed_max: Annotated[
        float,
        Label(
            "upper end of the barred range",
            "ω_max",
            "rad/s",
            "Above what is permitted in continuous operation.",
        ),
    ]
    open_min: Annotated[bool, About("Whether the range continues below the speeds analysed.")]
    open_max: Annotated[bool, About("Whether the range continues above the speeds analysed.")]
    worst_speed: Annotated[
        float, Label("speed at which stress over permitted stress is largest", "", "rad/s")
    ]
    worst_stress: Annotated[float, Label("vibratory stress at that speed", "τ", "Pa")]
    continuous: Annotated[
        float, Label("stress permitted there in continuous operation", "τ_C", "Pa", "NaN if nothing is said.")
    ]
    transient: Annotated[
        float | None,
        Label("stress permitted there in transient passage", "τ_T", "Pa", "NaN if nothing is said."),
    ]
    not_passable: Annotated[tuple[tuple[float, float], ...], About(_NOT_PASSABLE)]
    critical_speed: Annotated[
        float | None,
        Label(
            "critical speed of the highest peak in the range",
            "",
            "rad/s",
            "None where the stress peaks beyond the speeds looked at.",
        ),
    ]
    order: Annotated[
        float | None,
        Label(
            "order that makes most of that peak",
            "ν",
            "",
            "None where the stress peaks beyond the speeds looked at.",
        ),
    ]
    class_min: Annotated[
        float | None,
        Label(
            "minimum speed that is barred by the societies' formula",
            "",
            "rad/s",
            "About all peaks in the range.",
        ),
    ]
    class_max: Annotated[
        float | None,
        Label(
            "maximum speed that is barred by the societies' formula",
            "",
            "rad/s",
            "About all peaks in the range.",
        ),
    ]
    service_speed: Annotated[float, Label("service speed", "", "rad/s", "That λ = 1 stands for.")]
    ratio_permitted: Annotated[
        float | None,
        Label("maximum speed ratio that the rule permits to be barred", "λ", "", "None without a rule."),
    ]

    @property
    def is_passable(self) -> bool | None:
        """Whether it may be passed quickly; None if the limit does not say."""
        if self.not_passable:
            return False
        return None if self.transient is None else True

    @property
    def may_be_barred(self) -> bool:
        """Whether it lies where speeds may be barred in normal operation."""
        highest = self.ratio_permitted
        return highest is None or self.barred[1] <= highest * self.service_speed

    @property
    def barred(self) -> tuple[float, float]:
        """Barred speed ranges: those of too much stress, and those of the formula [rad/s]."""
        low = self.speed_min if self.class_min is None else min(self.speed_min, self.class_min)
        high = self.speed_max if self.class_max is None else max(self.speed_max, self.class_max)
        return low, high


@public
def barred_ranges(machine: Machine) -> tuple[BarredRange, ...]:
    """Speeds barred from continuous operation of the shafts of a train.

    Parameters
    ----------
    machine : Machine
        With a train that something excites, speeds at which to look, and limits of shafts.

    Returns
    -------
    tuple of BarredRange
        By shaft, then by speed. Looked at are the speeds of the run and all resonances between them.

    Raises
    ------
    InputError
        Nothing excites the train, or it has no speeds.

    References
    ----------
    .. [1] IACS, UR M68, 2021, M68.5.
    """
    return surveyed_ranges(survey(machine))


def surveyed_ranges(seen: Survey) -> tuple[BarredRange, ...]:
    """Barred ranges of a train that has been examined."""
    rows = [(criterion.part, criterion.what) for criterion in seen.criteria]
    above = [exceedance for exceedance in seen.exceeded if rows[exceedance.row][1] == VIBRATORY_STRESS]
    if not above:
        return ()
    worst = seen.criteria_at(np.array([exceedance.peak for exceedance in above]))
    peaks = _peaks(seen, above)
    ranges = []
    for column, exceedance in enumerate(above):
        row = rows.index((rows[exceedance.row][0], PASSING_STRESS))
        passing = [other for other in seen.exceeded if other.row == row]
        ranges.append(
            _range(seen, exceedance, column, (worst[exceedance.row], worst[row]), passing, peaks[column])
        )
    return tuple(ranges)


def together(ranges: Iterable[BarredRange]) -> list[tuple[float, float]]:
    """Barred speed ranges of all shafts, merged where they meet: lowest and highest speed [rad/s]."""
    return joined_ranges(span.barred for span in ranges)


def joined_ranges(ranges: Iterable[tuple[float, float]]) -> list[tuple[float, float]]:
    """Ranges by their lower end, those that meet taken as one. In the unit of the ranges."""
    joined: list[tuple[float, float]] = []
    for low, high in sorted(ranges):
        if joined and low <= joined[-1][1]:
            joined[-1] = (joined[-1][0], max(joined[-1][1], high))
        else:
            joined.append((low, high))
    return joined


def not_barred(speeds: Floats, ranges: list[tuple[float, float]]) -> Bools:
    """Which speeds lie in no barred range, (n,). All where all would be barred."""
    kept = np.ones(len(speeds), bool)
    for low, high in joined_ranges(ranges):
        kept &= (speeds < low) | (speeds > high)
    return kept if kept.any() else ~kept


def _range(
    seen: Survey,
    above: Exceedance,
    column: int,
    worst: tuple[Criterion, Criterion],
    passing: list[Exceedance],
    peaks: list[float],
) -> BarredRange:
    for_ever, transient = worst
    critical, order = _critical(seen, above.row, peaks)
    formula = [barred_speeds(peak, seen.service) for peak in peaks]
    limit = seen.at.train.shafts[for_ever.part].limit
    return BarredRange(
        shaft=for_ever.part,
        speed_min=above.low,
        speed_max=above.high,
        open_min=above.open_low,
        open_max=above.open_high,
        worst_speed=above.peak,
        worst_stress=float(for_ever.found[column]),
        continuous=float(for_ever.permitted[column]),
        transient=None if np.isnan(transient.permitted[column]) else float(transient.permitted[column]),
        not_passable=tuple(
            (max(exceedance.low, above.low), min(exceedance.high, above.high))
            for exceedance in passing
            if exceedance.low < above.high and exceedance.high > above.low
        ),
        critical_speed=critical,
        order=order,
        class_min=min((low for low, _ in formula), default=None),
        class_max=max((high for _, high in formula), default=None),
        service_speed=seen.service,
        ratio_permitted=None if limit is None else limit.barred_ratio_max,
    )


def _peaks(seen: Survey, above: list[Exceedance]) -> list[list[float]]:
    """Speeds at which the stress peaks in each range, not those of its ratio to a falling limit."""

    def sizes(at: Floats) -> Floats:
        return np.array([_size(criterion) for criterion in seen.criteria_at(at)])

    return peaks_on(sizes, [(exceedance.row, _grid(seen, exceedance)) for exceedance in above])


def _grid(seen: Survey, exceedance: Exceedance) -> Floats:
    """Speeds of a range close enough to show its peaks, those of resonances among them."""
    inside = seen.speeds[(seen.speeds > exceedance.low) & (seen.speeds < exceedance.high)]
    return np.unique(np.concatenate([np.linspace(exceedance.low, exceedance.high, _POINTS), inside]))


def _size(criterion: Criterion) -> Floats:
    """The value found; infinite at an undamped resonance."""
    return np.where(np.isfinite(criterion.found), criterion.found, np.inf)


def _critical(seen: Survey, row: int, peaks: list[float]) -> tuple[float | None, float | None]:
    """Highest peak in a range, with its dominant order; None without a peak."""
    if not peaks:
        return None, None
    at = np.array(peaks)
    highest = int(np.argmax(_size(seen.criteria_at(at)[row])))
    carried = seen.carried_at(at[[highest]])
    torque = np.abs(carried.shaft_torques[:, carried.shafts.index(seen.criteria[row].part), 0])
    # A resonance without damping is infinite, and the largest.
    order = carried.orders[int(np.argmax(np.nan_to_num(torque, nan=np.inf)))]
    return peaks[highest], float(order)
