r"""The best damper for a mode of a train: by the mode alone in closed form, for the whole train by search.

In a mode with the shape θ the train is one mass at the disc that carries the damper,

.. math:: J_m = \frac{\sum J\theta^2}{\theta_{on}^2}, \qquad K_m = \omega_n^2 J_m

and `damper_rules` says which c and k are best for it. The other modes give a little, and the ring changes the
shape; so the same is sought for the train as a whole, with all its modes: the pair of c and k for which the
largest twist of the shaft that the mode twists most is smallest (`RingOnTrain`). What else damps the train is
left out, so that it does with less than is found here.

The train swings under torques Jθ of one mode, which excite none other as long as there is no damper. With the
receptances α of that train and the dynamic stiffness D of the ring, a twist w is

.. math:: w = \alpha_w - \frac{\alpha_{w,on}\,D\,\alpha_{on}}{1 + \alpha_{on,on}\,D}

References
----------
.. [1] Den Hartog, Mechanical Vibrations, 4th ed. 1956, sections 3.3 and 5.6.
.. [2] Bishop and Johnson, The Mechanics of Vibration, 1960: receptances of systems that are joined.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Annotated, Literal

import numpy as np

from linkwright.kernel.arrays import Floats
from linkwright.kernel.description.base import suggestion
from linkwright.kernel.errors import FindingError, InputError
from linkwright.kernel.public import public
from linkwright.kernel.public.in_range import in_range
from linkwright.kernel.quantities import About, Label
from linkwright.kernel.result import Result
from linkwright.kernel.units.kinds import INERTIA, RATIO
from linkwright.kernel.units.marks import positive
from linkwright.machine.machine import Machine
from linkwright.torsion.damper.damper_rules import (
    DamperRule,
    ring_stiffness,
    rubber_rule,
    tuned_rule,
    viscous_rule,
)
from linkwright.torsion.modes.free import FreeVibration, free_vibration

# Frequencies at which the response is examined, closest about that of the mode: with a light ring and a
# fluid the best peak is half as wide as the ratio of inertias, in shares of the frequency.
_POINTS, _CLOSE = 1500, 0.5

# The range over the frequency of the mode, below over that with the ring held fast to its disc; and the share
# of a neighbouring frequency from which it keeps away, where the response is that of another mode.
_LOW, _HIGH, _AWAY = 0.4, 1.6, 0.05

# A disc whose amplitude is a smaller share of the largest is at rest in the mode.
_AT_REST = 1e-6

# How far c and k are sought about what the mode alone gives, as factors, and to which share they are found:
# the response is flat there, to the square of it.
_C_RANGE, _K_RANGE, _FOUND = 8.0, 1.6, 1e-5


@dataclass(frozen=True)
class RingSupport:
    """What holds the ring."""

    damping: float
    stiffness: float
    loss_factor: float

    def scaled(self, c: float, k: float = 1.0) -> RingSupport:
        """With c, or where there is none η, and k by factors."""
        loss = self.loss_factor * (c if self.damping == 0 else 1.0)
        return RingSupport(self.damping * c, self.stiffness * k, loss)


class RingOnTrain:
    """Receptances of a train about a mode, at the frequencies of interest."""

    def __init__(self, free: FreeVibration, on: int, mode: int, ring: float) -> None:
        shape, natural = free.mode_shapes, free.angular_frequencies
        if abs(shape[mode, on]) < _AT_REST:
            raise FindingError(
                f"{free.discs[on]} is at rest in mode {mode} at {free.natural_frequencies[mode]:.6g} Hz: a "
                "damper there has no effect; place it where the amplitude is large"
            )
        shaft = int(np.argmax(free.potential_shares[mode]))
        self.watched, self.ring = free.shafts[shaft], ring
        self.modal_inertia = float(free.modal_inertia[mode] / shape[mode, on] ** 2)
        self.natural = float(natural[mode])
        self.omega = _range(natural, mode, ring / self.modal_inertia)
        pole = free.modal_inertia[:, None] * (natural[:, None] ** 2 - self.omega**2)
        self.on_on = (shape[:, on] ** 2) @ (1 / pole)
        self.watch_on = (free.twists[:, shaft] * shape[:, on]) @ (1 / pole)
        # Torques Jθ of the mode, of which the unit is taken so that the twist at rest is one.
        self.rest = free.modal_inertia[mode] * self.natural**2 / pole[mode]
        self.amplitude = shape[mode, on] / free.twists[mode, shaft]

    def holding(self, rule: DamperRule) -> RingSupport:
        """A damper of these ratios in the mode."""
        ring, omega = self.ring, self.natural
        stiffness = ring * (rule.tuning * omega) ** 2
        return RingSupport(2 * ring * omega * rule.damping_ratio, stiffness, rule.loss_factor)

    def response(self, held: RingSupport) -> Floats:
        """Twist of the watched shaft over that at rest."""
        joint = held.stiffness * (1 + 1j * held.loss_factor) + 1j * self.omega * held.damping
        D = ring_stiffness(joint, self.ring * self.omega**2)
        part = self.watch_on * D * self.amplitude / (1 + self.on_on * D)
        twist: Floats = np.abs(self.rest * (1 - part))
        return twist

    def peak(self, held: RingSupport) -> float:
        """Largest response, by the parabola through the highest points."""
        y = self.response(held)
        n = int(np.argmax(y))
        if n in (0, len(y) - 1):
            return float(y[n])
        x, y = self.omega[n - 1 : n + 2], y[n - 1 : n + 2]
        slopes = np.diff(y) / np.diff(x)
        bend = (slopes[1] - slopes[0]) / (x[2] - x[0])
        if bend >= 0:
            return float(y[1])
        at = 0.5 * (x[0] + x[1]) - 0.5 * slopes[0] / bend
        return float(y[0] + (at - x[0]) * (slopes[0] + bend * (at - x[1])))


def best_holding(train: RingOnTrain, first: RingSupport, *, free_loss: bool) -> RingSupport:
    """The damper with the minimum peak: c, or the loss of rubber, for each k, and k over these."""

    def damped(k: float) -> RingSupport:
        if not free_loss:
            return first.scaled(1.0, k)
        c = _least(lambda x: train.peak(first.scaled(math.exp(x), k)), math.log(_C_RANGE))
        return first.scaled(math.exp(c), k)

    if first.stiffness == 0:
        return damped(1.0)
    k = _least(lambda x: train.peak(damped(math.exp(x))), math.log(_K_RANGE))
    return damped(math.exp(k))


def _least(value: Callable[[float], float], reach: float) -> float:
    """Minimum of a function from −reach to reach: the best of some samples, refined by Brent's method."""
    from scipy.optimize import minimize_scalar

    samples = np.linspace(-reach, reach, 17)
    n = int(np.argmin([value(float(x)) for x in samples]))
    bracket = (float(samples[max(n - 1, 0)]), float(samples[min(n + 1, 16)]))
    return float(minimize_scalar(value, bounds=bracket, method="bounded", options={"xatol": _FOUND}).x)


def _range(natural: Floats, mode: int, mu: float) -> Floats:
    """Frequencies about that of a mode, which a ring held fast lowers by √(1 + μ); none is a natural one."""
    own = float(natural[mode])
    # Frequencies that lie together are damped together.
    below, above = natural[natural < (1 - 2 * _AWAY) * own], natural[natural > (1 + 2 * _AWAY) * own]
    low = max([_LOW * own / math.sqrt(1 + mu), *((1 + _AWAY) * below)])
    high = min([_HIGH * own, *((1 - _AWAY) * above)])
    close = _CLOSE * min(mu, 1.0) * own
    steps = np.linspace(math.asinh((low - own) / close), math.asinh((high - own) / close), _POINTS)
    omega = own + close * np.sinh(steps)
    # At a natural frequency the receptances have a pole.
    near = np.abs(omega[:, None] - natural) < 1e-9 * own
    moved: Floats = omega + np.where(near.any(axis=1), 1e-8 * own, 0.0)
    return moved


Kind = Literal["viscous", "tuned", "rubber"]

_RULES = {"viscous": viscous_rule, "tuned": tuned_rule, "rubber": rubber_rule}


@dataclass(frozen=True)
class DamperDesign(Result):
    """The best damper for a mode of a train."""

    frequencies: Annotated[Floats, Label("frequency", "f", "Hz")]
    response_bare: Annotated[
        Floats, Label("twist over that at rest, without damper", "", "–", "Of the watched shaft in the mode.")
    ]
    response_rule: Annotated[
        Floats, Label("twist over that at rest, with the damper of the closed form", "", "–", "Likewise.")
    ]
    response_best: Annotated[
        Floats, Label("twist over that at rest, with the best damper", "", "–", "Likewise.")
    ]
    kind: Annotated[Kind, About('``"viscous"``, ``"tuned"`` or ``"rubber"``.')]
    on: Annotated[str, About("Disc that carries it.")]
    mode: Annotated[int, About("Number of the mode, from 0.")]
    natural_frequency: Annotated[float, Label("natural frequency of the mode without damper", "f", "Hz")]
    watched: Annotated[str, About("Shaft that the mode twists most.")]
    ring_inertia: Annotated[float, Label("inertia of the ring", "", "kg m²")]
    modal_inertia: Annotated[float, Label("inertia of the train in the mode, at the disc", "", "kg m²")]
    mass_ratio: Annotated[float, Label("inertia of the ring over that of the mode", "μ", "–")]
    damping: Annotated[float, Label("damping by the mode alone, in closed form", "c", "N m s/rad")]
    stiffness: Annotated[float, Label("stiffness by the mode alone, in closed form", "k", "N m/rad")]
    loss_factor: Annotated[float, Label("loss factor by the mode alone, in closed form", "η", "–")]
    magnification: Annotated[float, Label("magnification by the closed form", "", "–")]
    magnification_rule: Annotated[
        float, Label("maximum magnification with the damper of the closed form", "", "–")
    ]
    damping_best: Annotated[float, Label("damping for the whole train", "c", "N m s/rad")]
    stiffness_best: Annotated[float, Label("stiffness for the whole train", "k", "N m/rad")]
    loss_factor_best: Annotated[float, Label("loss factor for the whole train", "η", "–")]
    magnification_best: Annotated[float, Label("maximum magnification with the best damper", "", "–")]


@public
def design_damper(
    machine: Machine,
    on: str,
    ring_inertia: float,
    *,
    mode: int | None = None,
    kind: Kind = "viscous",
    loss_factor: float | None = None,
) -> DamperDesign:
    """Optimum damping and stiffness of a torsional damper for a mode.

    Parameters
    ----------
    machine : Machine
        With a train; dampers that it has are left out.
    on : str
        Disc that carries the damper; its housing counts with the disc.
    ring_inertia : float
        [kg m²].
    mode : int, optional
        Number of the mode as in `FreeVibration`. Default: the first that twists, 1 of a free train, 0 of one
        that is held.
    kind : str
        ``"viscous"``: a fluid; ``"tuned"``: a spring and a fluid; ``"rubber"``: a spring that loses.
    loss_factor : float, optional
        η of the rubber at hand. Default: the best.

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
    free = free_vibration(_without_dampers(machine))
    mode = _twisting(free, mode)
    train = RingOnTrain(free, _disc(free, on), mode, ring_inertia)
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
        natural_frequency=float(free.natural_frequencies[mode]),
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
    if machine.train is None or not machine.train.dampers:
        return machine
    return machine.with_entries({"train": machine.train.with_entries({"dampers": {}})})


def _disc(free: FreeVibration, on: str) -> int:
    if on not in free.discs:
        remedy = suggestion(on, free.discs)
        raise InputError(f'on: found "{on}", expected the name of a disc' + (f"; {remedy}" if remedy else ""))
    return free.discs.index(on)


def _twisting(free: FreeVibration, mode: int | None) -> int:
    """The number of a mode that twists the train; the first of them where none is asked for."""
    twisting = np.flatnonzero(free.natural_frequencies > 0).tolist()
    if not twisting:
        raise InputError("mode: found none that twists the train, expected a train with an elastic mode")
    if mode is None:
        return int(twisting[0])
    if mode not in twisting:
        low, high = twisting[0], twisting[-1]
        known = f"{low}, its only mode" if low == high else f"one of {low} to {high}"
        raise InputError(f"mode: found {mode}, expected {known}")
    return mode


def _require(ring_inertia: float, kind: str, loss_factor: float | None) -> None:
    in_range(ring_inertia=(ring_inertia, positive(INERTIA)), loss_factor=(loss_factor, positive(RATIO)))
    if kind not in _RULES:
        raise InputError(
            f'kind: found "{kind}", expected one of ' + ", ".join(f'"{rule}"' for rule in _RULES)
        )
    if loss_factor is not None and kind != "rubber":
        raise InputError(f'loss_factor: found {loss_factor:g} with kind "{kind}", expected kind "rubber"')
