r"""The best damper for a mode of a train: by the mode alone in closed form, for the whole train by search.

In a mode with the shape θ the train is one mass at the disc that carries the damper,

.. math:: J_m = \frac{\sum J\theta^2}{\theta_{on}^2}, \qquad K_m = \omega_n^2 J_m

and `damper_rules` says which c and k are best for it. The other modes give a little, and the ring changes the
shape; so the same is sought for the train as a whole, with all its modes: the pair of c and k for which the
largest twist of the shaft that the mode twists most is smallest (`ring_on_train`).
What else damps the train is left out, so that it does with less than is found here.

References
----------
.. [1] Den Hartog, Mechanical Vibrations, 4th ed. 1956, sections 3.3 and 5.6.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from linkwright.kernel.description.base import suggestion
from linkwright.kernel.errors import InputError
from linkwright.kernel.public import public
from linkwright.kernel.public.in_range import in_range
from linkwright.kernel.result import Result
from linkwright.kernel.units import INERTIA, RATIO, positive
from linkwright.machine.machine import Machine
from linkwright.torsion.damper.damper_rules import rubber_rule, tuned_rule, viscous_rule
from linkwright.torsion.damper.ring_on_train import RingOnTrain, RingSupport, best_holding
from linkwright.torsion.modes.free import FreeVibration, free_vibration

Floats = NDArray[np.float64]
Kind = Literal["viscous", "tuned", "rubber"]

_RULES = {"viscous": viscous_rule, "tuned": tuned_rule, "rubber": rubber_rule}


@dataclass(frozen=True)
class DamperDesign(Result):
    """The best damper for a mode of a train.

    Attributes
    ----------
    frequencies : ndarray, shape (n,)
        At which the responses are [Hz].
    response_bare, response_rule, response_best : ndarray, shape (n,)
        Twist of the watched shaft over that at rest in the mode: without damper, with that of the closed
        form, with the best one.
    kind : str
        ``"viscous"``, ``"tuned"`` or ``"rubber"``.
    on : str
        Disc that carries it.
    mode : int
        Number of the mode, from 0.
    natural_frequency : float
        Of the mode without damper [Hz].
    watched : str
        Shaft that the mode twists most.
    ring_inertia, modal_inertia : float
        Of the ring; of the train in the mode, at the disc [kg m²].
    mass_ratio : float
        Of both.
    damping, stiffness, loss_factor : float
        By the mode alone, in closed form [N m s/rad, N m/rad, –].
    magnification : float
        What it promises.
    magnification_rule : float
        Largest of `response_rule`.
    damping_best, stiffness_best, loss_factor_best : float
        For the whole train [N m s/rad, N m/rad, –].
    magnification_best : float
        Largest of `response_best`.
    """

    frequencies: Floats
    response_bare: Floats
    response_rule: Floats
    response_best: Floats
    kind: Kind
    on: str
    mode: int
    natural_frequency: float
    watched: str
    ring_inertia: float
    modal_inertia: float
    mass_ratio: float
    damping: float
    stiffness: float
    loss_factor: float
    magnification: float
    magnification_rule: float
    damping_best: float
    stiffness_best: float
    loss_factor_best: float
    magnification_best: float


@public
def design_damper(
    machine: Machine,
    on: str,
    ring_inertia: float,
    *,
    mode: int = 1,
    kind: Kind = "viscous",
    loss_factor: float | None = None,
) -> DamperDesign:
    """Find the damping, and the stiffness, with which a ring damps a mode best.

    Parameters
    ----------
    machine : Machine
        With a train; dampers that it has are left out.
    on : str
        Disc that carries the damper; its housing counts with the disc.
    ring_inertia : float
        [kg m²].
    mode : int
        Number of the mode as in `FreeVibration`; of a free train 1 is the first that twists.
    kind : str
        ``"viscous"``: a fluid; ``"tuned"``: a spring and a fluid; ``"rubber"``: a spring that loses.
    loss_factor : float, optional
        η of the rubber at hand. Without it, the best.

    Returns
    -------
    DamperDesign
        Closed form and search.

    Raises
    ------
    InputError
        No such disc, mode or kind, or a number that is not greater than 0.
    FindingError
        The disc is at rest in the mode.

    References
    ----------
    .. [1] Den Hartog, Mechanical Vibrations, 4th ed. 1956, section 5.6.
    """
    _require(ring_inertia, kind, loss_factor)
    found = free_vibration(_without_dampers(machine))
    train = RingOnTrain(found, _disc(found, on), _twisting(found, mode), ring_inertia)
    mu = ring_inertia / train.modal_inertia
    rule = _RULES[kind](mu)
    first = train.holding(rule)
    if loss_factor is not None:
        first = RingSupport(first.damping, first.stiffness, loss_factor)
    best = best_holding(train, first, free_loss=loss_factor is None)
    return DamperDesign(
        frequencies=train.omega / (2 * math.pi),
        response_bare=train.response(RingSupport(0.0, 0.0, 0.0)),
        response_rule=train.response(first),
        response_best=train.response(best),
        kind=kind,
        on=on,
        mode=mode,
        natural_frequency=float(found.natural_frequencies[mode]),
        watched=train.watched,
        ring_inertia=float(ring_inertia),
        modal_inertia=train.modal_inertia,
        mass_ratio=mu,
        damping=first.damping,
        stiffness=first.stiffness,
        loss_factor=first.loss_factor,
        magnification=rule.magnification,
        magnification_rule=train.peak(first),
        damping_best=best.damping,
        stiffness_best=best.stiffness,
        loss_factor_best=best.loss_factor,
        magnification_best=train.peak(best),
    )


def _without_dampers(machine: Machine) -> Machine:
    """A machine whose train has no dampers."""
    if machine.train is None or not machine.train.dampers:
        return machine
    return machine.with_entries({"train": machine.train.with_entries({"dampers": {}})})


def _disc(found: FreeVibration, on: str) -> int:
    if on not in found.discs:
        remedy = suggestion(on, found.discs)
        raise InputError(f'on: found "{on}", expected the name of a disc' + (f"; {remedy}" if remedy else ""))
    return found.discs.index(on)


def _twisting(found: FreeVibration, mode: int) -> int:
    """The number of a mode that twists the train."""
    twisting = np.flatnonzero(found.natural_frequencies > 0)
    if mode not in twisting:
        known = f"one of {twisting[0]} to {twisting[-1]}" if len(twisting) else "a train that twists"
        raise InputError(f"mode: found {mode}, expected {known}")
    return mode


def _require(ring_inertia: float, kind: str, loss_factor: float | None) -> None:
    """Refuse what is no damper."""
    in_range(ring_inertia=(ring_inertia, positive(INERTIA)), loss_factor=(loss_factor, positive(RATIO)))
    if kind not in _RULES:
        raise InputError(
            f'kind: found "{kind}", expected one of ' + ", ".join(f'"{each}"' for each in _RULES)
        )
    if loss_factor is not None and kind != "rubber":
        raise InputError(f'loss_factor: found {loss_factor:g} with kind "{kind}", expected kind "rubber"')
