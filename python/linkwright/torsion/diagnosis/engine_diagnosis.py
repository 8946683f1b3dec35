r"""Which cylinder of an engine is weak: its factors by Gauss and Newton's method.

Harmonics of a speed depend on the factors x of the cylinders, y = f(x), nearly but not quite linearly: what
the loads take off, and the stiffness of couplings of a curve, are those of the mean torque that the weakened
engine gives. From a healthy engine on,

.. math:: x \leftarrow 1 + A^+ \left(y - f(x) + A\,(x - 1)\right), \qquad A = \partial f/\partial x

until x stays, so that operating point and diagnosis belong together. A at the end tells the uncertainty.

A coupling of a curve may pass a resonance as the mean torque changes: several x then fit better than all
beside them. At one mean torque the speed is linear in x. The best fit over the mean torque shows them all;
the method starts at each, and the best is taken.

A late or leaking cylinder changes its torque in a way that no factor describes, and the others would have to
answer for it. Where factors alone do not explain the measurement, the delay and the compression of every
cylinder are fitted too: the intervals are wider then, and right.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from linkwright.kernel.arrays import Floats, Indices
from linkwright.kernel.errors import ConvergenceError
from linkwright.kernel.numerics.confidence import chance_of_ratio
from linkwright.kernel.numerics.least_squares import Fit, least_squares, scaled
from linkwright.kernel.public import public
from linkwright.machine.machine import Machine
from linkwright.torsion.diagnosis.diagnosis import Diagnosis, diagnosed, equations, places
from linkwright.torsion.diagnosis.engine_speed import EngineSpeed
from linkwright.torsion.diagnosis.measured_speed import MeasuredSpeed

# Steps of the method: a few, and some dozens where curves of couplings bend at the operating point.
_ROUNDS = 60
# Factors have settled when they change by less than this, or than this share of their deviation.
_SETTLED, _SETTLED_SHARE = 1e-9, 1e-4
# Chance of what is explained beyond factors, below which cylinders are late or leak. Where it is none, the
# intervals become wider for nothing, but stay right.
_CHANCE = 0.01
# Share of the combustion below which it has no time of its own.
_HARDLY = 0.2
# Share of a measurement that is rounding.
_EXACT = 1e-9
# Mean factors at which the best fit is looked at first; couplings bend over some tenths of them.
_LOADS = np.linspace(0.0, 2.0, 201)
# States at a time: enough for lanes, and little memory.
_STATES = 256
# A step that fits worse by more than this share is halved, at most so often: near the best fit, what is left
# over says nothing more of the step.
_WORSE, _HALVINGS = 1e-6, 10


@public
def engine_diagnosis(
    machine: Machine, measured: MeasuredSpeed, speed: float, *, rigid: bool = False
) -> Diagnosis:
    """Which cylinder of an engine is weak, from the speed measured at a disc.

    Parameters
    ----------
    machine : Machine
        With a [train.engine]; cylinders that its file calls weak are taken as healthy.
    measured : MeasuredSpeed
        At one of its discs, at orders of its torques.
    speed : float
        Mean speed of the crank in the measurement [rad/s].
    rigid : bool
        Whether the train is taken as rigid, to see what that costs.

    Returns
    -------
    Diagnosis
        Factors of the combustion, by number of the cylinder. The gas of the file is that of the load at which
        was measured; at another load `Diagnosis.relative` tells cylinders apart.

    Raises
    ------
    InputError
        The machine has no engine, or the measurement does not fit its train.
    ConvergenceError
        No factors belong to their own operating point.
    """
    return fitted(EngineSpeed(machine, speed, measured.disc, rigid=rigid), measured)


def fitted(model: EngineSpeed, measured: MeasuredSpeed) -> Diagnosis:
    """Factors whose speed is closest to a measured one."""
    names = tuple(str(n + 1) for n in range(model.engine.n_cylinders))
    healthy = np.zeros(len(names))
    if model.rigid:
        # What neglecting torsion costs: its factors are no engine that would have an operating point.
        return diagnosed(*_linear_fit(model, measured, healthy), names, measured)
    tried = [_settled(model, measured, start) for start in _starts(model, measured)]
    values, is_settled = min(tried, key=lambda fit: _squares(model, measured, fit[0][:, None])[0])
    fit, A = _linear_fit(model, measured, values)
    warnings = []
    if (start := _wider(model, measured, values, fit)) is not None:
        wider, explains = _settled(model, measured, start)
        if explains:
            is_settled = True
            fit, A = _linear_fit(model, measured, wider)
        else:
            warnings.append(
                "factors do not explain the measurement, and delay and compression do not converge"
            )
    if not is_settled:
        raise ConvergenceError(_unsettled(values, fit.values), method="Gauss-Newton", iterations=_ROUNDS)
    diagnosis = diagnosed(fit, A, names, measured)
    if diagnosis.is_refuted:
        # Noise is what neither the train nor its cylinders explain.
        spread = diagnosed(scaled(fit, fit.misfit), A, names, measured)
        diagnosis = replace(diagnosis, deviation=spread.deviation, covariance=spread.covariance)
        if diagnosis.delay is not None:
            deviations = (spread.delay_deviation, spread.compression_deviation)
            diagnosis = replace(diagnosis, delay_deviation=deviations[0], compression_deviation=deviations[1])
        warnings.append("intervals treat the residual as noise")
    return replace(diagnosis, warnings=(*diagnosis.warnings, *warnings))


def _starts(model: EngineSpeed, measured: MeasuredSpeed) -> list[Floats]:
    """First values: the healthy ones, or the best at each mean torque that fits better than those beside."""
    n = model.engine.n_cylinders
    if not model.bends:
        return [np.zeros(n)]
    # At a mean factor: all cylinders alike, then each in turn stronger at the expense of all.
    beside = np.column_stack([np.zeros(n), np.eye(n) - 1 / n])
    parts = np.array_split(_LOADS, -(-beside.shape[1] * len(_LOADS) // _STATES))
    fits = [fit for loads in parts for fit in _fits_at_loads(model, measured, loads, beside)]
    left = np.array([np.inf, *(left for _, left in fits), np.inf])
    lowest = np.flatnonzero((left[1:-1] <= left[:-2]) & (left[1:-1] <= left[2:]))
    return [fits[k][0] for k in lowest]


def _fits_at_loads(
    model: EngineSpeed, measured: MeasuredSpeed, loads: Floats, beside: Floats
) -> Iterator[tuple[Floats, float]]:
    """Values that fit best at some mean factors, and the squares left; `beside`: states less their mean."""
    states = (loads[:, None, None] - 1) + beside
    rows = _left(model, measured, np.concatenate(list(states), axis=1))
    for state, own in zip(states, rows.reshape(len(loads), beside.shape[1], -1), strict=True):
        A = (own[0] - own[1:]).T
        fit = least_squares(A, own[0], is_known=True)
        left = own[0] - A @ fit.values
        yield state[:, 0] + (state[:, 1:] - state[:, :1]) @ fit.values, float(left @ left)


def _left(model: EngineSpeed, measured: MeasuredSpeed, states: Floats) -> Floats:
    """What some states leave over of a measurement, (states, equations)."""
    orders, speed = model.harmonics(states)
    return equations(measured.harmonics - speed[:, places(orders, measured)], measured)


def _squares(model: EngineSpeed, measured: MeasuredSpeed, states: Floats) -> Floats:
    """Sum of squares of what some states leave over, (states,)."""
    squares: Floats = (_left(model, measured, states) ** 2).sum(axis=1)
    return squares


def _unsettled(values: Floats, asked: Floats) -> str:
    """One sentence on factors that do not belong to their own operating point."""
    worst = int(np.argmax(np.abs(asked - values)))
    return (
        f"the factors do not converge: that of cylinder {worst + 1} goes from {1 + values[worst]:.4g} to "
        f"{1 + asked[worst]:.4g} and back, as the stiffness of couplings follows the mean torque; look at "
        "[train.couplings] there, or take the coupling as linear"
    )


def _settled(model: EngineSpeed, measured: MeasuredSpeed, values: Floats) -> tuple[Floats, bool]:
    """Values that fit best at their own operating point, from first ones on, and whether they settled."""
    for _ in range(_ROUNDS):
        fit, _ = _linear_fit(model, measured, values)
        step = fit.values - values
        if (np.abs(step) <= np.maximum(_SETTLED, _SETTLED_SHARE * fit.deviation)).all():
            return values, True
        values = values + _share(model, measured, values, step) * step
    return values, False


def _linear_fit(model: EngineSpeed, measured: MeasuredSpeed, values: Floats) -> tuple[Fit, Floats]:
    """The fit about some values, and its equations."""
    orders, here, slopes = model.about(values)
    at = places(orders, measured)
    A = equations(slopes[:, at], measured).T
    A[:, _without_delay(values, model.engine.n_cylinders)] = 0.0
    left = equations(measured.harmonics - here[at], measured)
    return least_squares(A, left + A @ values, is_known=measured.noise is not None), A


def _without_delay(values: Floats, n: int) -> Indices:
    """Delays of cylinders that hardly burn, which mean nothing and stay as they are."""
    return n + np.flatnonzero(values[:n] < _HARDLY - 1) if len(values) > n else np.empty(0, np.intp)


def _wider(model: EngineSpeed, measured: MeasuredSpeed, values: Floats, factors: Fit) -> Floats | None:
    """First values with delay and compression of each cylinder, if factors do not explain the measurement."""
    # By the ratio of variances: what each added value explains, over the noise.
    others = np.zeros(2 * len(values))
    start = np.concatenate([values, others])
    is_known = measured.noise is not None
    if 2 * len(measured.orders) <= len(start) or factors.misfit <= _EXACT * _size(measured):
        return None
    fit, _ = _linear_fit(model, measured, start)
    if fit.is_open[: len(values)].any():
        return None
    explained = factors.misfit**2 * factors.freedom - fit.misfit**2 * fit.freedom
    ratio = explained / len(others) / (1.0 if is_known else fit.misfit**2)
    if chance_of_ratio(ratio, len(others), None if is_known else fit.freedom) > _CHANCE:
        return None
    return start


def _size(measured: MeasuredSpeed) -> float:
    """Root mean square of a measurement over its noise."""
    return float(np.sqrt((equations(measured.harmonics, measured) ** 2).mean()))


def _share(model: EngineSpeed, measured: MeasuredSpeed, values: Floats, step: Floats) -> float:
    """Share of a step, halved until the speed fits no worse than before."""
    shares = 0.5 ** np.arange(_HALVINGS)
    size = _squares(model, measured, values[:, None] + step[:, None] * np.append(0.0, shares))
    fits = np.flatnonzero(size[1:] <= size[0] * (1 + _WORSE))
    return float(shares[fits[0] if len(fits) else -1])
