r"""Which cylinder of an engine is weak: its factors by Gauss and Newton's method.

Harmonics of a speed depend on the factors x of the cylinders, y = f(x), nearly but not quite linearly: what
the loads take off, and the stiffness of couplings of a curve, are those of the mean torque that the weakened
engine gives. From a healthy engine on,

.. math:: x \leftarrow 1 + A^+ \left(y - f(x) + A\,(x - 1)\right), \qquad A = \partial f/\partial x

until x stays, so that operating point and diagnosis belong together. A at the end tells the uncertainty.

A coupling of a curve may pass a resonance as the mean torque changes: several x then fit better than all
beside them. At one mean torque the speed is linear in x. The best fit over the mean torque shows them all;
the method starts at each, and the best is taken.

A late, early or leaking cylinder changes its torque in a way that no factor describes, and the factors would
have to answer for it, by many of their deviations before what is left over shows it. Delay and compression of
every cylinder are therefore fitted too, wherever the measured orders tell them: the intervals are wider than
those of factors alone, and right.

High orders turn by several radians where combustion is late, so that steps from a cylinder in time on go
astray. The method begins with the lowest orders and takes in more and more, held by what engines do.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from linkwright.kernel.arrays import Floats
from linkwright.kernel.errors import ConvergenceError
from linkwright.kernel.numerics.least_squares import least_squares, scaled
from linkwright.kernel.public import public
from linkwright.machine.machine import Machine
from linkwright.torsion.diagnosis.diagnosis import Diagnosis, diagnosed
from linkwright.torsion.diagnosis.engine_fit import ROUNDS, EngineFit
from linkwright.torsion.diagnosis.engine_speed import EngineSpeed
from linkwright.torsion.diagnosis.measured_speed import MeasuredSpeed

# Mean factors at which the best fit is examined first; couplings bend over some tenths of them.
_LOADS = np.linspace(0.0, 2.0, 201)
# States at a time: enough for lanes, and little memory.
_STATES = 256
# Shares of the highest order up to which the method begins, and its steps there.
_BEGINNINGS, _FIRST_STEPS = (1 / 8, 1 / 4, 1 / 2), 4
# How far combustion, delay [rad] and compression of a cylinder usually are off, over the share of a
# measurement that stands against it: enough to keep what few orders cannot tell where it is.
_LIKELY = np.array([0.5, 0.15, 0.2]) / 0.05
# First values that differ by less lead to the same.
_SAME = 1e-3


@public
def engine_diagnosis(
    machine: Machine, measured: MeasuredSpeed, speed: float, *, rigid: bool = False
) -> Diagnosis:
    """Identify weak cylinders of an engine from the measured speed of a disc.

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
    """Values of the cylinders whose speed is closest to a measured one."""
    names = tuple(str(n + 1) for n in range(model.engine.n_cylinders))
    healthy, best = np.zeros(len(names)), EngineFit(model, measured)
    if model.rigid:
        # What neglecting torsion costs: its factors are no engine that would have an operating point.
        return diagnosed(*best.about(healthy), names, measured)
    starts, warnings = _starts(best), []
    if _tells_all(best):
        values, is_settled = _closest(best, _apart([_begun(best, factors) for factors in starts]))
        if not is_settled:
            warnings.append("delay and compression do not converge, and factors alone do not explain all")
    else:
        is_settled = False
        warnings.append(_taken_as_tight(measured, len(names)))
    if not is_settled:
        values, is_settled = _closest(best, starts)
    fit, A = best.about(values)
    if not is_settled:
        raise ConvergenceError(
            _unsettled(values, fit.values, len(names)), method="Gauss-Newton", iterations=ROUNDS
        )
    fit = best.widened(values, fit)
    diagnosis = diagnosed(fit, A, names, measured)
    if diagnosis.is_refuted:
        # Noise is what neither the train nor its cylinders explain.
        spread = diagnosed(scaled(fit, fit.misfit), A, names, measured)
        diagnosis = replace(
            diagnosis,
            deviation=spread.deviation,
            covariance=spread.covariance,
            delay_deviation=spread.delay_deviation,
            compression_deviation=spread.compression_deviation,
        )
        warnings.append("intervals treat the residual as noise")
    return replace(diagnosis, warnings=(*diagnosis.warnings, *warnings))


def _closest(best: EngineFit, starts: list[Floats]) -> tuple[Floats, bool]:
    """Best fit from several starting values, and whether it converged."""
    tried = [best.settled(start) for start in starts]
    return min(tried, key=lambda fit: float(best.squares(fit[0][:, None])[0]))


def _starts(best: EngineFit) -> list[Floats]:
    """First values: the healthy ones, or the best at each mean torque that fits better than those beside."""
    n = best.model.engine.n_cylinders
    if not best.model.bends:
        return [np.zeros(n)]
    # At a mean factor: all cylinders alike, then each in turn stronger at the expense of all.
    beside = np.column_stack([np.zeros(n), np.eye(n) - 1 / n])
    parts = np.array_split(_LOADS, -(-beside.shape[1] * len(_LOADS) // _STATES))
    fits = [fit for loads in parts for fit in _fits_at_loads(best, loads, beside)]
    left = np.array([np.inf, *(left for _, left in fits), np.inf])
    lowest = np.flatnonzero((left[1:-1] <= left[:-2]) & (left[1:-1] <= left[2:]))
    return [fits[k][0] for k in lowest]


def _fits_at_loads(best: EngineFit, loads: Floats, beside: Floats) -> Iterator[tuple[Floats, float]]:
    """Values that fit best at some mean factors, and the squares left; `beside`: states less their mean."""
    states = (loads[:, None, None] - 1) + beside
    rows = best.left(np.concatenate(list(states), axis=1))
    for state, own in zip(states, rows.reshape(len(loads), beside.shape[1], -1), strict=True):
        A = (own[0] - own[1:]).T
        fit = least_squares(A, own[0], is_known=True)
        left = own[0] - A @ fit.values
        yield state[:, 0] + (state[:, 1:] - state[:, :1]) @ fit.values, float(left @ left)


def _unsettled(values: Floats, asked: Floats, n: int) -> str:
    worst = int(np.argmax(np.abs(asked - values)))
    kind, cylinder = divmod(worst, n)
    what = ("that", "the delay [rad]", "the compression")[kind]
    before, after = np.array([values[worst], asked[worst]]) + (0.0 if kind == 1 else 1.0)
    return (
        f"the factors do not converge: {what} of cylinder {cylinder + 1} goes from {before:.4g} to "
        f"{after:.4g} and back, as the stiffness of couplings follows the mean torque; check "
        "[train.couplings] there, or assume a linear coupling"
    )


def _tells_all(best: EngineFit) -> bool:
    n = best.model.engine.n_cylinders
    return 2 * len(best.measured.orders) > 3 * n and not best.about(np.zeros(3 * n))[0].is_open.any()


def _taken_as_tight(measured: MeasuredSpeed, n: int) -> str:
    remedy = f": measure more than {1.5 * n:.4g} orders" if len(measured.orders) <= 1.5 * n else ""
    return (
        f"{len(measured.orders)} orders do not distinguish late and leaking cylinders: all are assumed on "
        f"time and tight{remedy}"
    )


def _begun(best: EngineFit, factors: Floats) -> Floats:
    """Starting values of combustion, delay and compression, from the lowest orders, then from more."""
    values = np.concatenate([factors, np.zeros(2 * len(factors))])
    for share in _BEGINNINGS:
        low = best.up_to(share * best.measured.orders.max(), np.repeat(_LIKELY, len(factors)))
        values = values if low is None else low.settled(values, _FIRST_STEPS)[0]
    return values


def _apart(starts: list[Floats]) -> list[Floats]:
    kept: list[Floats] = []
    for start in starts:
        if all(np.abs(start - other).max() > _SAME for other in kept):
            kept.append(start)
    return kept
