r"""Which cylinder of an engine is weak: its factors by Gauss and Newton's method.

Harmonics of a speed depend on the factors x of the cylinders, y = f(x), nearly but not quite linearly: what
the loads take off, and the stiffness of couplings of a curve, are those of the mean torque that the weakened
engine gives. From a healthy engine on,

.. math:: x \leftarrow 1 + A^+ \left(y - f(x) + A\,(x - 1)\right), \qquad A = \partial f/\partial x

until x stays, so that operating point and diagnosis belong together. A at the end tells the uncertainty.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from linkwright.analysis.torsion.diagnosis import Diagnosis, diagnosed, equations, places
from linkwright.analysis.torsion.engine_speed import EngineSpeed
from linkwright.analysis.torsion.least_squares import least_squares
from linkwright.analysis.torsion.measured_speed import MeasuredSpeed
from linkwright.errors import ConvergenceError
from linkwright.machine import Machine

Floats = NDArray[np.float64]

# Steps of the method: a few, and some dozens where curves of couplings bend at the operating point.
_ROUNDS = 60
# Factors have settled when they change by less than this, or than this share of their deviation.
_SETTLED, _SETTLED_SHARE = 1e-9, 1e-4
# A step that fits worse is halved, at most so often.
_HALVINGS = 10


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
    """Factors whose speed is closest to a measured one.

    Parameters
    ----------
    model : EngineSpeed
        The engine, made ready once for any number of measurements.
    measured : MeasuredSpeed
        At its disc.

    Returns
    -------
    Diagnosis
        As `engine_diagnosis`.

    Raises
    ------
    InputError
        The measurement does not fit the train.
    ConvergenceError
        No factors belong to their own operating point.
    """
    names = tuple(str(n + 1) for n in range(model.engine.n_cylinders))
    factors, is_known = np.ones(len(names)), measured.noise is not None
    for _ in range(_ROUNDS):
        orders, here, slopes = model.about(factors)
        at = places(orders, measured)
        A = equations(slopes[:, at], measured).T
        left = equations(measured.harmonics - here[at], measured)
        fit = least_squares(A, left + A @ (factors - 1), is_known=is_known)
        step = 1 + fit.values - factors
        if (np.abs(step) <= np.maximum(_SETTLED, _SETTLED_SHARE * fit.deviation)).all():
            return diagnosed(fit, A, names, measured)
        factors = factors + _share(model, measured, factors, step) * step
    worst = int(np.argmax(np.abs(step)))
    raise ConvergenceError(
        f"the factors do not settle: that of cylinder {names[worst]} still changes by {step[worst]:.3g} at "
        f"{factors[worst]:.4g}, as the stiffness of couplings follows the mean torque; give the noise, or "
        "smoother points of their curves",
        method="Gauss-Newton",
        iterations=_ROUNDS,
    )


def _share(model: EngineSpeed, measured: MeasuredSpeed, factors: Floats, step: Floats) -> float:
    """Share of a step, halved until the speed fits no worse than before."""
    shares = 0.5 ** np.arange(_HALVINGS)
    orders, found = model.harmonics(factors[:, None] + step[:, None] * np.append(0.0, shares))
    left = equations(measured.harmonics - found[:, places(orders, measured)], measured)
    size = (left**2).sum(axis=1)
    fits = np.flatnonzero(size[1:] <= size[0])
    return float(shares[fits[0] if len(fits) else -1])
