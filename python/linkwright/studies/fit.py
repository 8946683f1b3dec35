r"""Numbers of a machine from a measured record, by least squares.

.. math:: \min_x \sum_k \sum_i \Bigl(\frac{y_{ki} - f_k(x, t_i)}{s_k}\Bigr)^2, \qquad
    \mathrm{cov}\,\hat x = (J^T J)^{-1}

with the noise s of each channel k from what is left over, and the derivatives J over it. Intervals are those
of Student's distribution in the linear approximation [1]_; how far the record departs from that at their ends
is measured, as the sum of squares there.

References
----------
.. [1] Seber and Wild, Nonlinear Regression, 1989, section 5.1; Branch, Coleman, Li, A subspace, interior, and
   conjugate gradient method for large-scale bound-constrained minimization problems, SIAM J. Sci. Comput. 21
   (1999) 1: the method of SciPy.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Annotated, Any

import numpy as np

from linkwright.kernel.arrays import Floats
from linkwright.kernel.errors import InputError
from linkwright.kernel.numerics.confidence import coverage_factor
from linkwright.kernel.public import public
from linkwright.kernel.quantities import About, Label
from linkwright.kernel.result import Result
from linkwright.machine.machine import Machine
from linkwright.studies.fit_parameters import Number
from linkwright.studies.fit_search import STEP, begun, solved
from linkwright.studies.identifiability import Direction, covariance, singular_directions
from linkwright.studies.plan import StudyPlan, require_variables
from linkwright.studies.predicted import RecordModel
from linkwright.studies.record import MeasuredRecord

# Singular values below this share of the largest are rounding of the motion.
_ROUNDING = 1e-8

# A number this near to its limit, as a share of its scale, is at it.
_AT_LIMIT = 1e-6

# Standard errors beyond which residuals are taken as correlated, and share by which the sum of squares at the
# end of an interval may differ from the linear one.
_CORRELATED, _CURVED = 4.0, 0.3


@dataclass(frozen=True)
class Fit(Result):
    """Numbers that explain a record best."""

    machine: Annotated[Machine, About("The machine with its numbers exchanged.")]
    record: Annotated[MeasuredRecord, About("What was measured.")]
    predicted: Annotated[dict[str, Any], About("Channel → what the machine would have recorded, (n,) [SI].")]
    values: Annotated[dict[str, float], About("Number → its value [SI].")]
    units: Annotated[dict[str, str], About("Number → its unit.")]
    deviations: Annotated[
        dict[str, float],
        About(
            "Number → its standard deviation [SI]; infinite where the record does not determine it, NaN at a "
            "limit."
        ),
    ]
    intervals: Annotated[
        dict[str, tuple[float, float]], About("Number → its confidence interval [SI], likewise.")
    ]
    level: Annotated[float, Label("confidence level", "", "")]
    correlations: Annotated[dict[str, dict[str, float]], About("Number → its correlation with each number.")]
    noise: Annotated[dict[str, float], About("Channel → standard deviation of what is left over [SI].")]
    directions: Annotated[
        tuple[Direction, ...], About("Combinations of numbers, from the one that is known worst.")
    ]
    at_limits: Annotated[tuple[str, ...], About("Numbers that are at the end of their range.")]
    warnings: Annotated[tuple[str, ...], About("Reasons why intervals may be wrong, in sentences.")]
    jacobian_error: Annotated[
        float, Label("error of the derivatives", "", "", "Relative, as measured; 0 for exact ones.")
    ]
    freedom: Annotated[int, Label("degrees of freedom", "ν", "")]
    n_evaluations: Annotated[int, Label("motions that were computed", "", "")]
    reasons: Annotated[dict[str, int], About("Reasons for trials without a result → number of trials.")]

    @property
    def is_determined(self) -> Annotated[bool, About("Whether the record determines all parameters.")]:
        """Whether the record determines all parameters."""
        return all(direction.is_determined for direction in self.directions)

    def to_dict(self, *, curves: bool = False) -> dict[str, Any]:
        """Numbers by name, ready for JSON; with `curves` the record and what the machine has instead."""
        names = ("values", "units", "deviations", "intervals", "correlations", "noise", "reasons")
        results = {**super().to_dict(), **{name: dict(getattr(self, name)) for name in names}}
        results["directions"] = [
            {
                "parts": direction.parts,
                "deviation": direction.deviation,
                "effect": direction.effect,
                "words": direction.words,
            }
            for direction in self.directions
        ]
        results["is_determined"] = self.is_determined
        if curves:
            record = {self.record.over: self.record.at, **self.record.channels}
            results["record"] = {name: np.asarray(column).tolist() for name, column in record.items()}
            results["predicted"] = {name: column.tolist() for name, column in self.predicted.items()}
        return results


@public
def fit(plan: StudyPlan, record: MeasuredRecord, *, level: float = 0.95) -> Fit:
    """Fit parameters of a machine to a measured record.

    Parameters
    ----------
    plan : StudyPlan
        A study whose variables are sought, within their ranges, and whose table ``fit`` says of which motion
        the record is.
    record : MeasuredRecord
        What was measured, from `read_record`.
    level : float
        Probability that an interval holds the truth, between 0 and 1.

    Returns
    -------
    Fit
        Values, intervals, and what the record does not tell.

    Raises
    ------
    InputError
        A variable is a list or scatters; the record does not fit the motion, or has too few samples.
    FindingError
        The machine of the study cannot do the motion.
    ConvergenceError
        The search does not end.

    Notes
    -----
    The noise is taken as normal, independent from sample to sample, and of one size in each channel.
    Correlated residuals give a warning: then the machine lacks something, or the record was filtered, and
    intervals are too narrow.
    """
    require_variables(plan)
    model, starts = begun(plan, record)
    if record.size <= len(model.numbers):
        raise InputError(
            f"record: found {record.size} values, expected more than the {len(model.numbers)} numbers"
        )
    x, noise = solved(model, starts)
    return _FitJudgement(model, x, noise, level).fit()


def _rescaled(number: Number, value: float) -> Number:
    """A number from the value that was found on: what was measured by its own size still is."""
    is_own = number.scale == abs(number.start) and value != 0
    return replace(number, start=value, scale=abs(value) if is_own else number.scale)


class _FitJudgement:
    """What is known of numbers that were found."""

    def __init__(self, model: RecordModel, x: Floats, noise: Floats, level: float) -> None:
        self.model, self.x, self.noise, self.level = model, x, noise, level
        self.numbers = tuple(map(_rescaled, model.numbers, x.tolist()))
        self.scale = np.array([number.scale for number in self.numbers])
        self.weight = 1 / np.repeat(np.where(noise > 0, noise, 1.0), len(model.record.at))
        slopes, self.error = model.slopes(x, STEP * self.scale)
        self.J = slopes * self.weight[:, None] * self.scale
        self.inner = [
            i for i, number in enumerate(self.numbers) if not self._is_at_limit(i, number.low, number.high)
        ]
        self.freedom = model.record.size - len(x)
        self.factor = coverage_factor(level, self.freedom)
        self.rounding = max(_ROUNDING, self.error)
        self.cov = np.full((len(x), len(x)), np.nan)
        if self.inner:
            self.cov[np.ix_(self.inner, self.inner)] = covariance(self.J[:, self.inner], self.rounding)

    def _is_at_limit(self, i: int, low: float, high: float) -> bool:
        return bool(min(self.x[i] - low, high - self.x[i]) <= _AT_LIMIT * self.scale[i])

    def fit(self) -> Fit:
        model, names = self.model, [number.name for number in self.numbers]
        deviation = np.sqrt(np.diag(self.cov))
        half = self.factor * deviation * self.scale
        limits = tuple(name for i, name in enumerate(names) if i not in self.inner)
        curves = model.at(self.x).reshape(len(model.record.channels), -1)
        with np.errstate(invalid="ignore"):
            correlation = self.cov / np.outer(deviation, deviation)
        inner = [self.numbers[i] for i in self.inner]
        return Fit(
            machine=model.machine(self.x),
            record=model.record,
            predicted=dict(zip(model.record.channels, curves, strict=True)),
            values=dict(zip(names, self.x.tolist(), strict=True)),
            units={number.name: number.unit for number in self.numbers},
            deviations=dict(zip(names, (deviation * self.scale).tolist(), strict=True)),
            intervals={
                name: (float(x - h), float(x + h)) for name, x, h in zip(names, self.x, half, strict=True)
            },
            level=self.level,
            correlations={
                name: dict(zip(names, row.tolist(), strict=True))
                for name, row in zip(names, correlation, strict=True)
            },
            noise=dict(zip(model.record.channels, self.noise.tolist(), strict=True)),
            directions=singular_directions(self.J[:, self.inner], inner, self.rounding) if inner else (),
            at_limits=limits,
            warnings=(*self._limit_warnings(limits), *self._correlated(curves), *self._curved(names)),
            jacobian_error=self.error,
            freedom=self.freedom,
            n_evaluations=model.count,
            reasons=dict(model.reasons),
        )

    def _limit_warnings(self, limits: tuple[str, ...]) -> list[str]:
        return [
            f"{name} is at the end of its range: it has no interval, and the others hold for this value"
            for name in limits
        ]

    def _correlated(self, curves: Floats) -> list[str]:
        sentences = []
        for (name, measured), curve in zip(self.model.record.channels.items(), curves, strict=True):
            left = measured - curve
            if not left.any():
                continue
            share = float((left[1:] * left[:-1]).sum() / (left**2).sum())
            if abs(share) > _CORRELATED / np.sqrt(len(left)):
                sentences.append(
                    f"residuals of {name} are correlated ({share:.2f} from sample to sample): the machine "
                    "lacks something, or the record was filtered; intervals are too narrow"
                )
        return sentences

    def _curved(self, names: list[str]) -> list[str]:
        """Numbers at whose intervals' ends the sum of squares departs from its linear approximation."""
        sentences = []
        measured = self.model.record.stacked
        least = (((self.model.at(self.x) - measured) * self.weight) ** 2).sum()
        for i in self.inner:
            column = self.cov[:, i]
            if not np.isfinite(column[self.inner]).all():
                continue
            way = np.where(np.isfinite(column), column, 0.0) / np.sqrt(column[i]) * self.factor
            for sign in (-1, 1):
                there = self.model.at(self.x + sign * way * self.scale)
                rise = ((((there - measured) * self.weight) ** 2).sum() - least) / self.factor**2
                if not abs(rise - 1) <= _CURVED:
                    end = "upper" if sign > 0 else "lower"
                    words = f"{rise:.2f} times" if np.isfinite(rise) else "without a result instead of"
                    sentences.append(
                        f"at the {end} end of the interval of {names[i]} the sum of squares rises {words} "
                        "what the linear approximation has: the interval is rough"
                    )
        return sentences
