"""The numbers that explain a record best: where the search begins, and how noise is weighed."""

from __future__ import annotations

from typing import Any

import numpy as np

from linkwright.kernel.arrays import Floats
from linkwright.kernel.errors import ConvergenceError
from linkwright.studies.fit_parameters import numbers_of_record
from linkwright.studies.model import FitOptions
from linkwright.studies.plan import StudyPlan
from linkwright.studies.predicted import RecordModel
from linkwright.studies.record import MeasuredRecord

# Steps of differences as a share of the scale of a number.
STEP = 1e-4

# Crank angles that are tried for that of the first sample, how many of them the search begins from, and the
# shares of the misfit, and of the squares of the record, below which they do not differ.
_ANGLES, _VALLEYS, _SAME, _ROUNDED = 24, 3, 1e-9, 1e-16

# Rounds in which the noise of several channels is weighed, and the change that ends them.
_ROUNDS, _SETTLED = 30, 1e-4


def begun(plan: StudyPlan, record: MeasuredRecord) -> tuple[RecordModel, list[Floats]]:
    """The motion, and where the search begins: an unknown crank angle at the start has several valleys.

    It is left out where nothing depends on it.
    """
    options, own = numbers_of_record(plan, record, plan.study.fit or FitOptions())
    model = RecordModel(plan, record, options, own)
    x = np.array([number.start for number in model.numbers])
    model.require(x)
    place = next((i for i, number in enumerate(model.numbers) if number.name == "angle_start"), None)
    if place is None or "angle" in record.channels:
        return model, [x]
    points = np.tile(x, (_ANGLES, 1))
    points[:, place] = np.arange(_ANGLES) * 2 * np.pi / _ANGLES
    misfits = np.array([((model.require(point) - record.stacked) ** 2).sum() for point in points])
    if np.ptp(misfits) <= max(_SAME * misfits.max(), _ROUNDED * (record.stacked**2).sum()):
        own = tuple(number for number in own if number.name != "angle_start")
        options = options.model_copy(update={"angle_start": 0.0})
        return RecordModel(plan, record, options, own, model.count), [np.delete(x, place)]
    valleys = np.flatnonzero((misfits <= np.roll(misfits, 1)) & (misfits < np.roll(misfits, -1)))
    return model, list(points[valleys[np.argsort(misfits[valleys])][:_VALLEYS]])


def solved(model: RecordModel, starts: list[Floats]) -> tuple[Floats, Floats]:
    """Numbers, (numbers,), and noise of each channel, (channels,)."""
    measured = model.record.stacked.reshape(len(model.record.channels), -1)
    noise = np.maximum(measured.std(axis=1), 1e-12 * np.abs(measured).max(axis=1))
    noise[noise == 0] = 1.0
    tried = [_least_squares(model, start, noise) for start in starts]
    x = min(tried, key=lambda x: float((_left(model, x) ** 2).sum(axis=1) @ noise**-2))
    for _ in range(_ROUNDS if len(measured) > 1 else 0):
        left = np.sqrt((_left(model, x) ** 2).mean(axis=1))
        before, noise = noise, np.maximum(left, 1e-15 * np.abs(measured).max(axis=1))
        x = _least_squares(model, x, noise)
        if np.abs(noise / before - 1).max() < _SETTLED:
            break
    x = _within_revolution(model, x)
    freedom = measured.size - len(x)
    # Numbers take their freedom from all channels alike.
    return x, np.sqrt((_left(model, x) ** 2).sum(axis=1) / (measured.shape[1] * freedom / measured.size))


def _within_revolution(model: RecordModel, x: Floats) -> Floats:
    """The same with the crank angle at the start between 0 and 2π, unless angles were recorded."""
    is_free = [
        number.name == "angle_start" and "angle" not in model.record.channels for number in model.numbers
    ]
    return np.where(is_free, x % (2 * np.pi), x)


def _left(model: RecordModel, x: Floats) -> Floats:
    """Residuals, (channels, n)."""
    return (model.at(x) - model.record.stacked).reshape(len(model.record.channels), -1)


def _least_squares(model: RecordModel, x: Floats, noise: Floats) -> Floats:
    from scipy.optimize import least_squares

    numbers = model.numbers
    scale = np.array([number.scale for number in numbers])
    weight = 1 / np.repeat(noise, len(model.record.at))
    measured = model.record.stacked
    low, high = (np.array([getattr(number, end) for number in numbers]) / scale for end in ("low", "high"))

    def residuals(z: Floats) -> Floats:
        left: Floats = (model.at(z * scale) - measured) * weight
        return left

    def jacobian(z: Floats) -> Floats:
        slopes: Floats = model.jacobian(z * scale, STEP * scale) * weight[:, None] * scale
        return slopes

    # Changes that are lost in any interval: the sum of squares and the numbers, relative.
    options: Any = {"ftol": 1e-10, "xtol": 1e-9, "gtol": None, "max_nfev": 300, "x_scale": "jac"}
    # A number that changes nothing somewhere leaves a column of zeros, of which the method makes 0/0 inside.
    with np.errstate(invalid="ignore", divide="ignore"):
        solution = least_squares(
            residuals, np.clip(x / scale, low, high), jac=jacobian, bounds=(low, high), **options
        )
    if not (solution.success and np.isfinite(solution.x).all() and np.isfinite(solution.cost)):
        raise ConvergenceError(
            "the fit did not converge; start nearer to the solution, or fit fewer parameters",
            method="trust region",
            iterations=300,
        )
    at: Floats = solution.x * scale
    return at
